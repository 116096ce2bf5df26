//! What the planes look like, exactly.
//!
//! With L(i, ↑, n) the radiance that arrives at plane i's upper neighbour… read upward: a ray that
//! travels from the gap below plane i in direction ↑ with n segments left meets plane i and sees
//!
//! ```text
//! L(i, ↑, n) = e + τ·L(i + 1, ↑, n − 1) + (1 − τ)·ρ·L(i, ↓, n − 1)      L(·, ·, 0) = 0
//! ```
//!
//! with e, τ and ρ the plane's emission toward the ray, transmittance and reflectance, and the
//! mirror image of this downward. Beyond the last plane is the sky.

use crate::world::Stack;
use etalon_spectrum::{Wavelengths, sensor, sensor_response};
use glam::Vec4;

/// What the camera sees along its ray.
pub(crate) struct Exact<'a> {
    pub stack: &'a Stack,
    /// Longest path in segments.
    pub max_depth: u32,
    /// Whether lights are hidden.
    pub hidden: bool,
}

/// Longest path that is followed for unlimited depth: what is left out is below 10⁻⁸.
const UNLIMITED: u32 = 90;

/// A ray in a gap between planes.
#[derive(Clone, Copy)]
struct Ray1D {
    /// Number of planes below.
    gap: usize,
    up: bool,
    segments: u32,
    /// Nothing was met yet; nothing but what lets light pass was met.
    first: bool,
    straight: bool,
}

impl Exact<'_> {
    /// Radiance at a wavelength (nm).
    pub(crate) fn radiance(&self, lambda: f32) -> f64 {
        let gap = |height: f32| {
            self.stack
                .planes
                .iter()
                .filter(|p| p.height < height)
                .count()
        };
        let ray = Ray1D {
            gap: gap(self.stack.camera.height),
            up: self.stack.camera.up,
            segments: self.max_depth.min(UNLIMITED),
            first: true,
            straight: true,
        };
        let mut known = vec![None; (self.stack.planes.len() + 1) * 8 * (UNLIMITED as usize + 1)];
        self.along(ray, lambda, &mut known)
    }

    fn along(&self, ray: Ray1D, lambda: f32, known: &mut [Option<f64>]) -> f64 {
        if ray.segments == 0 {
            return 0.0;
        }
        let flags = [ray.up, ray.first, ray.straight];
        let flags = flags.iter().fold(0, |sum, &f| sum * 2 + usize::from(f));
        let key = (ray.gap * 8 + flags) * (UNLIMITED as usize + 1) + ray.segments as usize;
        if let Some(value) = known[key] {
            return value;
        }
        let value = self.step(ray, lambda, known);
        known[key] = Some(value);
        value
    }

    fn step(&self, ray: Ray1D, lambda: f32, known: &mut [Option<f64>]) -> f64 {
        let planes = &self.stack.planes;
        let ahead = if ray.up {
            Some(ray.gap)
        } else {
            ray.gap.checked_sub(1)
        };
        let Some(plane) = ahead.and_then(|i| planes.get(i)) else {
            let hidden = self.hidden && ray.straight;
            return if hidden {
                0.0
            } else {
                f64::from((self.stack.sky)(lambda))
            };
        };
        let beyond = if ray.up { ray.gap + 1 } else { ray.gap - 1 };
        let emits = plane.emission.iter().any(|e| e(550.0) > 0.0);
        if self.hidden && ray.first && emits {
            return self.along(Ray1D { gap: beyond, ..ray }, lambda, known);
        }
        let at = |curve: fn(f32) -> f32| f64::from(curve(lambda));
        let passing = at(plane.passing);
        let next = Ray1D {
            segments: ray.segments - 1,
            first: false,
            ..ray
        };
        let straight_on = Ray1D {
            gap: beyond,
            ..next
        };
        let back = Ray1D {
            up: !ray.up,
            straight: false,
            ..next
        };
        at(plane.emission[usize::from(!ray.up)])
            + passing * self.along(straight_on, lambda, known)
            + (1.0 - passing) * at(plane.reflectance) * self.along(back, lambda, known)
    }

    /// The linear Rec.709 colour of a sample's expectation.
    pub(crate) fn colour(&self) -> [f64; 3] {
        match self.stack.fixed {
            Some(wavelengths) => mean_of(&wavelengths, |lambda| self.radiance(lambda)),
            None => integral(|lambda| self.radiance(lambda)),
        }
    }
}

/// The colour of a spectrum. The response is linear between whole nanometres.
pub(crate) fn integral(radiance: impl Fn(f32) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for nm in 360..=830 {
        let weight = if nm == 360 || nm == 830 { 0.5 } else { 1.0 };
        let lambda = nm as f32;
        let value = weight * radiance(lambda);
        let response = sensor::response(Vec4::splat(lambda));
        for (sum, response) in sum.iter_mut().zip(response) {
            *sum += value * f64::from(response.x);
        }
    }
    sum
}

/// The mean of what the four wavelengths say.
pub(crate) fn mean_of(wavelengths: &Wavelengths, radiance: impl Fn(f32) -> f64) -> [f64; 3] {
    let lanes = wavelengths.lambda.to_array().map(|l| radiance(l) as f32);
    let rgb = sensor_response(wavelengths).rgb(Vec4::from_array(lanes) * 0.25);
    rgb.to_array().map(f64::from)
}
