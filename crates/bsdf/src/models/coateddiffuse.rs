//! A diffuse base under a slab with a dielectric interface: see [`crate::layers`]. pbrt-v4's material of that name.

use crate::ShadingContext;
use crate::layers::{Layered, SlabDescription};
use crate::models::diffuse::Diffuse;
use etalon_params::Params;
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "coateddiffuse",
    "coateddiffuse alpha=f:0.2 reflectance=t:400:0.2,700:0.9",
    "coateddiffuse alpha_u=f:0.4 alpha_v=f:0.15 thickness=f:0.5 albedo=t:400:0.9,700:0.3 g=f:0.6",
    "coateddiffuse int_ior=f:1 ext_ior=f:1.5 thickness=f:2 albedo=u:0.8 max_depth=i:30 samples=i:2",
    "blendbsdf weight=f:0.3 ( coateddiffuse alpha=f:0.3 ) ( diffuse )",
];

/// `coateddiffuse` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    slab: SlabDescription,
    reflectance: TextureId,
}

impl Description {
    /// Reads `int_ior` (bk7) and `ext_ior` (air); the interface's `alpha`, or `alpha_u` and `alpha_v` (0: smooth); the optical
    /// `thickness` of what is inside (0.01), its `albedo` (0) and `g` (0); of the walks their `max_depth` (10) and `samples` (1);
    /// and the base's `reflectance` (0.5).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let kind = SpectrumKind::Reflectance;
        let reflectance = build.texture(params, "reflectance", Some(0.5), kind);
        Some(Self {
            slab: SlabDescription::from_params(params, build)?,
            reflectance,
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> CoatedDiffuse {
        CoatedDiffuse {
            slab: self.slab.resolve(site),
            base: Diffuse {
                reflectance: site.spectrum(self.reflectance),
            },
        }
    }
}

/// A coated diffuse base.
pub type CoatedDiffuse = Layered<Diffuse>;
