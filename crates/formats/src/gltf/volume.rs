//! What is inside of things that transmit (KHR_materials_volume): a medium that absorbs alone.
//!
//! After the attenuation distance d white light has the attenuation colour c: σ = −ln c / d. A material without thickness is a thin sheet in
//! glTF; here, as in Blender, what transmits refracts in any case.

use super::materials::Maker;
use crate::draft::{Draft, given};
use etalon_math::float64;
use etalon_params::{Class, DVec3, Node, Value};
use std::sync::Arc;

/// The darkest colour that is told from black.
const DARKEST: f64 = 1e-6;

impl Maker<'_, '_> {
    /// The medium, if there is one.
    pub(crate) fn interior(&mut self) -> Option<Arc<Node>> {
        let extensions = self.material.extensions.as_ref()?;
        let volume = extensions.volume.as_ref()?;
        let transmits = extensions.transmission.as_ref();
        if !transmits.is_some_and(|t| t.transmission_factor.0 > 0.0) {
            return None;
        }
        let distance = f64::from(volume.attenuation_distance.0);
        let colour = DVec3::from(volume.attenuation_color.0.map(f64::from));
        let clear = colour.min_element() >= 1.0 || !distance.is_finite() || distance <= 0.0;
        if volume.thickness_factor.0 == 0.0 || clear {
            return None;
        }
        let depth = |c: f64| -float64::ln(c.clamp(DARKEST, 1.0)) / distance;
        let part = "extensions.KHR_materials_volume";
        let sigma = Value::Rgb(DVec3::from(colour.to_array().map(depth)));
        let sigma = given(sigma, self.span(&format!("{part}.attenuationColor")));
        let draft = Draft::new(Class::Medium, "homogeneous", self.span(part));
        let draft = draft.given("sigma_t", sigma);
        Some(draft.plain("albedo", Value::Float(0.0)).node())
    }
}
