//! All ways of a ray through mirrors, metals, glass and matter: split at every surface until nothing is left.

use crate::camera;
use crate::geometry::{Ray, nearest};
use etalon_conform::scene::{Interpolation, Material, Medium, Scene, Sky};
use etalon_math::float64::{asin, cos, ln, sin, sin_cos, tan};
use glam::{DVec2, DVec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::{PI, TAU};

/// The picture by n × n rays for each pixel.
pub(crate) fn traced(scene: &Scene, n: u32) -> Vec<f64> {
    camera::picture(scene, camera::grid(n), |at| {
        radiance(scene, camera::ray(scene, at, [0.0; 2]), None, 1.0)
    })
}

/// The picture of edges by as many rays as asked for each pixel.
pub(crate) fn covered(scene: &Scene, rays: u32) -> Vec<f64> {
    camera::picture(scene, camera::lattice(rays), |at| {
        radiance(scene, camera::ray(scene, at, [0.0; 2]), None, 1.0)
    })
}

/// The picture by n × n places in each pixel and as many as asked of the lens.
pub(crate) fn through_lens(scene: &Scene, n: u32, of_lens: u32) -> Vec<f64> {
    camera::picture(scene, camera::grid(n), |at| {
        let rays = camera::lattice(of_lens).map(|lens| camera::ray(scene, at, lens));
        let sum: f64 = rays.map(|ray| radiance(scene, ray, None, 1.0)).sum();
        sum / f64::from(of_lens)
    })
}

/// The radiance of the sky from a direction.
pub(crate) fn sky(scene: &Scene, direction: DVec3) -> f64 {
    match &scene.sky {
        None => 0.0,
        Some(Sky::Even { radiance }) => *radiance,
        Some(Sky::Map {
            interpolation,
            zenith,
            meridian,
            rows,
            columns,
            radiance,
        }) => {
            let (up, first) = (DVec3::from(*zenith), DVec3::from(*meridian));
            let level = DVec2::new(direction.dot(first), direction.dot(up.cross(first)));
            let polar = etalon_math::float64::acos(direction.dot(up).clamp(-1.0, 1.0));
            let azimuth = etalon_math::float64::atan2(level.y, level.x).rem_euclid(TAU);
            let at = |row: f64, column: f64| {
                let row = row.clamp(0.0, f64::from(rows - 1)) as u32;
                let column = column.rem_euclid(f64::from(*columns)) as u32;
                radiance[(row * columns + column) as usize]
            };
            let (down, across) = (polar / PI, azimuth / TAU * f64::from(*columns));
            let (row, column) = match interpolation {
                Interpolation::None => return at(down * f64::from(*rows), across),
                Interpolation::Linear => (down * f64::from(*rows) - 0.5, across - 0.5),
                Interpolation::RowsToPoles => (down * f64::from(rows - 1), across - 0.5),
            };
            let (i, j) = (row.floor(), column.floor());
            let mix = |a: f64, b: f64, part: f64| a + part * (b - a);
            let of_row = |i: f64| mix(at(i, j), at(i, j + 1.0), column - j);
            mix(of_row(i), of_row(i + 1.0), row - i)
        }
    }
}

/// What a ray in a medium, which counts with this weight, brings back.
fn radiance(scene: &Scene, ray: Ray, medium: Option<Medium>, weight: f64) -> f64 {
    if weight < 1e-8 {
        return 0.0;
    }
    let Some(hit) = nearest(scene, &ray) else {
        return sky(scene, ray.direction);
    };
    let d = ray.direction;
    let from = |direction: DVec3| Ray {
        origin: hit.point,
        direction,
    };
    let mirrored = from(d - 2.0 * d.dot(hit.normal) * hit.normal);
    let left = match medium {
        Some(medium) if medium.scattering_per_m > 0.0 => return walk(scene, ray, medium),
        Some(medium) => in_steps(medium.absorption_per_m, hit.distance),
        None => 1.0,
    };
    let follow = |ray: Ray, medium: Option<Medium>, share: f64| {
        share * radiance(scene, ray, medium, weight * left * share)
    };
    let further = match hit.object.material {
        Material::Diffuse { reflectance } => {
            assert_eq!(reflectance, 0.0, "the way ends on what is black");
            0.0
        }
        Material::Mirror { reflectance } => follow(mirrored, medium, reflectance),
        Material::Conductor { n, k } => {
            let share = complex_fresnel(d.dot(hit.normal).abs(), n, k);
            follow(mirrored, medium, share)
        }
        Material::Glass { n } => {
            let entering = d.dot(hit.normal) < 0.0;
            let index = if entering { n } else { 1.0 / n };
            let share = fresnel(d.dot(hit.normal).abs(), index);
            let mut sum = follow(mirrored, medium, share);
            if share < 1.0 {
                sum += follow(from(refracted(d, hit.normal, index)), medium, 1.0 - share);
            }
            sum
        }
        Material::RoughConductor { .. } => panic!("rays go on in one direction"),
        Material::Nothing => {
            let entering = d.dot(hit.normal) < 0.0;
            let inside = if entering { hit.object.interior } else { None };
            follow(from(d), inside, 1.0)
        }
    };
    left * (hit.emitted(d) + further)
}

/// What is left by thin layers, each of which takes its share, by the middle rule.
fn in_steps(absorption: f64, distance: f64) -> f64 {
    const STEPS: i32 = 1000;
    let half = 0.5 * absorption * distance / f64::from(STEPS);
    ((1.0 - half) / (1.0 + half)).powi(STEPS)
}

/// Random steps through matter that loses nothing, to where they leave it.
fn walk(scene: &Scene, mut ray: Ray, medium: Medium) -> f64 {
    assert_eq!(medium.absorption_per_m, 0.0, "only scattering");
    // A seed for each ray.
    let seed = ray.origin.to_array().map(f64::to_bits);
    let mut random = Pcg64Mcg::seed_from_u64(seed[0] ^ seed[1].rotate_left(21) ^ seed[2]);
    loop {
        let step = -ln(1.0 - random.random::<f64>()) / medium.scattering_per_m;
        let border = nearest(scene, &ray).expect("the walk is inside");
        if step > border.distance {
            let out = Ray {
                origin: border.point,
                direction: ray.direction,
            };
            return radiance(scene, out, None, 1.0);
        }
        let z = 2.0 * random.random::<f64>() - 1.0;
        let (sine, cosine) = sin_cos(TAU * random.random::<f64>());
        let across = (1.0 - z * z).sqrt();
        ray = Ray {
            origin: ray.origin + step * ray.direction,
            direction: DVec3::new(across * cosine, across * sine, z),
        };
    }
}

/// The direction behind a surface, by Snell's law.
fn refracted(d: DVec3, normal: DVec3, index: f64) -> DVec3 {
    let toward = if d.dot(normal) < 0.0 { normal } else { -normal };
    let along = (d - d.dot(toward) * toward) / index;
    along - (1.0 - along.length_squared()).sqrt() * toward
}

/// Fresnel's own form, by sines and tangents of the angles.
fn fresnel(cosine: f64, index: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    if sine >= index {
        return 1.0;
    }
    if sine < 1e-6 {
        return ((index - 1.0) / (index + 1.0)).powi(2);
    }
    let (i, t) = (asin(sine), asin(sine / index));
    let (s, p) = (sin(i - t) / sin(i + t), tan(i - t) / tan(i + t));
    0.5 * (s * s + p * p)
}

/// Fresnel's equations with the complex angle behind the surface.
pub(crate) fn complex_fresnel(cosine: f64, n: f64, k: f64) -> f64 {
    let times = |a: DVec2, b: DVec2| DVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
    let m = DVec2::new(n, k);
    let square = times(m, m);
    // m cos θ' = √(m² − sin² θ), by half the angle.
    let under = square - DVec2::new(1.0 - cosine * cosine, 0.0);
    let half = 0.5 * etalon_math::float64::atan2(under.y, under.x);
    let behind = under.length().sqrt() * DVec2::new(cos(half), sin(half));
    let ratio = |a: DVec2, b: DVec2| (a - b).length_squared() / (a + b).length_squared();
    let s = ratio(DVec2::new(cosine, 0.0), behind);
    let p = ratio(cosine * square, behind);
    0.5 * (s + p)
}
