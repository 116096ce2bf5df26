//! The disk of the sun: how large and how bright it is.

use super::hosek_wilkie::SUN_RADIUS;
use core::f32::consts::TAU;
use etalon_math::float;

/// A disk in the sky.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SunDisk {
    /// 1 − cos of half of its aperture.
    pub(crate) one_minus_cos: f32,
    /// Sine of half of its aperture.
    pub(crate) sin_radius: f32,
    /// Factor on the sun's radiance: a disk of another aperture keeps the sun's irradiance.
    pub(crate) scale: f32,
    /// Whether it darkens toward its limb and toward the horizon.
    pub(crate) complex: bool,
}

impl SunDisk {
    /// The disk of an `aperture` (rad) and `scale` times the irradiance of the sun.
    pub(crate) fn new(aperture: f32, scale: f32, complex: bool) -> Self {
        let radius = 0.5 * aperture;
        let ratio = one_minus_cos(SUN_RADIUS) / one_minus_cos(radius);
        Self {
            one_minus_cos: one_minus_cos(radius),
            sin_radius: float::sin(radius),
            scale: scale * ratio,
            complex,
        }
    }

    /// The solid angle (sr).
    pub(crate) fn solid_angle(&self) -> f32 {
        TAU * self.one_minus_cos
    }
}

/// 1 − cos, exact where it is small.
fn one_minus_cos(angle: f32) -> f32 {
    let half = float::sin(0.5 * angle);
    2.0 * half * half
}
