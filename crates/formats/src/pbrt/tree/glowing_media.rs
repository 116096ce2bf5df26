//! What media emit (`media.h`, `GridMedium` and `NanoVDBMedium`): a spectrum `Le`, or that of black bodies by their temperature.
//!
//! ```text
//! Le(p, λ) = Lescale(p) · Le(λ)        or        Lescale(p) · B(λ, T)/max B,   T = (temperature(p) − temperatureoffset) temperaturescale
//! ```
//!
//! `Le` is divided by its luminance as all light is, black bodies are not: pbrt's film shows their ∫ ȳ L dλ, in nanometres, where Etalon
//! shows light of the luminance 1 as 1.

use super::super::parameters::Parameters;
use super::Mapper;
use super::media::is_dark;
use super::node::{Draft, Given, given, word};
use super::spectrum::Role;
use super::textures::times;
use etalon_params::{Class, Value};
use etalon_spectrum::cie;

/// ∫ ȳ dλ of the observer of 1931 (nm).
const INTEGRAL: f64 = 106.856_895;

impl<'a> Mapper<'a> {
    /// Adds what a medium emits, `strength` times the spectrum `Le`; `None` after a mistake.
    pub(crate) fn glowing(
        &mut self,
        params: &Parameters<'a>,
        draft: Draft,
        strength: Option<Given>,
    ) -> Option<Draft> {
        let Some(emitted) = params.spectrum("Le").filter(|emitted| !is_dark(emitted)) else {
            return Some(draft);
        };
        let light = self.spectrum(params, "Le", emitted, Role::Emission(1.0))?;
        let light = given(light, params.span("Le"));
        Some(draft.given("emission", strengthened(params, light, strength)))
    }

    /// Adds what a medium of these temperatures emits.
    pub(crate) fn hot(
        &self,
        params: &Parameters<'_>,
        draft: Draft,
        temperature: Given,
        strength: Option<Given>,
    ) -> Draft {
        let cutoff = params.float("temperaturecutoff", 0.0);
        let offset = params.float("temperatureoffset", cutoff);
        let scale = params.float("temperaturescale", 1.0);
        let span = temperature.span;
        let temperature = match (offset, scale) {
            (0.0, 1.0) => temperature,
            _ => Draft::new(Class::Texture, "expression", span)
                .plain("value", word(&format!("({scale})*(t - ({offset}))")))
                .given("t", temperature)
                .value(),
        };
        let shown = INTEGRAL / cie::luminance(|_| 1.0);
        let bodies = Draft::new(Class::Texture, "incandescence", span)
            .given("temperature", temperature)
            .plain("scale", Value::Float(shown))
            .value();
        draft.given("emission", strengthened(params, bodies, strength))
    }
}

/// Light times a number, or a grid of numbers.
fn strengthened(params: &Parameters<'_>, light: Given, strength: Option<Given>) -> Given {
    match strength {
        None => light,
        Some(Given {
            value: Value::Float(factor),
            ..
        }) => times(light, factor),
        Some(grid) => {
            let product = Draft::of(params, Class::Texture, "multiply");
            product.given("a", grid).given("b", light).value()
        }
    }
}
