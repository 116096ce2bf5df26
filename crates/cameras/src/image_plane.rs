//! The image plane of a perspective camera: how raster positions and directions correspond.
//!
//! A raster position (x, y) is seen through the point (X, Y, 1) of camera space,
//!
//! ```text
//! X = (1/2 − x/w − oₓ)·2 tan(φ/2)
//! Y = (1/2 − y/h − o_y)·2 tan(φ/2)·h/w
//! ```
//!
//! for a film of w × h pixels, the horizontal field of view φ and the principal point's offset
//! (oₓ, o_y) in parts of the film's width and height. Pixels are square.

use crate::FilmWindow;
use etalon_math::lane::Lane;
use glam::{DVec2, Vec2};

/// The plane z = 1 of camera space, with the film's pixels on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagePlane {
    /// The point seen at raster (0, 0).
    corner: Vec2,
    /// Side of a pixel.
    pixel: f32,
    /// The film.
    pub window: FilmWindow,
}

impl ImagePlane {
    /// The plane for tan(φ/2) = `half_width` and the principal point's offset `offset` (parts of
    /// the film's width and height).
    pub fn new(window: FilmWindow, half_width: f64, offset: DVec2) -> Self {
        let extent = 2.0 * half_width * DVec2::new(1.0, 1.0 / window.aspect());
        Self {
            corner: ((DVec2::splat(0.5) - offset) * extent).as_vec2(),
            pixel: (2.0 * half_width / f64::from(window.size.x)) as f32,
            window,
        }
    }

    /// The points of the plane seen at these raster positions.
    #[inline(always)]
    pub(crate) fn points<F: Lane>(&self, [x, y]: [F; 2]) -> [F; 2] {
        [
            F::splat(self.corner.x) - x * self.pixel,
            F::splat(self.corner.y) - y * self.pixel,
        ]
    }

    /// The raster position that sees a point of the plane.
    #[inline]
    pub fn raster(&self, point: Vec2) -> Vec2 {
        (self.corner - point) / self.pixel
    }

    /// Area of a pixel on the plane.
    #[inline]
    pub fn pixel_area(&self) -> f32 {
        self.pixel * self.pixel
    }
}
