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
use etalon_math::float64::tan;
use etalon_params::Params;
use glam::{DVec2, Vec2};

/// 36 mm × 24 mm film, whose diagonal the focal length refers to.
const FULL_FRAME_DIAGONAL_MM: f64 = 43.266_615_305_567_875;

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

    /// The point of the plane seen at `raster`.
    #[inline]
    pub fn point(&self, raster: Vec2) -> Vec2 {
        self.corner - raster * self.pixel
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

/// Reads `fov` with `fov_axis`, or `focal_length`: tan(φ/2) of the horizontal field of view φ.
pub fn half_width_from_params(params: &Params<'_>, aspect: f64) -> f64 {
    let fov = params.float("fov");
    let focal_length = params.property("focal_length").is_some();
    if fov.is_some() && focal_length {
        params.error_at(
            "focal_length",
            "give either `fov` or `focal_length`, not both",
        );
    }
    // tan(φ/2) of the diagonal spreads over the sides in proportion to their lengths.
    let of_diagonal = |half_diagonal: f64| half_diagonal / (1.0 + 1.0 / (aspect * aspect)).sqrt();
    if params.has("fov") {
        let axis = params.choice(
            "fov_axis",
            "x",
            &["x", "y", "diagonal", "smaller", "larger"],
        );
        let degrees = match fov {
            Some(degrees) if degrees > 0.0 && degrees < 180.0 => degrees,
            Some(degrees) => {
                params.refuse("fov", degrees, "degrees above 0 and below 180");
                90.0
            }
            None => 90.0,
        };
        let half = tan(degrees.to_radians() / 2.0);
        match (axis, aspect > 1.0) {
            ("diagonal", _) => of_diagonal(half),
            ("y", _) | ("smaller", true) | ("larger", false) => half * aspect,
            _ => half,
        }
    } else {
        if params.has("fov_axis") {
            params.property("fov_axis");
            params.error_at("fov_axis", "`fov_axis` says nothing without `fov`");
        }
        of_diagonal(FULL_FRAME_DIAGONAL_MM / (2.0 * focal_length_from_params(params)))
    }
}

/// Reads `focal_length`: millimetres, as in `50mm`.
fn focal_length_from_params(params: &Params<'_>) -> f64 {
    const DEFAULT_MM: f64 = 50.0;
    let Some(text) = params.string("focal_length") else {
        return DEFAULT_MM;
    };
    let number = text.strip_suffix("mm").unwrap_or(text).trim();
    match number.parse::<f64>() {
        Ok(length) if length > 0.0 && length.is_finite() => length,
        _ => {
            params.refuse(
                "focal_length",
                format!("`{text}`"),
                "a positive number of millimetres such as `50mm`",
            );
            DEFAULT_MM
        }
    }
}
