//! `fisheye`: a camera that sees a cone of directions, however wide, in a disk.
//!
//! A direction at the angle θ from the axis is seen at the distance r from the film's centre, with J = r (dr/dθ) / sin θ:
//!
//! ```text
//! equidistant    r = f θ               J = f² θ / sin θ
//! equisolid      r = 2 f sin(θ/2)      J = f²
//! stereographic  r = 2 f tan(θ/2)      J = f² / cos⁴(θ/2)
//! orthographic   r = f sin θ           J = f² cos θ
//! ```
//!
//! (Miyamoto 1964, "Fish Eye Lens", JOSA 54(8), for their names and uses). f (px) is such that θ = φ/2 is seen at the edge of the film, on
//! the axis that the field of view φ belongs to. What is outside of the disk is black.

use crate::FilmWindow;
use crate::panoramic::Projection;
use etalon_math::{float, float64};
use etalon_params::Params;
use glam::{Vec2, Vec3};

/// How distances on the film and angles from the axis correspond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mapping {
    Equidistant,
    EquiSolid,
    Stereographic,
    Orthographic,
}

impl Mapping {
    const NAMES: [&str; 4] = ["equidistant", "equisolid", "stereographic", "orthographic"];

    fn named(name: &str) -> Self {
        match name {
            "equisolid" => Self::EquiSolid,
            "stereographic" => Self::Stereographic,
            "orthographic" => Self::Orthographic,
            _ => Self::Equidistant,
        }
    }

    /// The widest field of view (degrees), and what is accepted in words.
    fn widest(self) -> (f64, &'static str) {
        match self {
            Self::Equidistant | Self::EquiSolid => (360.0, "degrees above 0, at most 360"),
            Self::Stereographic => (350.0, "degrees above 0, at most 350"),
            Self::Orthographic => (180.0, "degrees above 0, at most 180"),
        }
    }

    /// r/f at the angle θ.
    fn distance(self, theta: f64) -> f64 {
        match self {
            Self::Equidistant => theta,
            Self::EquiSolid => 2.0 * float64::sin(0.5 * theta),
            Self::Stereographic => 2.0 * float64::tan(0.5 * theta),
            Self::Orthographic => float64::sin(theta),
        }
    }
}

/// A cone of directions on a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fisheye {
    mapping: Mapping,
    window: FilmWindow,
    centre: Vec2,
    /// f (px).
    focal: f32,
    /// r at the edge (px).
    edge: f32,
}

impl Fisheye {
    /// Reads `fov`, `fov_axis` and `mapping`.
    pub fn from_params(params: &Params<'_>, window: FilmWindow) -> Self {
        let mapping = Mapping::named(params.choice("mapping", "equidistant", &Mapping::NAMES));
        let (widest, what) = mapping.widest();
        let fov = params.float_where("fov", 180.0, what, |fov| fov > 0.0 && fov <= widest);
        let axes = ["x", "y", "diagonal", "smaller", "larger"];
        let size = window.size.as_dvec2();
        let across = match params.choice("fov_axis", "smaller", &axes) {
            "x" => size.x,
            "y" => size.y,
            "diagonal" => size.length(),
            "larger" => size.max_element(),
            _ => size.min_element(),
        };
        let edge = 0.5 * across;
        let focal = edge / mapping.distance(0.5 * fov.to_radians());
        Self {
            mapping,
            window,
            centre: window.size.as_vec2() * 0.5,
            focal: focal as f32,
            edge: edge as f32,
        }
    }
}

impl Projection for Fisheye {
    const REPEATS: bool = false;

    #[inline]
    fn direction(&self, raster: Vec2) -> Option<Vec3> {
        // +X is to the left, +Y up.
        let from_centre = self.centre - raster;
        let r = from_centre.length();
        if !(r <= self.edge) {
            return None;
        }
        let part = r / self.focal;
        let (sin, cos) = match self.mapping {
            Mapping::Equidistant => float::sin_cos(part),
            Mapping::EquiSolid => {
                let squared = 0.25 * part * part;
                (part * (1.0 - squared).max(0.0).sqrt(), 1.0 - 2.0 * squared)
            }
            Mapping::Stereographic => {
                let squared = 0.25 * part * part;
                (part / (1.0 + squared), (1.0 - squared) / (1.0 + squared))
            }
            Mapping::Orthographic => {
                let sin = part.min(1.0);
                (sin, (1.0 - sin * sin).sqrt())
            }
        };
        let outward = if r > 0.0 { from_centre / r } else { Vec2::ZERO };
        Some((outward * sin).extend(cos))
    }

    #[inline]
    fn raster(&self, direction: Vec3, _: f32, margin: f32) -> Option<(Vec2, f32)> {
        let across = direction.truncate();
        let (sin, cos) = (across.length(), direction.z);
        // cos²(θ/2); the other half of the sphere by its sine, where 1 + cos θ cancels.
        let half_cos_squared = match cos > 0.0 {
            true => 0.5 * (1.0 + cos),
            false => 0.5 * sin * sin / (1.0 - cos),
        };
        // r/(f sin θ), and J/f².
        let (stretch, per_angle) = match self.mapping {
            Mapping::Equidistant => {
                let theta = float::atan2(sin, cos);
                let stretch = if sin > 0.0 { theta / sin } else { 1.0 };
                (stretch, stretch)
            }
            Mapping::EquiSolid => (1.0 / half_cos_squared.sqrt(), 1.0),
            Mapping::Stereographic => (
                1.0 / half_cos_squared,
                1.0 / (half_cos_squared * half_cos_squared),
            ),
            Mapping::Orthographic => (1.0, cos),
        };
        let from_centre = across * (stretch * self.focal);
        let raster = self.centre - from_centre;
        let seen = from_centre.length() <= self.edge
            && per_angle > 0.0
            && per_angle.is_finite()
            && self.window.contains(raster, margin);
        seen.then_some((raster, per_angle * self.focal * self.focal))
    }
}
