//! How often chains visit each part of the picture.
//!
//! Chains that follow brightness alone crowd in bright parts and leave dark ones noisy. So the
//! brightness of a contribution is divided by that of its neighbourhood, as estimated by the pilot:
//! every part of the film is then visited about equally often, and has about the same *relative*
//! error (the two stages of Veach 1997, section 11.5.2). The estimate is unbiased for any positive
//! factors.

use super::film_region::FilmRegion;
use glam::{UVec2, Vec2};

/// Most cells along a side of the film.
const CELLS: u32 = 16;

/// The share of the picture's mean brightness that is added to every neighbourhood's: nothing is
/// visited more than ten times as often as by its brightness.
const FLOOR: f64 = 0.1;

/// Factors over the film, constant in cells.
#[derive(Clone, Debug)]
pub(super) struct ImportanceMap {
    cells: UVec2,
    factors: Vec<f32>,
}

impl ImportanceMap {
    /// No part of the film before another.
    pub(super) fn none() -> Self {
        Self {
            cells: UVec2::ONE,
            factors: vec![1.0],
        }
    }

    /// Factors from the places and brightnesses of these contributions.
    pub(super) fn of(field: &FilmRegion, found: impl Iterator<Item = (Vec2, f64)>) -> Self {
        let cells = (field.size() / 4).clamp(UVec2::ONE, UVec2::splat(CELLS));
        let mut sums = vec![0.0; (cells.x * cells.y) as usize];
        for (raster, brightness) in found {
            sums[cell(field, cells, raster)] += brightness;
        }
        let mean = sums.iter().sum::<f64>() / sums.len() as f64;
        let factors = (0..cells.y)
            .flat_map(|y| (0..cells.x).map(move |x| UVec2::new(x, y)))
            .map(|at| {
                let around = around(cells, at);
                let count = around.clone().count() as f64;
                let here = around.map(|i| sums[i]).sum::<f64>() / count;
                if mean > 0.0 {
                    (mean / (here + FLOOR * mean)) as f32
                } else {
                    1.0
                }
            })
            .collect();
        Self { cells, factors }
    }

    /// The factor at a place.
    #[inline]
    pub(super) fn at(&self, field: &FilmRegion, raster: Vec2) -> f32 {
        self.factors[cell(field, self.cells, raster)]
    }
}

/// The cell of a place. Places beyond the field count as at its border.
#[inline]
fn cell(field: &FilmRegion, cells: UVec2, raster: Vec2) -> usize {
    let place = (raster - field.low()) / field.size().as_vec2() * cells.as_vec2();
    let place = place.max(Vec2::ZERO).as_uvec2().min(cells - 1);
    (place.y * cells.x + place.x) as usize
}

/// A cell and its neighbours.
fn around(cells: UVec2, at: UVec2) -> impl Iterator<Item = usize> + Clone {
    let low = at.saturating_sub(UVec2::ONE);
    let high = (at + 1).min(cells - 1);
    (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| (y * cells.x + x) as usize))
}
