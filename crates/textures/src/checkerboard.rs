//! `checkerboard`: two textures in alternate squares of side ½.
//!
//! With (u, v) after `to_uv`, colour 0 fills the squares in which u − ⌊u⌋ > ½ and v − ⌊v⌋ > ½
//! agree. Where a *number* is asked for (opacity, roughness), Mitsuba 3.9.1 exchanges the two;
//! scenes made for it rely on the picture it gives, so this does the same.

use crate::UvTransform;
use etalon_transport::TextureId;
use glam::Vec2;

/// Two textures in squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// `color0` and `color1`.
    pub colours: [TextureId; 2],
    /// `to_uv`.
    pub to_uv: UvTransform,
}

impl Checkerboard {
    /// 0 or 1: the texture seen at `uv` when a spectrum or colour is asked for.
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
