//! The list of textures, and how each answers.

use crate::{Bitmap, Checkerboard, Constant, Illuminated, MeshAttribute, TextureSet};
use etalon_transport::{Shapes, TexturePoint};
use glam::{Vec3, Vec4};

/// Any texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// The same everywhere.
    Constant(Constant),
    /// An image.
    Bitmap(Bitmap),
    /// Two textures in squares.
    Checkerboard(Checkerboard),
    /// A quantity stored on a mesh.
    MeshAttribute(MeshAttribute),
    /// Another texture times D65.
    Illuminated(Illuminated),
}

impl Texture {
    /// The spectrum at a point, for the wavelengths `lambda` (nm). `set` holds the textures that
    /// this one refers to.
    #[inline]
    pub fn spectrum(
        &self,
        set: &TextureSet,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        match self {
            Self::Constant(texture) => texture.spectrum.eval(lambda),
            Self::Bitmap(texture) => texture.spectrum(at.uv, lambda),
            Self::Checkerboard(texture) => {
                set.spectrum(texture.for_spectrum(at.uv), shapes, at, lambda)
            }
            Self::MeshAttribute(texture) => texture.spectrum(shapes, at, lambda),
            Self::Illuminated(texture) => {
                set.spectrum(texture.inner, shapes, at, lambda) * texture.factor(lambda)
            }
        }
    }

    /// The number at a point.
    #[inline]
    pub fn number(&self, set: &TextureSet, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        match self {
            Self::Constant(texture) => texture.number,
            Self::Bitmap(texture) => texture.number(at.uv),
            Self::Checkerboard(texture) => set.number(texture.for_number(at.uv), shapes, at),
            Self::MeshAttribute(texture) => texture.number(shapes, at),
            Self::Illuminated(texture) => set.number(texture.inner, shapes, at) * texture.scale,
        }
    }

    /// Three raw channels at a point.
    #[inline]
    pub fn colour(&self, set: &TextureSet, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        match self {
            Self::Constant(texture) => texture.colour,
            Self::Bitmap(texture) => texture.colour(at.uv),
            Self::Checkerboard(texture) => set.colour(texture.for_spectrum(at.uv), shapes, at),
            Self::MeshAttribute(texture) => texture.colour(shapes, at),
            Self::Illuminated(texture) => set.colour(texture.inner, shapes, at) * texture.scale,
        }
    }

    /// The mean over the texture and the wavelengths, for choosing among lobes and lights only:
    /// images are averaged over their texels as if `to_uv` showed all of them alike, and a mesh
    /// attribute, whose values are not known here, counts as ½.
    pub fn mean(&self, set: &TextureSet) -> f32 {
        match self {
            Self::Constant(texture) => texture.mean,
            Self::Bitmap(texture) => texture.image.mean,
            Self::Checkerboard(texture) => {
                let [a, b] = texture.colours;
                0.5 * (set.mean(a) + set.mean(b))
            }
            Self::MeshAttribute(texture) => 0.5 * texture.scale,
            Self::Illuminated(texture) => set.mean(texture.inner) * texture.scale,
        }
    }

    /// Whether the texture is the same everywhere.
    pub fn is_constant(&self, set: &TextureSet) -> bool {
        match self {
            Self::Constant(_) => true,
            Self::Bitmap(texture) => texture.image.size == glam::UVec2::ONE,
            Self::Checkerboard(texture) => texture.colours[0] == texture.colours[1],
            Self::MeshAttribute(_) => false,
            Self::Illuminated(texture) => set.is_constant(texture.inner),
        }
    }
}
