//! `extinction`: the extinction coefficient k of a conductor whose η is 1, from its reflectance r at normal incidence.
//!
//! ```text
//! k = 2 √r / √(1 − r)          r = ((η − 1)² + k²) / ((η + 1)² + k²) = k² / (4 + k²)
//! ```
//!
//! r counts as 0.9999 at most (M. Pharr, W. Jakob, G. Humphreys 2023, *Physically Based Rendering*, 9.4).

use crate::reader::Use;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use etalon_params::Params;
use etalon_transport::{Shapes, SpectrumKind, TextureId, TexturePoint};
use glam::{Vec3, Vec4};

/// The greatest reflectance that has a finite k here.
const MOST: f32 = 0.9999;

/// k of a reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extinction {
    reflectance: TextureId,
}

fn extinction(reflectance: f32) -> f32 {
    let r = reflectance.clamp(0.0, MOST);
    2.0 * (r / (1.0 - r)).sqrt()
}

impl TextureModel for Extinction {
    const VARIES: bool = false;

    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        let reflectance = set.spectrum(self.reflectance, shapes, at, lambda);
        Vec4::from_array(reflectance.to_array().map(extinction))
    }

    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        extinction(set.number(self.reflectance, shapes, at))
    }

    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        let reflectance = set.colour(self.reflectance, shapes, at);
        Vec3::from_array(reflectance.to_array().map(extinction))
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        extinction(set.mean(self.reflectance))
    }

    fn is_constant(&self, set: &TextureTable) -> bool {
        set.is_constant(self.reflectance)
    }

    fn nested(&self) -> &[TextureId] {
        std::slice::from_ref(&self.reflectance)
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        None
    }
}

/// Reads `reflectance`.
pub(crate) fn read(reader: &mut TextureReader<'_>, params: &Params<'_>, _: Use) -> Option<Texture> {
    let share = Use {
        role: SpectrumKind::Reflectance,
        nested: true,
    };
    let reflectance = reader.parameter_in(params, "reflectance", None, share);
    Some(Texture::from(Extinction { reflectance }))
}
