//! How the tests decide: χ² of counts against expectations, and maps against their densities.
#![allow(dead_code, reason = "each test file uses its own part")]

use glam::{DVec3, Vec2, Vec3};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The probability of deviations as large as those of `counts` from `expected` (both with the
/// same sum). Cells that expect fewer than five are pooled.
pub(crate) fn chi_square(counts: &[f64], expected: &[f64]) -> f64 {
    let (mut statistic, mut cells) = (0.0, 0u32);
    let mut pool = (0.0, 0.0);
    for (&count, &expected) in counts.iter().zip(expected) {
        if expected < 5.0 {
            pool = (pool.0 + count, pool.1 + expected);
        } else {
            statistic += (count - expected).powi(2) / expected;
            cells += 1;
        }
    }
    if pool.1 >= 5.0 {
        statistic += (pool.0 - pool.1).powi(2) / pool.1;
        cells += 1;
    } else if pool.1 < 1e-6 && pool.0 > 0.0 {
        return 0.0;
    }
    ChiSquared::new(f64::from(cells - 1))
        .expect("several cells")
        .sf(statistic)
}

/// χ² of counts against equal expectations.
pub(crate) fn uniform(counts: &[f64]) -> f64 {
    let total: f64 = counts.iter().sum();
    chi_square(counts, &vec![total / counts.len() as f64; counts.len()])
}

/// A map of the square under test; two-dimensional results have z = 0.
pub(crate) struct Map<'a> {
    pub(crate) name: &'a str,
    pub(crate) sample: &'a dyn Fn(Vec2) -> Vec3,
    pub(crate) invert: &'a dyn Fn(Vec3) -> Vec2,
    pub(crate) density: &'a dyn Fn(Vec3) -> f32,
}

impl Map<'_> {
    /// Points of the square, a few thousand, none within 1 % of its border.
    fn interior() -> impl Iterator<Item = Vec2> {
        (0..53 * 61).map(|i| {
            let u = Vec2::new((i % 53) as f32 + 0.4, (i / 53) as f32 + 0.3);
            0.01 + 0.98 * u / Vec2::new(53.0, 61.0)
        })
    }

    /// The largest distance between u and the inverse of its image.
    pub(crate) fn round_trip_error(&self) -> f32 {
        Self::interior()
            .map(|u| (self.invert)((self.sample)(u)).distance(u))
            .fold(0.0, f32::max)
    }

    /// The largest relative deviation of the density from one over the Jacobian, the area (or
    /// solid angle) that the map gives a square of side 2h. Squares that a seam of the map
    /// divides (`seam`) are left out.
    pub(crate) fn jacobian_error(&self, h: f32, seam: &dyn Fn(Vec2) -> bool) -> f32 {
        Self::interior()
            .filter(|&u| !seam(u))
            .map(|u| {
                let at = |dx: f32, dy: f32| -> DVec3 {
                    (self.sample)(u + h * Vec2::new(dx, dy)).as_dvec3()
                };
                let along_x = (at(1.0, 0.0) - at(-1.0, 0.0)) / (2.0 * f64::from(h));
                let along_y = (at(0.0, 1.0) - at(0.0, -1.0)) / (2.0 * f64::from(h));
                let area = along_x.cross(along_y).length();
                ((self.density)((self.sample)(u)) as f64 * area - 1.0).abs() as f32
            })
            .fold(0.0, f32::max)
    }
}
