//! The contract of textures.

use crate::{ShapeId, SurfaceInteraction, TextureId};
use etalon_math::lane::Lane;
use glam::{Vec2, Vec3, Vec4};

/// The point for texture look-up.
#[derive(Clone, Copy, Debug)]
pub struct TexturePoint {
    /// Position in the world (m).
    pub position: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Shape, for mesh attributes.
    pub shape: ShapeId,
    /// Primitive of the shape.
    pub primitive: u32,
    /// Parameters on the primitive.
    pub parameters: Vec2,
}

impl TexturePoint {
    /// A point that has texture coordinates only.
    pub fn at_uv(uv: Vec2) -> Self {
        Self {
            position: Vec3::ZERO,
            uv,
            shape: ShapeId::NONE,
            primitive: 0,
            parameters: Vec2::ZERO,
        }
    }
}

impl TexturePoint {
    /// A point of space, on no surface.
    #[inline]
    pub fn in_space(position: Vec3) -> Self {
        Self {
            position,
            ..Self::at_uv(Vec2::ZERO)
        }
    }
}

impl From<&SurfaceInteraction> for TexturePoint {
    #[inline]
    fn from(vertex: &SurfaceInteraction) -> Self {
        Self {
            position: vertex.position,
            uv: vertex.uv,
            shape: vertex.shape,
            primitive: vertex.primitive,
            parameters: vertex.parameters,
        }
    }
}

/// Lookup of textures and spectra.
pub trait Textures {
    /// The spectrum at a point, for the four wavelengths `lambda` (nm).
    fn spectrum(&self, texture: TextureId, at: &TexturePoint, lambda: Vec4) -> Vec4;

    /// That of `texture(i)` at `at(i)`, for the wavelengths `lambda(i)`, in lane i.
    fn spectra<F: Lane>(
        &self,
        texture: impl Fn(usize) -> TextureId,
        at: impl Fn(usize) -> TexturePoint,
        lambda: impl Fn(usize) -> Vec4,
    ) -> F::Spectrum;

    /// A number at a point (roughness, opacity, blend weight): the luminance of colours.
    fn number(&self, texture: TextureId, at: &TexturePoint) -> f32;

    /// (∂/∂u, ∂/∂v) of [`Textures::number`], where `moved` is ∂p/∂u and ∂p/∂v; by default from differences over a
    /// thousandth of the square.
    fn gradient(&self, texture: TextureId, at: &TexturePoint, moved: [Vec3; 2]) -> Vec2 {
        gradient_by_differences(at, moved, |at| self.number(texture, at))
    }

    /// Three raw channels at a point (normal maps, emission tables).
    fn colour(&self, texture: TextureId, at: &TexturePoint) -> Vec3;

    /// The mean over the texture, for choosing among lobes and lights.
    fn mean(&self, texture: TextureId) -> f32;

    /// Whether the texture is the same everywhere.
    fn is_constant(&self, texture: TextureId) -> bool;
}

/// (∂/∂u, ∂/∂v) of a number at a point, from central differences.
pub fn gradient_by_differences(
    at: &TexturePoint,
    [du, dv]: [Vec3; 2],
    number: impl Fn(&TexturePoint) -> f32,
) -> Vec2 {
    const STEP: f32 = 1.0 / 2048.0;
    let at_uv = |offset: Vec2| {
        number(&TexturePoint {
            position: at.position + du * offset.x + dv * offset.y,
            uv: at.uv + offset,
            ..*at
        })
    };
    let along = |axis: Vec2| (at_uv(axis * STEP) - at_uv(-axis * STEP)) / (2.0 * STEP);
    Vec2::new(along(Vec2::X), along(Vec2::Y))
}
