//! A material that is there with some opacity:
//!
//! ```text
//! f(wo, wi) = o · f_nested(wo, wi) + (1 − o) · δ(wi = −wo)
//! ```
//!
//! Mitsuba's plugin of that name. Light passes straight with the probability 1 − o.

use crate::{LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_transport::{Build, LegacyPhong, SpectrumKind, TextureId, Textures};
use glam::Vec4;

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "mask opacity=f:0.3 ( diffuse )",
    "mask opacity=f:0.6 ( thindielectric )",
];

/// `mask` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    opacity: TextureId,
    nested: Box<Material>,
}

impl Description {
    /// Reads `opacity` (0.5) and one nested material.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let opacity = build.texture(params, "opacity", Some(0.5), SpectrumKind::Reflectance);
        let [nested] = Material::nested_or_classic::<1>(params, build)?;
        Some(Self {
            opacity,
            nested: Box::new(nested),
        })
    }

    /// The flags of the nested material, plus the null interaction.
    pub fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            null: true,
            transmission: true,
            ..self.nested.traits()
        }
    }

    /// The nested material.
    pub fn nested(&self) -> &Material {
        &self.nested
    }

    /// A classic Phong material that is there with the opacity o.
    pub fn classic<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
    ) -> Option<LegacyPhong> {
        let nested = self.nested.classic(site, frame)?;
        Some(LegacyPhong {
            opacity: nested.opacity * site.share(self.opacity),
            ..nested
        })
    }

    /// Passing light, and the nested material with the share o.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        let opacity = site.share(self.opacity);
        let passing = weight * (1.0 - opacity);
        into.pass(Vec4::splat(passing), passing);
        self.nested.flatten(site, frame, weight * opacity, into);
    }
}
