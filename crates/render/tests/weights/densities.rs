//! Value and densities of a path, written down in double precision.
//!
//! With aᵢ and bᵢ the densities per unit area (per unit solid angle at the sky) with which walks from the
//! light and from the camera arrive at xᵢ, technique s has the density Π_{i<s} aᵢ · Π_{i≥s} bᵢ. Each
//! lane's are asked of models in which that lane stands first and so chooses.

use crate::course::Course;
use crate::scripted_bsdf::discrete;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Camera, LightKind, LightSampleContext, Surfaces, TransportMode, World,
};

/// Wavelengths of a path.
pub(crate) const LANES: usize = 4;

/// Value and densities of a path.
#[derive(Clone, Debug)]
pub(crate) struct Densities {
    /// f, per lane.
    pub(crate) value: [f64; LANES],
    /// Whether a walk would scatter along it had the lane chosen: 1 or 0.
    pub(crate) chance: [f64; LANES],
    /// n·p by technique and lane.
    made: Vec<[f64; LANES]>,
    /// The sum of all, and of mergings.
    pub(crate) total: f64,
}

/// The first surface from the light, as light sampling sees it on the way from the camera.
fn receiver<W: World>(world: &W, course: &Course, wavelengths: &Wavelengths) -> LightSampleContext {
    let wo = course.direction(1, 2);
    let vertex = &course.surfaces[0];
    LightSampleContext::new(vertex, wo, &world.surfaces().bsdf(vertex, wo, wavelengths)).combined()
}

/// A path as one lane sees it that chooses.
struct Lane {
    value: f64,
    /// aᵢ, and a₀ by light sampling.
    from_light: Vec<f64>,
    sampled: f64,
    /// bᵢ.
    from_camera: Vec<f64>,
}

impl Lane {
    fn of<W: World>(world: &W, course: &Course, lane: usize) -> Self {
        let wavelengths = course.wavelengths.rotated(lane);
        let last = course.surfaces.len();
        let start = &course.start;
        // |cos| at a node toward its neighbour, over the squared distance: area per solid angle.
        let per_area = |node: usize, from: usize| {
            let normal = match node {
                0 => course.lamp.map(|lamp| lamp.normal),
                _ => Some(course.surfaces[node - 1].normal),
            };
            let direction = match node {
                0 => start.ray.direction,
                _ => course.direction(node, from),
            };
            let cos = normal.map_or(1.0, |normal| normal.dot(direction).abs());
            f64::from(cos) / f64::from(course.distance_squared(node, from))
        };
        // Density of leaving a surface, and value; per projected solid angle, with η, if discrete.
        let scatter = |node: usize, from: usize, to: usize, mode: TransportMode| {
            let vertex = &course.surfaces[node - 1];
            let (wo, wi) = (course.direction(node, from), course.direction(node, to));
            let bsdf = world.surfaces().bsdf(vertex, wo, &wavelengths);
            if !course.sharp[node - 1] {
                let density = bsdf.density(wo, wi).hero();
                return (f64::from(density), f64::from(bsdf.eval(wo, wi, mode).x));
            }
            discrete(&bsdf, wo, wi, mode).map_or((0.0, 0.0), |sample| {
                let delta = f64::from(vertex.normal.dot(wi).abs() * sample.eta);
                let chance = f64::from(sample.chance.lanes().x);
                (chance * delta, f64::from(sample.value.x) * delta)
            })
        };
        let camera = world.camera();
        let seen = camera.connect(course.surfaces[last - 1].position, course.lens, 0.0, 0.0);
        let film = f64::from(seen.map_or(0.0, |seen| seen.weight)) * {
            let direction = course.direction(last, last + 1);
            f64::from(course.surfaces[last - 1].normal.dot(direction).abs())
        };
        let mut from_light = vec![
            f64::from(start.density.origin),
            f64::from(start.density.ray) * per_area(1, 0),
        ];
        let mut from_camera = vec![0.0; last + 1];
        from_camera[last] = film;
        let mut value = film;
        for node in (1..=last).rev() {
            let (density, factor) = scatter(node, node + 1, node - 1, TransportMode::Radiance);
            let area = per_area(node - 1, node);
            from_camera[node - 1] = density * area;
            value *= factor * area;
        }
        for node in 1..last {
            let (density, _) = scatter(node, node - 1, node + 1, TransportMode::Importance);
            from_light.push(density * per_area(node + 1, node));
        }
        if !start.origin.can_be_hit() {
            from_camera[0] = 0.0;
        }
        let direction = course.direction(1, 0);
        let receiver = receiver(world, course, &wavelengths);
        let sampled = match (start.origin, &course.lamp) {
            (LightKind::Surface, Some(lamp)) => {
                f64::from(world.light_density(&receiver, lamp, direction).hero()) * per_area(0, 1)
            }
            (LightKind::Sky, _) => f64::from(world.background_density(&receiver, direction).hero()),
            _ => f64::from(world.light_sample_density(&receiver, start)),
        };
        // Radiance, intensity or irradiance, from the weight of the emission.
        let power = f64::from(start.weight[lane])
            * f64::from(start.density.origin)
            * f64::from(start.density.ray);
        let leaving = course.lamp.map_or(1.0, |lamp| {
            f64::from(lamp.normal.dot(start.ray.direction).abs())
        });
        Self {
            value: value * power / leaving,
            from_light,
            sampled,
            from_camera,
        }
    }

