//! A smooth or rough conductor under a slab with a dielectric interface: see [`crate::layers`]. pbrt-v4's material of that name.

use crate::ShadingContext;
use crate::interface::metal::Metal;
use crate::layers::{Layered, MetalBase, SlabDescription};
use crate::microfacet::roughness::Alphas;
use etalon_params::Params;
use etalon_transport::{Build, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "coatedconductor",
    "coatedconductor base_alpha=f:0.3 eta=t:400:1.5,700:0.2 k=t:400:1.8,700:3.5",
    "coatedconductor alpha=f:0.2 eta=u:0.2 k=u:3.9",
    "coatedconductor alpha=f:0.15 base_alpha_u=f:0.5 base_alpha_v=f:0.2 eta=u:0.2 k=u:3.9 thickness=f:0.2",
    "coatedconductor thickness=f:0.5 albedo=t:400:0.9,700:0.4 g=f:-0.4 eta=u:0.2 k=u:3.9",
    "normalmap normalmap=t:450:0.9,550:0.6,600:0.7 ( coatedconductor alpha=f:0.3 base_alpha=f:0.2 k=u:3.9 )",
];

/// `coatedconductor` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    slab: SlabDescription,
    metal: Metal,
    alphas: Alphas,
}

impl Description {
    /// Reads what [`coateddiffuse`](super::coateddiffuse) does, without the `reflectance`; the metal: `material` (a name, or `none` for a perfect mirror), or `eta` (0) and
    /// `k` (1), which are divided by `int_ior`; and its `base_alpha`, or `base_alpha_u` and `base_alpha_v` (0: smooth).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let slab = SlabDescription::from_params(params, build)?;
        let metal = Metal::within(params, build, slab.interior);
        let alphas = Alphas::from_params(params, build, "base_", 0.0);
        Some(Self {
            slab,
            metal: metal?,
            alphas: alphas?,
        })
    }

    /// The model at a point.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> CoatedConductor {
        let [eta, k] = Metal::in_lanes::<f32, T>(|_| (&self.metal, site));
        CoatedConductor {
            slab: self.slab.resolve(site),
            base: MetalBase {
                eta,
                k,
                alpha: self.alphas.at(site),
            },
        }
    }
}

/// A coated conductor.
pub type CoatedConductor = Layered<MetalBase>;
