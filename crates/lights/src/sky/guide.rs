//! Directions toward the clear sky, chosen by its brightness and in the cone of the sun.
//!
//! The sun has a share of the samples, uniform in its cone; the others go by a table of the sky's brightness over φ/2π and
//! 2θ/π, bilinear, φ from the azimuth of the sun, with dω = π² sin θ du dv.

use super::hosek_wilkie::{self, BANDS, Band};
use super::sun_disk::SunDisk;
use core::f32::consts::{FRAC_PI_2, PI, TAU};
use etalon_math::float;
use etalon_sampling::discrete::Bilinear;
use glam::{Vec2, Vec3};

/// Columns and rows of the table of brightness.
const COLUMNS: usize = 128;
const ROWS: usize = 64;

/// Share of the table that is the sky's mean, so that it is zero nowhere.
const FLOOR: f32 = 0.05;

/// Bounds of the share of samples that the sun has, if there are sun and sky.
const SHARE: [f32; 2] = [0.1, 0.7];

/// The albedo of the ground that the table is made for.
const ALBEDO: f32 = 0.3;

/// How directions are chosen while the sun is at one elevation.
#[derive(Clone, Debug)]
pub(crate) struct Guide {
    table: Option<Bilinear>,
    /// The share of samples that the sun has.
    pub(crate) sun_share: f32,
    /// ∫L dω, the mean over the wavelengths of the model.
    pub(crate) irradiance: f64,
}

impl Guide {
    /// For a sky of these `bands` times `sky_scale` while the sun is at `theta` from the zenith and shines with the
    /// radiance `sun` in each band.
    pub(crate) fn new(
        bands: &[Band; BANDS],
        sky_scale: f32,
        theta: f32,
        sun: &[f32; BANDS],
        disk: &SunDisk,
    ) -> Self {
        let toward_sun = hosek_wilkie::direction(theta, 0.0);
        // Without the first band, which is far beyond what is seen.
        let mean = |values: &dyn Fn(usize) -> f32| {
            (1..BANDS).map(values).sum::<f32>() / (BANDS - 1) as f32
        };
        let mut nodes = Vec::with_capacity((COLUMNS + 1) * ROWS);
        let mut sky = 0.0;
        for row in 0..ROWS {
            let theta = FRAC_PI_2 * row as f32 / (ROWS - 1) as f32;
            let edge = if row == 0 || row == ROWS - 1 {
                0.5
            } else {
                1.0
            };
            for column in 0..=COLUMNS {
                let phi = TAU * column as f32 / COLUMNS as f32;
                let toward = hosek_wilkie::direction(theta, phi);
                let gamma = angle_between(toward, toward_sun);
                let cos = toward.z.max(0.0);
                let bright = mean(&|band| hosek_wilkie::radiance(&bands[band], cos, gamma, ALBEDO));
                // Not quite zero at the zenith, where a cell is a wedge.
                let sine = float::sin(theta).max(0.2 * FRAC_PI_2 / (ROWS - 1) as f32);
                nodes.push(bright * sine);
                if column < COLUMNS {
                    sky += f64::from(bright * float::sin(theta) * edge);
                }
            }
        }
        sky *= f64::from(PI * PI) / (COLUMNS * (ROWS - 1)) as f64 * f64::from(sky_scale);
        let floor = FLOOR * nodes.iter().sum::<f32>() / nodes.len() as f32;
        for node in &mut nodes {
            *node += floor;
        }
        let disk = mean(&|band| sun[band]) * disk.solid_angle() * disk.scale;
        let irradiance = sky + f64::from(disk);
        let share = (f64::from(disk) / irradiance.max(f64::MIN_POSITIVE)) as f32;
        Self {
            table: Bilinear::new(&nodes, COLUMNS + 1).ok(),
            sun_share: match (sky > 0.0, disk > 0.0) {
                (true, true) => share.clamp(SHARE[0], SHARE[1]),
                (_, sun) => f32::from(u8::from(sun)),
            },
            irradiance,
        }
    }

    /// A direction toward the sky while the sun is `turn` turns from x.
    #[inline]
    pub(crate) fn choose(&self, turn: f32, u: Vec2) -> Option<Vec3> {
        let place = self.table.as_ref()?.sample(u);
        let phi = TAU * (place.x + turn);
        Some(hosek_wilkie::direction(FRAC_PI_2 * place.y, phi))
    }

    /// The density of [`Guide::choose`] per steradian.
    #[inline]
    pub(crate) fn density(&self, turn: f32, local: Vec3) -> f32 {
        let Some(table) = &self.table else {
            return 0.0;
        };
        let sine = local.truncate().length();
        let x = float::atan2(local.y, local.x) / TAU - turn;
        let place = Vec2::new(x - x.floor(), float::atan2(sine, local.z) / FRAC_PI_2);
        table.density(place) / (PI * PI * sine.max(1e-6))
    }
}

/// The angle between two unit vectors, exact where it is small (rad).
#[inline]
pub(crate) fn angle_between(a: Vec3, b: Vec3) -> f32 {
    2.0 * float::asin((0.5 * (a - b).length()).min(1.0))
}
