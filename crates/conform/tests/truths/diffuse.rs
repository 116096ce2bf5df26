//! What diffuse surfaces show: by the points of the lights, by the directions of the hemisphere, or bounce by bounce.

use crate::camera;
use crate::geometry::{Hit, Ray, nearest};
use crate::specular::sky;
use etalon_conform::scene::{Falloff, Light, Material, Scene, Shape, Sky};
use etalon_math::float64::{acos, cos, sin, sin_cos};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A part of a surface that emits.
struct Part {
    point: DVec3,
    /// Its normal times its area.
    area: DVec3,
    radiance: f64,
}

/// The picture by ∫ L cos θ cos θ'/d² dA over n × n parts of each light, and by the lights without extent, at k × k places in
/// each pixel.
pub(crate) fn by_lights(scene: &Scene, k: u32, n: u32) -> Vec<f64> {
    let lamps = scene.objects.iter().filter(|o| o.emitted_radiance > 0.0);
    let parts: Vec<Part> = lamps
        .flat_map(|lamp| parts(&lamp.shape, lamp.emitted_radiance, n))
        .collect();
    camera::picture(scene, camera::grid(k), |at| {
        let hit = first(scene, at);
        let from_parts: f64 = parts
            .iter()
            .map(|part| {
                let d = part.point - hit.point;
                let facing = (-d.dot(part.area)).max(0.0) * d.dot(hit.normal).max(0.0);
                part.radiance * facing / (d.length_squared() * d.length_squared())
            })
            .sum();
        reflectance(&hit) / PI * (from_parts + without_extent(scene, &hit))
    })
}

/// The irradiance by lights without extent, none of which is hidden.
fn without_extent(scene: &Scene, hit: &Hit<'_>) -> f64 {
    let from_point = |position: [f64; 3], intensity: f64| {
        let d = DVec3::from(position) - hit.point;
        intensity * d.normalize().dot(hit.normal) / d.length_squared()
    };
    let one = |light: &Light| match *light {
        Light::Point {
            position_m,
            intensity,
        } => from_point(position_m, intensity),
        Light::Spot {
            position_m,
            target_m,
            intensity,
            even_to_degrees,
            dark_from_degrees,
            falloff,
        } => {
            let position = DVec3::from(position_m);
            let axis = (DVec3::from(target_m) - position).normalize();
            let angle = acos(axis.dot((hit.point - position).normalize())).to_degrees();
            let way = |place: fn(f64) -> f64| {
                let [even, dark] = [even_to_degrees, dark_from_degrees].map(place);
                (place(angle) - dark) / (even - dark)
            };
            let by_cosine = || way(|degrees| cos(degrees.to_radians()));
            let share = match falloff {
                None => {
                    assert!(angle < even_to_degrees, "the picture is in the even cone");
                    1.0
                }
                Some(Falloff::LinearInAngle) => way(|degrees| degrees),
                Some(Falloff::SmoothInCosine) => {
                    3.0 * by_cosine().powi(2) - 2.0 * by_cosine().powi(3)
                }
                Some(Falloff::QuarticInCosine) => by_cosine().powi(2).powi(2),
            };
            share * from_point(position_m, intensity)
        }
        Light::Sun {
            direction,
            irradiance,
        } => -irradiance * DVec3::from(direction).dot(hit.normal),
    };
    scene.lights.iter().map(one).sum()
}

/// Equal parts of a form.
fn parts(shape: &Shape, radiance: f64, n: u32) -> Vec<Part> {
    let count = f64::from(n * n);
    let part = |point: DVec3, area: DVec3| Part {
        point,
        area,
        radiance,
    };
    match shape {
        Shape::Sphere {
            center_m, radius_m, ..
        } => camera::grid(n)
            .map(|[u, v]| {
                let z = 2.0 * u - 1.0;
                let across = (1.0 - z * z).sqrt();
                let out = DVec3::new(across * cos(TAU * v), across * sin(TAU * v), z);
                let area = 4.0 * PI * radius_m * radius_m / count;
                part(DVec3::from(*center_m) + *radius_m * out, area * out)
            })
            .collect(),
        Shape::Quad {
            center_m,
            half_u_m,
            half_v_m,
        } => {
            let (a, b) = (DVec3::from(*half_u_m), DVec3::from(*half_v_m));
            let at = |[u, v]: [f64; 2]| {
                DVec3::from(*center_m) + (2.0 * u - 1.0) * a + (2.0 * v - 1.0) * b
            };
            let area = 4.0 * a.cross(b) / count;
            camera::grid(n).map(|place| part(at(place), area)).collect()
        }
        Shape::Mesh {
            positions_m,
            triangles,
        } => triangles
            .iter()
            .flat_map(|triangle| {
                let [a, b, c] = triangle.map(|i| DVec3::from(positions_m[i as usize]));
                // Half of the cells of the parallelogram, those beyond the diagonal folded back.
                let area = 0.5 * (b - a).cross(c - a) / count;
                camera::grid(n).map(move |[u, v]| {
                    let [u, v] = if u + v > 1.0 {
                        [1.0 - u, 1.0 - v]
                    } else {
                        [u, v]
                    };
                    (a + u * (b - a) + v * (c - a), area)
                })
            })
            .map(|(point, area)| part(point, area))
            .collect(),
        Shape::Box { .. } => panic!("no question has a glowing box"),
    }
}

