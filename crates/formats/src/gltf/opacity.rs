//! How much of a surface is there (glTF 2.0, §3.9.4): all, what alpha says, or what of it reaches `alphaCutoff`.

use super::materials::Maker;
use crate::draft::{Draft, Given, given, word};
use ::gltf::json::validation::Checked;
use ::gltf::material::AlphaMode;
use etalon_params::{Class, Value};

/// A step: 1 from the cutoff on, and 0 below it by a millionth or more.
const STEP: &str = "min(1, max(0, 1 + 1000000*(alpha - cutoff)))";

impl Maker<'_, '_> {
    /// The opacity, if it is less than 1 anywhere; the outer `None` is after a mistake.
    pub(crate) fn opacity(&mut self) -> Option<Option<Given>> {
        let mode = match self.material.alpha_mode {
            Checked::Valid(AlphaMode::Opaque) | Checked::Invalid => return Some(None),
            Checked::Valid(mode) => mode,
        };
        let alpha = self.alpha()?;
        let cutoff = self.material.alpha_cutoff.as_ref();
        let cutoff = cutoff.map_or(0.5, |cutoff| f64::from(cutoff.0));
        let opacity = match (mode, &alpha.value) {
            (AlphaMode::Mask, Value::Float(constant)) => {
                let there = f64::from(u8::from(*constant >= cutoff));
                given(Value::Float(there), alpha.span)
            }
            (AlphaMode::Mask, _) => {
                let place = self.span("alphaCutoff");
                let draft = Draft::new(Class::Texture, "expression", alpha.span);
                draft
                    .plain("value", word(STEP))
                    .given("alpha", alpha)
                    .with("cutoff", Value::Float(cutoff), place)
                    .value()
            }
            _ => alpha,
        };
        let whole = matches!(opacity.value, Value::Float(x) if x >= 1.0);
        Some((!whole).then_some(opacity))
    }
}
