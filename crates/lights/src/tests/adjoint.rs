//! Light sent out and light asked for are the same light.
//!
//! For each light, the mean weight of emitted particles is its power, and the flux of particles
//! through a small patch is the irradiance that sampling the light from the patch finds.

use super::mitsuba::look_at;
use super::*;
use crate::LightSet;
use etalon_params::{DMat4, DVec3};
use etalon_sampling::warps::square_to_uniform_hemisphere;
use etalon_transport::{EmissionPdf, LightKind, SamplePdf};

/// Mean and squared standard error of numbers that are mostly zero.
#[derive(Default)]
struct Mean {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Mean {
    fn add(&mut self, x: f64) {
        self.count += 1.0;
        self.sum += x;
        self.squares += x * x;
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn squared_error(&self) -> f64 {
        let mean = self.mean();
        (self.squares / self.count - mean * mean) / (self.count - 1.0)
    }
}

/// |z| above which two means differ, α = 10⁻³ two-sided (samples are many).
const LIMIT: f64 = 3.29;

/// A sky with a bright spot.
fn sky_file(world: &mut SmallWorld) {
    let mut rgb = [[0.2, 0.3, 0.5]; 8 * 5];
    rgb[8 + 2] = [9.0, 6.0, 3.0];
    rgb[2 * 8 + 5] = [3.0, 3.0, 6.0];
    add_file(world, "sky.pfm", 8, &rgb);
    add_file(world, "square.pfm", 6, &rgb[..36]);
}

/// Every light, above the patch.
fn lights() -> (SmallWorld, Vec<(&'static str, LightDescription)>) {
    let mut world = SmallWorld::default();
    sky_file(&mut world);
    let down = Value::Transform(
        DMat4::from_translation(DVec3::new(0.2, -0.1, 1.5))
            * DMat4::from_rotation_x(core::f64::consts::PI + 0.1),
    );
    let down_again = down.clone();
    let wide = || Value::Float(50.0);
    let file = || ("filename", Value::String("sky.pfm".into()));
    let turned = Value::Transform(DMat4::from_rotation_x(1.2) * DMat4::from_rotation_z(0.4));
    let square = vec![
        ("filename", Value::String("square.pfm".into())),
        ("mapping", Value::String("equalarea".into())),
        ("to_world", turned.clone()),
    ];
    let position = Value::Vector(DVec3::new(0.3, 0.2, 1.0));
    let descriptions = vec![
        ("point", vec![("position", position)]),
        (
            "spot",
            vec![
                ("to_world", down.clone()),
                ("cutoff_angle", wide()),
                ("beam_width", Value::Float(10.0)),
            ],
        ),
        (
            "spot",
            vec![
                ("to_world", down),
                ("cutoff_angle", wide()),
                ("texture", texture("squares")),
            ],
        ),
        (
            "directional",
            vec![("direction", Value::Vector(DVec3::new(0.3, 0.2, -1.0)))],
        ),
        ("constant", vec![("radiance", Value::Float(0.7))]),
        ("envmap", vec![file(), ("to_world", turned.clone())]),
        (
            "envmap",
            vec![
                file(),
                ("to_world", turned),
                ("mis_compensation", Value::Boolean(true)),
                ("scale", Value::Float(2.0)),
            ],
        ),
    ];
    let mut lights: Vec<_> = descriptions
        .into_iter()
        .map(|(name, properties)| (name, light(&mut world, name, properties)))
        .collect();
    for radiance in [Value::Float(2.0), texture("ramp")] {
        world
            .rectangles
            .push((Vec3::new(0.4, 0.1, 1.0), Vec3::NEG_Z));
        let area = light(&mut world, "area", vec![("radiance", radiance)]);
        lights.push(("area", area));
    }
    let thrown = vec![
        ("to_world", down_again),
        ("fov", Value::Float(70.0)),
        ("irradiance", Value::Float(2.0)),
    ];
    let sun = Value::Vector(DVec3::new(0.3, 0.5, 0.6));
    let bright = vec![("sun_direction", sun), ("sun_aperture", Value::Float(3.0))];
    lights.push(("sunsky", light(&mut world, "sunsky", bright)));
    let mut even = thrown.clone();
    even.push(("profile", Value::String("intensity".into())));
    lights.push(("projector", light(&mut world, "projector", thrown)));
    lights.push(("projector", light(&mut world, "projector", even)));
    lights.push(("envmap", light(&mut world, "envmap", square)));
    // It looks away from the patch, but shines behind itself, too.
    world.rectangles.push((Vec3::new(-0.2, 0.1, 1.0), Vec3::Z));
    let both = vec![
        ("radiance", Value::Float(1.5)),
        ("twosided", Value::Boolean(true)),
    ];
    lights.push(("area", light(&mut world, "area", both)));
    lights.extend(super::goniometric::above_the_patch(&mut world));
    (world, lights)
}

fn bounds() -> BoundingSphere {
    BoundingSphere::of_box(Vec3::new(-1.0, -1.0, -0.1), Vec3::new(1.0, 1.0, 0.5))
}

/// Upon a flat patch that it faces, a beam's irradiance is its `radiance` where it shines, whatever the distance; the mutant
/// that emits with a cosine spreads it over the patch.
#[test]
fn a_beam_goes_along_the_normal() {
    let mut world = SmallWorld::default();
    (world.rectangles).push((Vec3::new(0.3, -0.1, 1.0), Vec3::NEG_Z));
    let radiance = vec![("radiance", Value::Float(2.0))];
    let description = light(&mut world, "directionalarea", radiance);
    let set = LightSet::new(vec![description], &world, bounds(), LightSamplerKind::Power);
    let count = set.count();
    assert_eq!(
        [count.all, count.hittable, count.chosen, count.beams],
        [1, 0, 1, 1]
    );
    let from = receiver(Vec3::new(0.3, 0.0, 0.0), Vec3::Z);
    let mut random = numbers(5);
    for _ in 0..1000 {
        let (u, v) = (random.next_2d(), random.next_2d());
        let emitted = set.emit(&world, &WAVELENGTHS, 0.5, u, v, 0.0);
        let particle = emitted.expect("it always emits");
        assert_eq!(particle.ray.direction, Vec3::NEG_Z);
        // Its rectangles have sides of 2.
        assert!((particle.weight.y / white().y / (2.0 * 4.0) - 1.0).abs() < 1e-5);
        assert!(set.sample(&world, &from, &WAVELENGTHS, 0.5, u).is_none());
        assert_eq!(set.light_sample_density(&world, &from, &particle), 0.0);
    }
}

/// Rejects, among others, a missing or doubled cosine, 4π for 2π, and r for r².
#[test]
fn emitted_particles_carry_what_sampling_finds() {
    let (world, lights) = lights();
    for (index, (name, description)) in lights.into_iter().enumerate() {
        let compensated = index == 6;
        let set = LightSet::new(vec![description], &world, bounds(), LightSamplerKind::Power);
        let mut random = numbers(7 + index as u64);
        let (mut flux, mut irradiance) = (Mean::default(), Mean::default());
        for _ in 0..150_000 {
            let (u, v) = (random.next_2d(), random.next_2d());
            let hit = set
                .emit(&world, &WAVELENGTHS, random.next_1d(), u, v, 0.0)
                .filter(|particle| particle.ray.direction.z < 0.0)
                .and_then(|particle| {
                    assert!(particle.weight.is_finite() && particle.weight.min_element() >= 0.0);
                    assert!((particle.ray.direction.length() - 1.0).abs() < 1e-5);
                    let t = -particle.ray.origin.z / particle.ray.direction.z;
                    let p = particle.ray.at(t);
                    // The patch is the square of side 1 around the origin.
                    (t > 0.0 && p.x.abs() < 0.5 && p.y.abs() < 0.5).then_some(particle.weight.y)
                });
            flux.add(f64::from(hit.unwrap_or(0.0)));
        }
        for _ in 0..40_000 {
            let p = (random.next_2d() - 0.5).extend(0.0);
            let from = receiver(p, Vec3::Z);
            let (u_light, u) = (random.next_1d(), random.next_2d());
            let value = if compensated {
                // Its own directions leave out what is dark; uniform ones do not.
                let direction = square_to_uniform_hemisphere(u);
                let radiance = set.background(&world, direction, 0.0, &WAVELENGTHS).y;
                radiance * direction.z * core::f32::consts::TAU
            } else {
                let found = set.sample(&world, &from, &WAVELENGTHS, u_light, u);
                found.map_or(0.0, |sample| {
                    let chance = match sample.chance {
                        SamplePdf::Continuous(density) => density.hero(),
                        SamplePdf::Discrete(p) => p.0.x,
                    };
                    sample.radiance.y * sample.direction.z.max(0.0) / chance
                })
            };
            irradiance.add(f64::from(value));
        }
        let error = (flux.squared_error() + irradiance.squared_error()).sqrt();
        let z = (flux.mean() - irradiance.mean()) / error;
        assert!(
            z.abs() < LIMIT && flux.mean() > 10.0 * error,
            "{index} {name}: z = {z}, {} {} ± {error}",
            flux.mean(),
            irradiance.mean()
        );
    }
}

/// The mean weight of particles is the power. Powers are means over wavelengths, weights belong
/// to one; both are D65 times a number, which is compared. Images of several colours, skies and spots
/// with a texture know their power only roughly, and are left out.
#[test]
fn emitted_particles_carry_the_power() {
    let (world, lights) = lights();
    let mean_white = Spectrum::d65(1.0).expect("finite").mean();
    for (index, (name, description)) in lights.into_iter().enumerate() {
        if index == 2 || matches!(name, "envmap" | "sunsky") {
            continue;
        }
        let ramp = index == 8;
        let set = LightSet::new(vec![description], &world, bounds(), LightSamplerKind::Power);
        let mut random = numbers(70 + index as u64);
        let mut weights = Mean::default();
        for _ in 0..50_000 {
            let (u, v) = (random.next_2d(), random.next_2d());
            let particle = set
                .emit(&world, &WAVELENGTHS, random.next_1d(), u, v, 0.0)
                .expect("every light emits");
            weights.add(f64::from(particle.weight.y / white().y));
        }
        // The small world states the ramp's mean as ½ without D65.
        let unit = if ramp { 1.0 } else { mean_white };
        let power = set.power(LightId(0)) / unit;
        let error = weights.squared_error().max(0.0).sqrt() + 1e-5 * power;
        let z = (weights.mean() - power) / error;
        assert!(
            z.abs() < LIMIT,
            "{index} {name}: {} {power}",
            weights.mean()
        );
    }
}

#[test]
fn analytic_powers() {
    let mut world = SmallWorld::default();
    let unit = Spectrum::d65(1.0).expect("finite").mean();
    let pi = core::f64::consts::PI;
    let cases = [
        ("point", vec![("to_world", look_at())], 4.0 * pi),
        // ∫ f dω for b = 0, c = 60°: 2π (1 − sin c / c).
        (
            "spot",
            vec![
                ("cutoff_angle", Value::Float(60.0)),
                ("beam_width", Value::Float(0.0)),
            ],
            2.0 * pi * (1.0 - 0.866_025_403_784_438_6 / (pi / 3.0)),
        ),
        (
            "spot",
            vec![
                ("cutoff_angle", Value::Float(180.0)),
                ("beam_width", Value::Float(180.0)),
            ],
            4.0 * pi,
        ),
        // On the plane z = 1 the irradiance π on a square of side 2.
        (
            "projector",
            vec![
                ("fov", Value::Float(90.0)),
                ("irradiance", Value::Float(1.0)),
            ],
            4.0 * pi,
        ),
        // The same intensity over a sixth of all directions.
        (
            "projector",
            vec![
                ("fov", Value::Float(90.0)),
                ("irradiance", Value::Float(1.0)),
                ("profile", Value::String("intensity".into())),
            ],
            4.0 * pi / 6.0,
        ),
        // A sharp edge: the cone's solid angle.
        (
            "spot",
            vec![
                ("cutoff_angle", Value::Float(60.0)),
                ("beam_width", Value::Float(70.0)),
            ],
            pi,
        ),
    ];
    for (name, properties, expected) in cases {
        let description = light(&mut world, name, properties);
        let power = description.light.power(&world, &bounds()) / unit;
        assert!(
            (power / expected - 1.0).abs() < 1e-6,
            "{name} {power} {expected}"
        );
    }
}

/// weight · p(origin) · p(ray) is what the light sends along the ray, and both densities are those
/// that the light reports of the same origin and ray. Rejects a density without the choice of
/// the light, and one sky's density for all skies'.
#[test]
fn densities_of_emission_are_those_that_are_reported() {
    let (world, mut lights) = lights();
    // Two skies are one technique; the compensated one emits uncompensated.
    let place = lights.iter().position(|(name, _)| *name == "projector");
    let projector = lights.swap_remove(place.expect("it is among them"));
    lights.truncate(6);
    lights.push(projector);
    let (names, descriptions): (Vec<_>, Vec<_>) = lights.into_iter().unzip();
    let set = LightSet::new(descriptions, &world, bounds(), LightSamplerKind::Power);
    let mut random = numbers(3);
    let mut seen = [false; 7];
    for _ in 0..2_000 {
        let (u, v) = (random.next_2d(), random.next_2d());
        let emitted = set.emit(&world, &WAVELENGTHS, random.next_1d(), u, v, 0.0);
        let particle = emitted.expect("every light emits");
        let light = particle.light.0 as usize;
        seen[light] = true;
        let EmissionPdf { origin, ray } = particle.density;
        let sent = particle.weight.y * origin * ray;
        let choice = set.selector().probability_to_emit(particle.light);
        match particle.origin {
            LightKind::Sky => {
                let toward = -particle.ray.direction;
                let reported = set.emission_density(&world, particle.light, -toward, 1.0, 0.0);
                assert!((reported.origin / origin - 1.0).abs() < 1e-3, "{light}");
                assert_eq!(reported.ray, ray);
                let radiance = set.background(&world, toward, 0.0, &WAVELENGTHS).y;
                assert!(
                    (sent / radiance - 1.0).abs() < 1e-3,
                    "{light}: {sent} {radiance}"
                );
            }
            LightKind::Beam | LightKind::Medium => unreachable!("none of these is one"),
            LightKind::Point | LightKind::Parallel => {
                assert_eq!(origin, choice, "{}", names[light]);
                let back = receiver(particle.ray.at(1.0), -particle.ray.direction);
                let sampled = set
                    .get(particle.light)
                    .sample(&world, &back, &WAVELENGTHS, v);
                let radiance = sampled.map_or(0.0, |sample| sample.radiance.y);
                assert!((sent - radiance).abs() < 1e-4 * radiance, "{light}");
            }
            LightKind::Surface => unreachable!("no surface is among them"),
        }
    }
    assert_eq!(seen, [true; 7]);
}

#[test]
fn a_surface_emits_with_the_density_that_it_reports() {
    let (world, lights) = lights();
    let (_, description) = &lights[7];
    let light = &description.light;
    let mut random = numbers(4);
    for _ in 0..100 {
        let (u, v) = (random.next_2d(), random.next_2d());
        let particle = light
            .emit(&world, &bounds(), &WAVELENGTHS, u, v, 0.0)
            .expect("it emits");
        assert_eq!(particle.origin, LightKind::Surface);
        let cos = particle.point.normal.dot(particle.ray.direction);
        let reported = light.emission_density(&world, &bounds(), particle.ray.direction, cos, 0.0);
        assert!((reported.origin / particle.density.origin - 1.0).abs() < 1e-6);
        assert_eq!(reported.ray, particle.density.ray);
        let sent = particle.weight.y * reported.origin * reported.ray;
        // L cos θ: the light's radiance is 2.
        let radiance = 2.0 * white().y;
        assert!((sent / (radiance * cos) - 1.0).abs() < 1e-5, "{sent}");
    }
}
