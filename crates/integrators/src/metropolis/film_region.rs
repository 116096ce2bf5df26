//! The part of the film plane on which Markov chains move.

use etalon_transport::{Pass, PixelSample};
use glam::{UVec2, Vec2};

/// The part of the film plane on which primary samples choose a place: the film and what lies
/// beyond its border but still matters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FilmRegion {
    origin: UVec2,
    size: UVec2,
    margin: u32,
}

impl FilmRegion {
    pub(crate) fn of(pass: &Pass) -> Self {
        Self {
            origin: pass.origin,
            size: pass.size + 2 * pass.margin,
            margin: pass.margin,
        }
    }

    /// The first pixel of the film.
    pub(crate) fn origin(&self) -> UVec2 {
        self.origin
    }

    /// Size of the film (pixels).
    pub(crate) fn pixels(&self) -> UVec2 {
        self.size - 2 * self.margin
    }

    /// Its upper left corner.
    pub(crate) fn low(&self) -> Vec2 {
        self.origin.as_vec2() - self.margin as f32
    }

    /// Its size.
    pub(crate) fn size(&self) -> UVec2 {
        self.size
    }

    /// Its area (pixels²).
    pub(crate) fn area(&self) -> f32 {
        self.size.x as f32 * self.size.y as f32
    }

    /// The site of a sample at the place that `u` chooses. One sample covers the whole field.
    pub(crate) fn site(&self, u: Vec2) -> PixelSample {
        PixelSample {
            pixel: UVec2::ZERO,
            raster: self.low() + u * self.size.as_vec2(),
            margin: self.margin as f32,
            pixels: self.size.x * self.size.y,
            spacing: 1.0,
            sample: 0,
        }
    }
}
