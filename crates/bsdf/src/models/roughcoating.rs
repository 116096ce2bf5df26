//! A rough clear coat over another material: see [`crate::models::coating`].

use crate::models::coating;
use crate::{LobeList, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_transport::{Build, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "roughcoating alpha=f:0.2 ( diffuse reflectance=u:0.9 )",
    "roughcoating alpha=f:0.3 distribution=s:ggx sigma_a=t:400:0.1,700:0.6 ( ward )",
    "roughcoating alpha=f:0.2 ( conductor )",
    "roughcoating alpha=f:0.15 int_ior=f:1.3 ( roughdiffuse alpha=f:0.5 )",
];

/// `roughcoating` in a scene file.
#[derive(Clone, Debug)]
pub struct Description(coating::Description);

impl Description {
    /// Reads what [`coating::Description`] does, `distribution` (beckmann) and `alpha` (0.1, one number).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        coating::Description::rough(params, build).map(Self)
    }

    /// The material's flags.
    pub fn traits(&self) -> MaterialFlags {
        self.0.traits()
    }

    /// The coat's reflection, and the base seen through it.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        self.0.flatten(site, frame, weight, into);
    }
}
