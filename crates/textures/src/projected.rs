//! `projected`: another texture by coordinates that follow from the place, as slides and labels are put on things.
//!
//! ```text
//! planar        (u, v) = (x, y)
//! cylindrical   (u, v) = (φ/2π, z)          φ = atan2(y, x) from 0 to 2π
//! spherical     (u, v) = (φ/2π, θ/π)        θ: the angle from +z
//! ```
//!
//! (x, y, z) is the place in the world, taken back by `to_world`.

use crate::place;
use crate::reader::Use;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use core::f64::consts::{PI, TAU};
use etalon_math::float64::atan2;
use etalon_params::{Class, Params};
use etalon_transport::{Shapes, TextureId, TexturePoint};
use glam::{DAffine3, DVec2, Vec2, Vec3, Vec4};

/// The form of what the texture is put on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mapping {
    Planar,
    Cylindrical,
    Spherical,
}

/// A texture by other coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Projected {
    mapping: Mapping,
    /// From the world to (x, y, z).
    place: DAffine3,
    inner: TextureId,
}

impl Projected {
    /// (u, v) at a place in the world.
    pub fn coordinates(&self, position: Vec3) -> Vec2 {
        let p = self.place.transform_point3(position.as_dvec3());
        let around = || atan2(p.y, p.x).rem_euclid(TAU) / TAU;
        let uv = match self.mapping {
            Mapping::Planar => p.truncate(),
            Mapping::Cylindrical => DVec2::new(around(), p.z),
            Mapping::Spherical => DVec2::new(around(), atan2(p.truncate().length(), p.z) / PI),
        };
        uv.as_vec2()
    }

    fn point(&self, at: &TexturePoint) -> TexturePoint {
        let uv = self.coordinates(at.position);
        TexturePoint { uv, ..*at }
    }
}

impl TextureModel for Projected {
    const VARIES: bool = true;

    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        set.spectrum(self.inner, shapes, &self.point(at), lambda)
    }

    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        set.number(self.inner, shapes, &self.point(at))
    }

    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        set.colour(self.inner, shapes, &self.point(at))
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        set.mean(self.inner)
    }

    fn is_constant(&self, set: &TextureTable) -> bool {
        set.is_constant(self.inner)
    }

    fn nested(&self) -> &[TextureId] {
        std::slice::from_ref(&self.inner)
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        Some("patterns with `space` = `world` and a `gridvolume` have values in space")
    }
}

/// Reads `mapping` (`planar`, `cylindrical`, `spherical`), `to_world` and the nested texture.
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let mapping = match params.choice("mapping", "planar", &["planar", "cylindrical", "spherical"])
    {
        "cylindrical" => Mapping::Cylindrical,
        "spherical" => Mapping::Spherical,
        _ => Mapping::Planar,
    };
    let place = place::from_world(params);
    let children = params.children(Class::Texture);
    let [(property, _)] = children.as_slice() else {
        let message = format!("`projected` has one nested texture, not {}", children.len());
        params.error(message);
        return None;
    };
    let inner = reader.value(property, Use { role, nested: true });
    Some(Texture::from(Projected {
        mapping,
        place: place?,
        inner,
    }))
}
