//! `spherical`: a camera that sees all directions.
//!
//! - `equirectangular`: latitude and longitude, as an `envmap` has them: the centre of the picture is forward, its upper edge up.
//!   With θ the angle from up and a film of w × h pixels, J = w h / (2π² sin θ).
//! - `equalarea`: Clarberg's square (see [`equal_area`]) as pbrt-v4 has it: the centre is up, the lower edge's middle
//!   forward, the right edge's middle to the right, the corners down. J = w h / 4π everywhere.
//!
//! Both go on beyond the edges of the film, where a wide filter looks: a direction near an edge is also seen opposite, and near the poles
//! of the former half a turn aside. A connection chooses among these raster positions uniformly.

use crate::FilmWindow;
use crate::panoramic::Projection;
use core::f32::consts::PI;
use etalon_math::equal_area;
use etalon_params::Params;
use etalon_sampling::latitude_longitude;
use glam::{Vec2, Vec3};

/// How the sphere is spread over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mapping {
    EquiRectangular,
    EqualArea,
}

/// All directions on a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spherical {
    mapping: Mapping,
    window: FilmWindow,
}

impl Spherical {
    /// Reads `mapping`.
    pub fn from_params(params: &Params<'_>, window: FilmWindow) -> Self {
        let names = ["equirectangular", "equalarea"];
        let mapping = match params.choice("mapping", "equirectangular", &names) {
            "equalarea" => Mapping::EqualArea,
            _ => Mapping::EquiRectangular,
        };
        Self { mapping, window }
    }

    /// The places in and around the unit square that see a unit direction, the one in the square first; and solid angle per unit
    /// area of the square (sr).
    fn places(&self, direction: Vec3) -> ([Vec2; 9], f32) {
        match self.mapping {
            Mapping::EqualArea => {
                let Vec3 { x, y, z } = direction;
                let place = Vec2::from(equal_area::to_square::<f32>(Vec3::new(-x, z, y)));
                (equal_area::copies(place), 4.0 * PI)
            }
            Mapping::EquiRectangular => {
                let [u, v] = latitude_longitude::to_square::<f32>(direction);
                let sin = Vec2::new(direction.x, direction.z).length();
                let at = Vec2::new;
                // Half a turn aside, from 0 to 1.
                let turned = if u < 0.5 { u + 0.5 } else { u - 0.5 };
                let copies = [
                    at(u, v),
                    at(u - 1.0, v),
                    at(u + 1.0, v),
                    at(turned, -v),
                    at(turned - 1.0, -v),
                    at(turned + 1.0, -v),
                    at(turned, 2.0 - v),
                    at(turned - 1.0, 2.0 - v),
                    at(turned + 1.0, 2.0 - v),
                ];
                (copies, latitude_longitude::stretch(sin))
            }
        }
    }
}

impl Projection for Spherical {
    const REPEATS: bool = true;

    #[inline]
    fn direction(&self, raster: Vec2) -> Option<Vec3> {
        let place = raster / self.window.size.as_vec2();
        Some(match self.mapping {
            Mapping::EqualArea => {
                let Vec3 { x, y, z } =
                    equal_area::to_direction::<f32>(equal_area::wrapped(place).to_array());
                Vec3::new(-x, z, y)
            }
            Mapping::EquiRectangular => latitude_longitude::to_direction::<f32>(place.to_array()).0,
        })
    }

    #[inline]
    fn raster(&self, direction: Vec3, choice: f32, margin: f32) -> Option<(Vec2, f32)> {
        let size = self.window.size.as_vec2();
        let (places, angle) = self.places(direction);
        let rasters = places.map(|place| place * size);
        let is_seen = |raster: &&Vec2| self.window.contains(**raster, margin);
        let count = rasters.iter().filter(is_seen).count();
        let chosen = ((choice * count as f32) as usize).min(count.saturating_sub(1));
        let raster = *rasters.iter().filter(is_seen).nth(chosen)?;
        let per_angle = size.x * size.y / angle;
        per_angle
            .is_finite()
            .then_some((raster, per_angle * count as f32))
    }
}
