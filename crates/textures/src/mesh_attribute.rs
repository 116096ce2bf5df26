//! `mesh_attribute`: a quantity stored on a mesh's vertices or faces.
//!
//! Three channels are a linear Rec.709 colour, interpolated as such and then turned into a
//! spectrum; one channel is a number, the same at all wavelengths. (Mitsuba interpolates the
//! coefficients of the spectra instead; the two agree on the vertices and wherever neighbours
//! agree.)

use crate::recovered::luminance;
use etalon_spectrum::RgbCoefficients;
use etalon_transport::{Shapes, TexturePoint};
use glam::{Vec3, Vec4};

/// A named attribute, scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshAttribute {
    /// `vertex_…` or `face_…`.
    pub name: String,
    /// A factor.
    pub scale: f32,
}

impl MeshAttribute {
    /// The interpolated channels; black away from shapes and where the shape has no such
    /// attribute, which the scene rules out when it is compiled (see
    /// [`crate::TextureSet::attributes`]).
    #[inline]
    fn stored(&self, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        if !at.shape.is_some() {
            return Vec3::ZERO;
        }
        shapes
            .attribute(at.shape, &self.name, at.primitive, at.parameters)
            .unwrap_or(Vec3::ZERO)
    }

    /// The spectrum.
    #[inline]
    pub fn spectrum(&self, shapes: &impl Shapes, at: &TexturePoint, lambda: Vec4) -> Vec4 {
        let value = self.stored(shapes, at);
        let unscaled = if value.x == value.y && value.y == value.z {
            Vec4::splat(value.x)
        } else {
            RgbCoefficients::from_rgb(value.to_array()).eval(lambda)
        };
        unscaled * self.scale
    }

    /// The number: the luminance of a colour.
    #[inline]
    pub fn number(&self, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        let value = self.stored(shapes, at);
        if value.x == value.y && value.y == value.z {
            return value.x * self.scale;
        }
        luminance(value) * self.scale
    }

    /// The raw channels.
    #[inline]
    pub fn colour(&self, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        self.stored(shapes, at) * self.scale
    }
}
