//! A thin pane of dielectric: two parallel interfaces so close that refraction cancels.
//!
//! ```text
//! R' = 2R / (1 + R)      (all internal reflections summed; 1 − R' goes straight on)
//! ```
//!
//! With R Fresnel's reflectance of one interface (Born & Wolf 1999, section 1.6, incoherent).
//! Mitsuba's plugin of that name. The transmitted light passes straight on, so shadow rays
//! see through the pane.

use crate::interface::fresnel;
use crate::interface::relative_index::RelativeIndex;
use crate::models::mirror::Mirror;
use crate::{AnyBxdf, LobeList, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "thindielectric",
    "thindielectric int_ior=f:2 specular_transmittance=t:400:0.1,700:0.9",
];

/// `thindielectric` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    eta: f32,
    reflectance: TextureId,
    transmittance: TextureId,
}

impl Description {
    /// Reads `int_ior` (bk7), `ext_ior` (air), `specular_reflectance` (1) and
    /// `specular_transmittance` (1).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut factor = |name| build.texture(params, name, Some(1.0), SpectrumKind::Reflectance);
        let reflectance = factor("specular_reflectance");
        let transmittance = factor("specular_transmittance");
        Some(Self {
            eta: RelativeIndex::constant_from_params(params, "bk7")? as f32,
            reflectance,
            transmittance,
        })
    }

    /// A mirror, and light that passes.
    pub fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            lobes: 1,
            null: true,
            transmission: true,
            ..MaterialFlags::default()
        }
    }

    /// R', unless `wo` lies in the surface.
    fn reflected<T: Textures>(&self, site: &ShadingContext<'_, T>, frame: Frame) -> Option<f32> {
        let cos = frame.n.dot(site.wo).abs().min(1.0);
        let one = fresnel::dielectric(cos, self.eta).0;
        (cos > 0.0).then_some(2.0 * one / (1.0 + one))
    }

    /// The reflected light as a mirror, the rest passing.
    pub fn flatten<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'_>,
    ) {
        let Some(both) = self.reflected(site, frame) else {
            return;
        };
        let mirror = Mirror {
            reflectance: site.spectrum(self.reflectance) * both,
        };
        into.push(AnyBxdf::Mirror(mirror), frame, weight, weight * both);
        into.pass(
            site.spectrum(self.transmittance) * (weight * (1.0 - both)),
            weight * (1.0 - both),
        );
    }
}
