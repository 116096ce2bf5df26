//! What a material asks textures where it is resolved.

use core::fmt;
use etalon_spectrum::Wavelengths;
use etalon_transport::{SurfaceInteraction, TextureId, TexturePoint, Textures};
use glam::{Vec2, Vec4};

/// Where textures are asked.
#[derive(Clone, Copy)]
pub(crate) enum Place<'t> {
    /// At a vertex.
    Vertex(&'t SurfaceInteraction),
    /// At a point that is found when it is needed: the one of a lane.
    Lane(&'t dyn Fn(usize) -> TexturePoint, usize),
}

impl fmt::Debug for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(vertex) => f.debug_tuple("Vertex").field(vertex).finish(),
            Self::Lane(_, lane) => f.debug_tuple("Lane").field(lane).finish_non_exhaustive(),
        }
    }
}

/// A point, the textures of the scene, and wavelengths.
#[derive(Debug)]
pub struct TextureSite<'t, T> {
    /// The textures of the scene.
    pub textures: &'t T,
    place: Place<'t>,
    /// The wavelengths (nm).
    pub lambda: Vec4,
}

impl<T> Clone for TextureSite<'_, T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for TextureSite<'_, T> {}

impl<'t, T: Textures> TextureSite<'t, T> {
    #[inline]
    pub(crate) fn new(textures: &'t T, place: Place<'t>, wavelengths: &Wavelengths) -> Self {
        Self {
            textures,
            place,
            lambda: wavelengths.lambda,
        }
    }

    /// The point, for textures.
    #[inline]
    pub fn at(&self) -> TexturePoint {
        match self.place {
            Place::Vertex(vertex) => TexturePoint::from(vertex),
            Place::Lane(point, lane) => point(lane),
        }
    }

    /// The same for one texture: any point where that does not matter.
    #[inline]
    fn at_for(&self, texture: TextureId) -> TexturePoint {
        match self.textures.is_constant(texture) {
            true => TexturePoint::at_uv(Vec2::ZERO),
            false => self.at(),
        }
    }

    /// A spectrum here.
    #[inline]
    pub fn spectrum(&self, texture: TextureId) -> Vec4 {
        let at = self.at_for(texture);
        self.textures.spectrum(texture, &at, self.lambda)
    }

    /// A number here.
    #[inline]
    pub fn number(&self, texture: TextureId) -> f32 {
        self.textures.number(texture, &self.at_for(texture))
    }

    /// A number here that is a share of the light: brought into [0, 1], as bitmaps may exceed it.
    #[inline]
    pub fn share(&self, texture: TextureId) -> f32 {
        self.number(texture).clamp(0.0, 1.0)
    }
}