/// The picture of what reflects once: as many directions of the hemisphere as asked from k × k places of each pixel.
pub(crate) fn by_directions(scene: &Scene, k: u32, n: u32) -> Vec<f64> {
    camera::picture(scene, camera::grid(k), |at| {
        let hit = first(scene, at);
        reflectance(&hit)
            * mean_over_hemisphere(&hit, n, |ray| match nearest(scene, &ray) {
                Some(other) => other.emitted(ray.direction),
                None => sky(scene, ray.direction),
            })
    })
}

/// The picture of what nothing hides from the sky: ∫ L cos θ dω over n × n parts of each cell of the sky.
pub(crate) fn by_sky(scene: &Scene, n: u32) -> Vec<f64> {
    let Some(Sky::Map {
        zenith,
        meridian,
        rows,
        columns,
        ..
    }) = &scene.sky
    else {
        panic!("the sky has cells");
    };
    let (up, first_column) = (DVec3::from(*zenith), DVec3::from(*meridian));
    let (polar, around) = (f64::from(rows * n), f64::from(columns * n));
    let part = |i: u32| {
        let theta = PI * (f64::from(i / (columns * n)) + 0.5) / polar;
        let phi = TAU * (f64::from(i % (columns * n)) + 0.5) / around;
        let level = cos(phi) * first_column + sin(phi) * up.cross(first_column);
        let direction = cos(theta) * up + sin(theta) * level;
        let angle = sin(theta) * (PI / polar) * (TAU / around);
        (direction, sky(scene, direction) * angle)
    };
    let parts: Vec<_> = (0..rows * n * columns * n)
        .map(part)
        .filter(|(_, light)| *light > 0.0)
        .collect();
    camera::picture(scene, camera::grid(1), |at| {
        let hit = first(scene, at);
        let irradiance = parts
            .iter()
            .map(|(direction, light)| light * direction.dot(hit.normal).max(0.0));
        reflectance(&hit) / PI * irradiance.sum::<f64>()
    })
}

/// The picture of a closed room, bounce by bounce. The light of the first bounce is as it comes; that of all later ones is the
/// same everywhere on the walls, so that one place is enough.
pub(crate) fn room(scene: &Scene, directions: u32) -> Vec<f64> {
    let direct = |hit: &Hit<'_>, direction: DVec3| {
        let reflected = reflectance(hit) / PI * without_extent(scene, hit);
        hit.emitted(direction) + reflected
    };
    let wall = first(scene, [0.13, -0.28]);
    let seen = |ray: Ray| nearest(scene, &ray).expect("the room is closed");
    let once = mean_over_hemisphere(&wall, directions, |ray| direct(&seen(ray), ray.direction));
    let again = mean_over_hemisphere(&wall, directions, |ray| reflectance(&seen(ray)));
    let (mut rest, mut bounce) = (0.0, reflectance(&wall) * once);
    for _ in 0..300 {
        rest += bounce;
        bounce *= again;
    }
    camera::picture(scene, camera::grid(2), |at| {
        let ray = camera::ray(scene, at, [0.0; 2]);
        direct(&seen(ray), ray.direction) + rest
    })
}

/// What the camera sees at a place of the film.
fn first(scene: &Scene, at: [f64; 2]) -> Hit<'_> {
    let ray = camera::ray(scene, at, [0.0; 2]);
    let mut hit = nearest(scene, &ray).expect("the picture is full");
    if hit.normal.dot(ray.direction) > 0.0 {
        hit.normal = -hit.normal;
    }
    hit
}

fn reflectance(hit: &Hit<'_>) -> f64 {
    match hit.object.material {
        Material::Diffuse { reflectance } => reflectance,
        other => panic!("{other:?} is not diffuse"),
    }
}

/// The mean of a value over as many directions as asked, as dense as the cosine of the angle with the normal (Nusselt's analogy).
fn mean_over_hemisphere(hit: &Hit<'_>, directions: u32, value: impl Fn(Ray) -> f64) -> f64 {
    let (u, v) = hit.normal.any_orthonormal_pair();
    let rays = camera::lattice(directions).map(|[square, turn]| {
        let (sine, cosine) = sin_cos(TAU * turn);
        let flat = square.sqrt() * (cosine * u + sine * v);
        Ray {
            origin: hit.point,
            direction: flat + (1.0 - square).sqrt() * hit.normal,
        }
    });
    rays.map(value).sum::<f64>() / f64::from(directions)
}
