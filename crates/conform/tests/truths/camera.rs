//! The rays of a scene's camera.

use crate::geometry::Ray;
use etalon_conform::scene::{Projection, Scene};
use etalon_math::float64::{cos, sin, tan};
use glam::DVec3;
use std::f64::consts::TAU;

/// The ray through a place of the film (x from −1 at the left to 1, y from −1 at the bottom to 1) and one of the lens, given as
/// two numbers from 0 to 1.
pub(crate) fn ray(scene: &Scene, [x, y]: [f64; 2], lens: [f64; 2]) -> Ray {
    let camera = &scene.camera;
    let origin = DVec3::from(camera.origin_m);
    let forward = (DVec3::from(camera.target_m) - origin).normalize();
    let right = forward.cross(camera.up.into()).normalize();
    let across = x * right + y * right.cross(forward);
    match camera.projection {
        Projection::Orthographic { width_m } => Ray {
            origin: origin + 0.5 * width_m * across,
            direction: forward,
        },
        Projection::Pinhole {
            field_of_view_degrees,
        } => {
            let slope = tan(0.5 * field_of_view_degrees.to_radians());
            Ray {
                origin,
                direction: (forward + slope * across).normalize(),
            }
        }
        Projection::ThinLens {
            field_of_view_degrees,
            lens_radius_m,
            focus_distance_m,
        } => {
            let slope = tan(0.5 * field_of_view_degrees.to_radians());
            let sharp = origin + focus_distance_m * (forward + slope * across);
            let (radius, angle) = (lens_radius_m * lens[0].sqrt(), TAU * lens[1]);
            let from = origin + radius * (cos(angle) * right + sin(angle) * right.cross(forward));
            Ray {
                origin: from,
                direction: (sharp - from).normalize(),
            }
        }
    }
}

/// The middles of n × n cells of the unit square.
pub(crate) fn grid(n: u32) -> impl Iterator<Item = [f64; 2]> + Clone {
    let at = move |i: u32| (f64::from(i) + 0.5) / f64::from(n);
    (0..n * n).map(move |i| [at(i % n), at(i / n)])
}

/// As many places as asked in the unit square, no two of which have a coordinate in common: for values that jump at edges.
pub(crate) fn lattice(count: u32) -> impl Iterator<Item = [f64; 2]> + Clone {
    // Steps of the golden ratio.
    let step = 0.5 * (5.0_f64.sqrt() - 1.0);
    (0..count).map(move |i| {
        let along = (f64::from(i) + 0.5) / f64::from(count);
        [along, (step * f64::from(i)).fract()]
    })
}

/// The picture of which these places in each pixel, given in the unit square, have this value.
pub(crate) fn picture(
    scene: &Scene,
    places: impl Iterator<Item = [f64; 2]> + Clone,
    value: impl Fn([f64; 2]) -> f64,
) -> Vec<f64> {
    let (pixels, half) = (scene.pixels, 0.5 * f64::from(scene.pixels));
    let mean = |i: u32| {
        let (mut count, mut sum) = (0.0, 0.0);
        for [u, v] in places.clone() {
            let (column, row) = (f64::from(i % pixels) + u, f64::from(i / pixels) + v);
            count += 1.0;
            sum += value([column / half - 1.0, 1.0 - row / half]);
        }
        sum / count
    };
    (0..pixels * pixels).map(mean).collect()
}