    /// Density of the technique with `light` vertices from the light.
    fn technique(&self, light: usize) -> f64 {
        let theirs: f64 = self.from_camera[light..].iter().product();
        match light {
            1 => self.sampled * theirs,
            _ => self.from_light[..light].iter().product::<f64>() * theirs,
        }
    }
}

impl Densities {
    /// Those of a path; `area` is the number of photons times π r², 0 without mergings.
    pub(crate) fn of<W: World>(world: &W, course: &Course, area: f64) -> Self {
        let last = course.surfaces.len();
        let lanes = [0, 1, 2, 3].map(|lane| Lane::of(world, course, lane));
        let scatters = |node: usize| !course.sharp[node - 1];
        let possible = |light: usize| match light {
            0 => true,
            1 => scatters(1),
            s if s == last + 1 => scatters(last),
            s => scatters(s - 1) && scatters(s),
        };
        let samples = |light: usize| {
            if light == last + 1 {
                f64::from(crate::PIXELS)
            } else {
                1.0
            }
        };
        let made: Vec<[f64; LANES]> = (0..=last + 1)
            .map(|light| match possible(light) {
                true => [0, 1, 2, 3].map(|k: usize| samples(light) * lanes[k].technique(light)),
                false => [0.0; LANES],
            })
            .collect();
        let merged: f64 = (1..=last)
            .filter(|node| scatters(*node))
            .flat_map(|node| lanes.iter().map(move |lane| (node, lane)))
            .map(|(node, lane)| {
                let walks: f64 = lane.from_light[..=node].iter().product();
                walks * lane.from_camera[node..].iter().product::<f64>() * area
            })
            .sum();
        let total = made.iter().flatten().sum::<f64>() + merged;
        Self {
            value: [0, 1, 2, 3].map(|k: usize| lanes[k].value),
            chance: [0, 1, 2, 3].map(|k: usize| {
                let walk: f64 = lanes[k].from_light.iter().product();
                f64::from(walk > 0.0)
            }),
            made,
            total,
        }
    }

    /// n·p of a technique, had `lane` chosen.
    pub(crate) fn made(&self, light: usize, lane: usize) -> f64 {
        self.made[light][lane]
    }

    /// Whether smooth dispersion leaves one wavelength.
    pub(crate) fn alone(&self) -> bool {
        self.chance.iter().sum::<f64>() == 1.0
    }
}
