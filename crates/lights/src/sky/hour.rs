//! The sky at one moment.

use super::guide::Guide;
use super::hosek_wilkie::{self, BANDS, Band, HosekWilkie, Weights};
use core::f32::consts::TAU;
use etalon_math::{Frame, float};
use glam::Vec3;

/// Where the sun is, the sky that belongs to it, and how directions to both are chosen.
#[derive(Clone, Debug)]
pub(crate) struct Hour<'a> {
    /// Toward the sun, in the light's space.
    pub(crate) sun: Frame,
    /// The azimuth of the sun, in turns.
    pub(crate) turn: f32,
    /// How directions are chosen.
    pub(crate) guide: &'a Guide,
    sky: Sky<'a>,
}

/// Values in the bands, made before or on demand.
#[derive(Clone, Debug)]
enum Sky<'a> {
    Still(&'a StillSky),
    Passing(&'a HosekWilkie, Weights, [f32; BANDS]),
}

/// The sky while the sun is at one elevation.
#[derive(Clone, Debug)]
pub(crate) struct StillSky {
    pub(crate) bands: [Band; BANDS],
    /// The mean radiance over the disk of the sun.
    pub(crate) mean_sun: [f32; BANDS],
}

impl StillSky {
    /// With the sun at `theta` from the zenith (rad).
    pub(crate) fn new(model: &HosekWilkie, theta: f32) -> Self {
        Self {
            bands: model.bands(&hosek_wilkie::weights(theta)),
            mean_sun: std::array::from_fn(|band| model.mean_sun(band, theta)),
        }
    }
}

/// The azimuth of a direction, in turns.
pub(crate) fn turn_of(direction: Vec3) -> f32 {
    float::atan2(direction.y, direction.x) / TAU
}

impl<'a> Hour<'a> {
    /// A sky that stands still, with the sun in the direction `sun`.
    #[inline]
    pub(crate) fn still(sun: Frame, turn: f32, sky: &'a StillSky, guide: &'a Guide) -> Self {
        Self {
            sun,
            turn,
            guide,
            sky: Sky::Still(sky),
        }
    }

    /// A sky of many, with the sun in the direction `sun` at `theta` from the zenith (rad), whose mean radiance is given.
    #[inline]
    pub(crate) fn passing(
        sun: Vec3,
        theta: f32,
        model: &'a HosekWilkie,
        mean_sun: [f32; BANDS],
        guide: &'a Guide,
    ) -> Self {
        Self {
            sun: Frame::from_normal(sun),
            turn: turn_of(sun),
            guide,
            sky: Sky::Passing(model, hosek_wilkie::weights(theta), mean_sun),
        }
    }

    /// The radiance of the sky in a band, for the cosine to the zenith and the angle to the sun, above ground of this albedo.
    #[inline]
    pub(crate) fn radiance(&self, band: usize, cos: f32, gamma: f32, albedo: f32) -> f32 {
        match &self.sky {
            Sky::Still(sky) => hosek_wilkie::radiance(&sky.bands[band], cos, gamma, albedo),
            Sky::Passing(model, weights, _) => {
                hosek_wilkie::radiance(&model.band(weights, band), cos, gamma, albedo)
            }
        }
    }

    /// The mean radiance over the disk of the sun.
    #[inline]
    pub(crate) fn mean_sun(&self, band: usize) -> f32 {
        match &self.sky {
            Sky::Still(sky) => sky.mean_sun[band],
            Sky::Passing(.., mean_sun) => mean_sun[band],
        }
    }
}
