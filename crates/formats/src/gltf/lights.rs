//! Lights without a surface (KHR_lights_punctual).
//!
//! | glTF | Etalon | times |
//! |---|---|---|
//! | point (candela) | `point` | 1/683 W/lm |
//! | spot (candela) | `spot`, with the falloff quadratic in the cosine | 1/683 W/lm |
//! | directional (lux) | `directional` | 1/683 W/lm |
//!
//! 683 lm/W is what Blender's importer divides by in its mode "Standard". Lights shine along −z of their node, whose scale does not count.

use super::nodes::Held;
use super::pose::{rigid, turned};
use super::reader::Reader;
use crate::draft::{Draft, vector, word};
use ::gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use ::gltf::json::validation::Checked;
use etalon_params::{Class, DMat4, DVec3, Node, Value};
use std::sync::Arc;

/// Lumens of a watt.
const LUMENS_PER_WATT: f64 = 683.0;

impl Reader<'_> {
    /// The light that a node holds; `None` after a mistake, and for one that is dark.
    pub(crate) fn light(&mut self, held: &Held) -> Option<Arc<Node>> {
        let lights = self
            .root
            .extensions
            .as_ref()?
            .khr_lights_punctual
            .as_ref()?;
        let path = format!("extensions.KHR_lights_punctual.lights[{}]", held.number);
        let Some(light) = lights.lights.get(held.number) else {
            let path = format!("nodes[{}].extensions.KHR_lights_punctual.light", held.node);
            self.error(&path, "there is no such light");
            return None;
        };
        let Checked::Valid(kind) = light.type_ else {
            return None;
        };
        let intensity = f64::from(light.intensity);
        if !(intensity >= 0.0 && intensity.is_finite()) {
            let help = "a finite number from 0 on";
            return self.refuse(&format!("{path}.intensity"), "no light shines so", help);
        }
        let Some(pose) = rigid(&held.world) else {
            let message = "the place of this light in the world is flat";
            self.error(&format!("nodes[{}]", held.node), message);
            return None;
        };
        if light.range.is_some() {
            let message = "`range` has no effect: light decreases with the square of the distance";
            self.note(&format!("{path}.range"), message);
        }
        let colour = DVec3::from(light.color.map(f64::from));
        let colour = Value::Rgb(colour * (intensity / LUMENS_PER_WATT));
        let place = self.span(&format!("{path}.intensity"));
        let draft = |plugin| Draft::new(Class::Emitter, plugin, self.span(&path));
        Some(match kind {
            Type::Point => {
                let position = vector(pose.w_axis.truncate());
                let draft = draft("point").plain("position", position);
                draft.with("intensity", colour, place).node()
            }
            Type::Directional => {
                let direction = vector(-pose.z_axis.truncate());
                let draft = draft("directional").plain("direction", direction);
                draft.with("irradiance", colour, place).node()
            }
            Type::Spot => {
                let draft = draft("spot").with("intensity", colour, place);
                self.cone(&path, light, draft, pose)?.node()
            }
        })
    }

    fn cone(&self, path: &str, light: &Light, draft: Draft, pose: DMat4) -> Option<Draft> {
        let spot = light.spot.as_ref()?;
        let [inner, outer] = [spot.inner_cone_angle, spot.outer_cone_angle].map(f64::from);
        if !(outer > 0.0 && outer <= std::f64::consts::FRAC_PI_2 + 1e-6) {
            let help = "radians above 0, at most π/2";
            return self.refuse(
                &format!("{path}.spot.outerConeAngle"),
                "this is no cone",
                help,
            );
        }
        if !(inner >= 0.0 && inner <= outer) {
            let help = "radians from 0 to `outerConeAngle`";
            return self.refuse(
                &format!("{path}.spot.innerConeAngle"),
                "this is no cone",
                help,
            );
        }
        let place = |name| self.span(&format!("{path}.spot.{name}"));
        let degrees = |angle: f64| Value::Float(angle.to_degrees());
        Some(
            draft
                .plain("to_world", Value::Transform(turned(pose)))
                .with("cutoff_angle", degrees(outer), place("outerConeAngle"))
                .with("beam_width", degrees(inner), place("innerConeAngle"))
                .plain("falloff", word("quadratic_in_cosine")),
        )
    }
}
