//! The course of the sun: it stands still, or passes through days and hours while the shutter is open.

use super::calendar::Calendar;
use super::guide::Guide;
use super::hosek_wilkie::{self, BANDS, HosekWilkie};
use super::hour::{Hour, StillSky, turn_of};
use super::sun_disk::SunDisk;
use core::f32::consts::FRAC_PI_2;
use etalon_math::{Frame, float};
use glam::Vec3;

/// Where the sun is at each moment, and what follows of it.
#[derive(Clone, Debug)]
pub(crate) enum Course {
    /// In one place.
    Still(Box<Still>),
    /// Passing by.
    Passing(Box<Passing>),
}

/// The sun in one place.
#[derive(Clone, Debug)]
pub(crate) struct Still {
    sun: Frame,
    turn: f32,
    sky: StillSky,
    guide: Guide,
}

/// The sun passing by.
#[derive(Clone, Debug)]
pub(crate) struct Passing {
    calendar: Calendar,
    /// The mean radiance of the sun's disk at elevations π/2 (i/[`MEANS`])³.
    mean_sun: Vec<[f32; BANDS]>,
    /// Of the skies with the sun at elevations π/2 (i/[`GUIDES`])³.
    guides: Vec<Guide>,
}

const MEANS: usize = 128;
const GUIDES: usize = 24;

/// How many moments a mean over the time is made of.
const MOMENTS: usize = 256;

impl Course {
    /// The sun stays in the direction `sun` (unit, in the light's space).
    pub(crate) fn still(model: &HosekWilkie, sun: Vec3, disk: &SunDisk, sky_scale: f32) -> Self {
        let theta = float::atan2(sun.truncate().length(), sun.z).min(FRAC_PI_2);
        let sky = StillSky::new(model, theta);
        Self::Still(Box::new(Still {
            sun: Frame::from_normal(sun),
            turn: turn_of(sun),
            guide: Guide::new(&sky.bands, sky_scale, theta, &sky.mean_sun, disk),
            sky,
        }))
    }

    /// The sun passes through a calendar.
    pub(crate) fn passing(
        model: &HosekWilkie,
        calendar: Calendar,
        disk: &SunDisk,
        sky_scale: f32,
    ) -> Self {
        let theta = |i: usize, of: usize| FRAC_PI_2 * (1.0 - (i as f32 / of as f32).powi(3));
        let mean = |i: usize| std::array::from_fn(|band| model.mean_sun(band, theta(i, MEANS)));
        let guide = |i: usize| {
            let StillSky { bands, mean_sun } = StillSky::new(model, theta(i, GUIDES));
            Guide::new(&bands, sky_scale, theta(i, GUIDES), &mean_sun, disk)
        };
        Self::Passing(Box::new(Passing {
            calendar,
            mean_sun: (0..=MEANS).map(mean).collect(),
            guides: (0..=GUIDES).map(guide).collect(),
        }))
    }

    /// The sky at a moment within the sensor's shutter interval; `None` by night.
    #[inline]
    pub(crate) fn hour<'a>(&'a self, model: &'a HosekWilkie, time: f32) -> Option<Hour<'a>> {
        match self {
            Self::Still(still) => (still.sun.n.z >= 0.0)
                .then(|| Hour::still(still.sun, still.turn, &still.sky, &still.guide)),
            Self::Passing(passing) => passing.hour(model, time),
        }
    }

    /// ∫L dω, the mean over the wavelengths of the model and over the time.
    pub(crate) fn irradiance(&self) -> f64 {
        match self {
            Self::Still(still) if still.sun.n.z >= 0.0 => still.guide.irradiance,
            Self::Still(_) => 0.0,
            Self::Passing(passing) => {
                let moments = 0..MOMENTS;
                let of = |i: usize| {
                    let [theta, _] = passing.sun_at((i as f32 + 0.5) / MOMENTS as f32);
                    passing.guide(theta).map_or(0.0, |guide| guide.irradiance)
                };
                moments.map(of).sum::<f64>() / MOMENTS as f64
            }
        }
    }
}

impl Passing {
    /// Angle from the zenith and azimuth of the sun at a moment (rad).
    fn sun_at(&self, time: f32) -> [f32; 2] {
        (self.calendar.moment(time).sun_position()).map(|angle| angle as f32)
    }

    /// ∛(2η/π) of the sun's elevation η; `None` by night.
    fn height(theta: f32) -> Option<f32> {
        (theta <= FRAC_PI_2).then(|| float::cbrt(1.0 - theta / FRAC_PI_2).min(1.0))
    }

    /// The guide of the nearest elevation.
    fn guide(&self, theta: f32) -> Option<&Guide> {
        let place = Self::height(theta)? * GUIDES as f32;
        self.guides.get((place + 0.5) as usize)
    }

    fn hour<'a>(&'a self, model: &'a HosekWilkie, time: f32) -> Option<Hour<'a>> {
        let [theta, phi] = self.sun_at(time);
        let guide = self.guide(theta)?;
        let place = Self::height(theta)? * MEANS as f32;
        let low = (place as usize).min(MEANS - 1);
        let t = place - low as f32;
        let [a, b] = [&self.mean_sun[low], &self.mean_sun[low + 1]];
        let mean = std::array::from_fn(|band| a[band] + (b[band] - a[band]) * t);
        let sun = hosek_wilkie::direction(theta, phi);
        Some(Hour::passing(sun, theta, model, mean, guide))
    }
}
