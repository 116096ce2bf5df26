//! `checkerboard`: two textures in alternate squares of side ½.
//!
//! With (u, v) after `to_uv`, colour 0 fills the squares in which u − ⌊u⌋ > ½ and v − ⌊v⌋ > ½
//! agree. Evaluated as a *number* (opacity, roughness), Mitsuba 3.9.1 exchanges the two colours;
//! this does the same, as scenes rely on it.

use crate::UvTransform;
use crate::reader::Use;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use etalon_params::Params;
use etalon_transport::TextureId;
use etalon_transport::{Shapes, TexturePoint};
use glam::Vec2;
use glam::{Vec3, Vec4};

/// Two textures in squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// `color0` and `color1`.
    pub colours: [TextureId; 2],
    /// `to_uv`.
    pub to_uv: UvTransform,
}

impl Checkerboard {
    /// 0 or 1: the texture at `uv` for spectra and colours.
    #[inline]
    fn square(&self, uv: Vec2) -> usize {
        let uv = self.to_uv.apply(uv);
        let upper = (uv - uv.floor()).cmpgt(Vec2::splat(0.5));
        usize::from(upper.x != upper.y)
    }

    /// The texture that gives the spectrum at `uv`.
    #[inline]
    pub fn for_spectrum(&self, uv: Vec2) -> TextureId {
        self.colours[self.square(uv)]
    }

    /// The texture that gives the number at `uv`.
    #[inline]
    pub fn for_number(&self, uv: Vec2) -> TextureId {
        self.colours[1 - self.square(uv)]
    }
}

impl TextureModel for Checkerboard {
    const VARIES: bool = true;

    #[inline]
    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        set.spectrum(self.for_spectrum(at.uv), shapes, at, lambda)
    }

    #[inline]
    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        set.number(self.for_number(at.uv), shapes, at)
    }

    #[inline]
    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        set.colour(self.for_spectrum(at.uv), shapes, at)
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        let [a, b] = self.colours;
        0.5 * (set.mean(a) + set.mean(b))
    }

    fn is_constant(&self, _: &TextureTable) -> bool {
        self.colours[0] == self.colours[1]
    }

    fn nested(&self) -> &[TextureId] {
        &self.colours
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        Some("`bricks` with `space` = `world` has a pattern in space")
    }
}

pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let nested = Use { role, nested: true };
    Some(Texture::from(Checkerboard {
        colours: [
            reader.parameter_in(params, "color0", Some(0.4), nested),
            reader.parameter_in(params, "color1", Some(0.2), nested),
        ],
        to_uv: UvTransform::from_params(params),
    }))
}
