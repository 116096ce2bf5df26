//! `mesh_attribute`: a quantity stored on a mesh's vertices or faces.
//!
//! Three channels are a linear Rec.709 colour, interpolated as such and then turned into a
//! spectrum; one channel is a number, the same at all wavelengths. (Mitsuba interpolates the
//! coefficients of the spectra instead; the two agree on the vertices and wherever neighbours
//! agree.)
//!
//! Stored numbers that the texture's role rules out count as the nearest that it allows: a
//! reflectance, times `scale`, lies in [0, 1], nothing else is below 0.

use crate::reader::Use;
use crate::recovered::{luminance, spectrum_of};
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use etalon_params::Params;
use etalon_transport::{Shapes, SpectrumKind, TexturePoint};
use glam::{Vec3, Vec4};

/// A named attribute, scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshAttribute {
    /// `vertex_…` or `face_…`.
    pub name: String,
    /// A factor, not below 0.
    pub scale: f32,
    /// The role of the quantity.
    pub role: SpectrumKind,
}

impl MeshAttribute {
    /// The range to which a stored number is clamped before scaling.
    #[inline]
    pub fn range(&self) -> [f32; 2] {
        match self.role {
            SpectrumKind::Reflectance => [0.0, (1.0 / self.scale).min(f32::MAX)],
            SpectrumKind::Emission
            | SpectrumKind::Unbounded
            | SpectrumKind::Index
            | SpectrumKind::Raw(_) => [0.0, f32::MAX],
        }
    }

    /// The interpolated channels; black away from shapes and where the shape has no such
    /// attribute, which the scene rules out when it is compiled (see
    /// [`crate::TextureTable::attributes`]).
    #[inline]
    fn stored(&self, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        if !at.shape.is_some() {
            return Vec3::ZERO;
        }
        let (primitive, parameters) = (at.primitive, at.parameters);
        shapes
            .attribute(at.shape, &self.name, primitive, parameters, self.range())
            .unwrap_or(Vec3::ZERO)
    }

    /// The spectrum.
    #[inline]
    pub fn spectrum(&self, shapes: &impl Shapes, at: &TexturePoint, lambda: Vec4) -> Vec4 {
        spectrum_of(self.stored(shapes, at), self.scale, self.role, lambda)
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

impl TextureModel for MeshAttribute {
    const VARIES: bool = true;

    #[inline]
    fn spectrum(
        &self,
        _: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        Self::spectrum(self, shapes, at, lambda)
    }

    #[inline]
    fn number(&self, _: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        Self::number(self, shapes, at)
    }

    #[inline]
    fn colour(&self, _: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        Self::colour(self, shapes, at)
    }

    fn mean(&self, _: &TextureTable) -> f32 {
        0.5 * self.scale
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        Some("a `gridvolume` has values in space")
    }
}

pub(crate) fn read(
    _: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let scale = params.float_where("scale", 1.0, "a finite number not below 0", |x| {
        x >= 0.0 && x.is_finite()
    }) as f32;
    let Some(name) = params.string("name") else {
        if !params.has("name") {
            params.missing("name", "`vertex_…` or `face_…`");
        }
        return None;
    };
    if !name.starts_with("vertex_") && !name.starts_with("face_") {
        params.refuse("name", format!("`{name}`"), "`vertex_…` or `face_…`");
        return None;
    }
    Some(Texture::from(MeshAttribute {
        name: name.to_owned(),
        scale,
        role,
    }))
}
