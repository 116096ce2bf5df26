//! A mixture of two materials:
//!
//! ```text
//! f(wo, wi) = (1 − w) · f₀(wo, wi) + w · f₁(wo, wi)
//! ```
//!
//! Mitsuba's plugin of that name. The nested materials are chosen with the probabilities 1 − w
//! and w.

use crate::{LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "blendbsdf weight=f:0.3 ( diffuse reflectance=u:0.8 ) ( roughconductor alpha=f:0.3 )",
    "blendbsdf weight=f:0.6 ( mask opacity=f:0.5 ( plastic ) ) ( blendbsdf weight=f:0.5 \
     ( roughdielectric alpha=f:0.4 int_ior=s:cauchy:1.4,0.05 ) ( diffuse ) )",
];

/// `blendbsdf` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    weight: TextureId,
    nested: Box<[Material; 2]>,
}

impl Description {
    /// Reads `weight` (required) and two nested materials.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let weight = build.texture(params, "weight", None, SpectrumKind::Reflectance);
        let nested = Material::nested::<2>(params, build)?;
        Some(Self {
            weight,
            nested: Box::new(nested),
        })
    }

    /// The union of both materials' flags.
    pub fn traits(&self) -> MaterialFlags {
        self.nested[0].traits().with(self.nested[1].traits())
    }

    /// Both nested materials with their shares.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        let share = site.share(self.weight);
        self.nested[0].flatten(site, frame, weight * (1.0 - share), into);
        self.nested[1].flatten(site, frame, weight * share, into);
    }
}
