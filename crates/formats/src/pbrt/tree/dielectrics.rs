//! Glass (`materials.cpp`, `DielectricMaterial` and `ThinDielectricMaterial`).
//!
//! The index is the one inside, and outside there is vacuum, in which Mitsuba's default is air. A spectrum disperses in both.
//! pbrt's named glasses are tables from refractiveindex.info; here they follow Sellmeier's formula with the coefficients of
//! SCHOTT's data sheets (n² − 1 = Σ Bᵢ λ²/(λ² − Cᵢ), λ in µm), from which those tables are computed.

use super::super::parameters::Parameters;
use super::super::spectrum_value::{FloatOrSpectrum, SpectrumValue};
use super::Mapper;
use super::node::{Draft, Given, given, word};
use super::roughness::Roughness;
use super::spectrum::Role;
use etalon_params::{Node, Value};
use std::sync::Arc;

/// pbrt's names, each with B₁, B₂, B₃ and C₁, C₂, C₃. Its F5, F10 and F11 are SF5, SF10 and SF11.
const GLASSES: [(&str, [f64; 6]); 7] = [
    (
        "glass-BK7",
        [
            1.03961212,
            0.231792344,
            1.01046945,
            0.00600069867,
            0.0200179144,
            103.560653,
        ],
    ),
    (
        "glass-BAF10",
        [
            1.5851495,
            0.143559385,
            1.08521269,
            0.00926681282,
            0.0424489805,
            105.613573,
        ],
    ),
    (
        "glass-FK51A",
        [
            0.971247817,
            0.216901417,
            0.904651666,
            0.00472301995,
            0.0153575612,
            168.68133,
        ],
    ),
    (
        "glass-LASF9",
        [
            2.00029547,
            0.298926886,
            1.80691843,
            0.0121426017,
            0.0538736236,
            156.530829,
        ],
    ),
    (
        "glass-F5",
        [
            1.52481889,
            0.187085527,
            1.42729015,
            0.011254756,
            0.0588995392,
            129.141675,
        ],
    ),
    (
        "glass-F10",
        [
            1.62153902,
            0.256287842,
            1.64447552,
            0.0122241457,
            0.0595736775,
            147.468793,
        ],
    ),
    (
        "glass-F11",
        [
            1.73759695,
            0.313747346,
            1.89878101,
            0.013188707,
            0.0623068142,
            155.23629,
        ],
    ),
];

impl<'a> Mapper<'a> {
    /// Glass, rough or not; `None` after a mistake.
    pub(crate) fn dielectric(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let roughness = self.roughness(params, "");
        let index = self.index(params, "eta", 1.5)?;
        Some(between_vacuum(roughness?.model(params, "dielectric"), index).node())
    }

    /// A pane of glass; `None` after a mistake.
    pub(crate) fn thin_dielectric(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let index = self.single_index(params, "eta", 1.5)?;
        let draft = Roughness::Smooth.model(params, "thindielectric");
        Some(between_vacuum(draft, index).node())
    }

    /// An index of refraction; `None` after a mistake.
    fn index(&mut self, params: &Parameters<'a>, name: &str, default: f64) -> Option<Given> {
        let span = params.span(name);
        let value = match params.float_or_spectrum(name) {
            None if params.has(name) => return None,
            None => Value::Float(default),
            Some(FloatOrSpectrum::Float(index)) => Value::Float(index),
            Some(FloatOrSpectrum::Spectrum(SpectrumValue::Named(glass)))
                if glass.starts_with("glass-") =>
            {
                let Some((_, terms)) = GLASSES.iter().find(|(known, _)| *known == glass) else {
                    let known: Vec<&str> = GLASSES.iter().map(|(known, _)| *known).collect();
                    params.refuse(name, format!("`{glass}`"), &known.join(", "));
                    return None;
                };
                let terms: Vec<String> = terms.iter().map(f64::to_string).collect();
                word(&format!("sellmeier: {}", terms.join(" ")))
            }
            Some(FloatOrSpectrum::Spectrum(spectrum)) => {
                self.spectrum(params, name, spectrum, Role::Unbounded)?
            }
        };
        Some(given(value, span))
    }

    /// An index that is the same at all wavelengths; `None` after a mistake.
    pub(crate) fn single_index(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        default: f64,
    ) -> Option<Given> {
        let index = self.index(params, name, default)?;
        if matches!(index.value, Value::Float(_)) {
            return Some(index);
        }
        let what = format!("`{}` that disperses", params.entity.kind);
        self.refuse_value(params, name, &what, "a number");
        None
    }
}

/// Adds the indices inside and outside.
pub(crate) fn between_vacuum(draft: Draft, index: Given) -> Draft {
    let draft = draft.given("int_ior", index);
    draft.plain("ext_ior", Value::Float(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The indices at 587.6 nm that SCHOTT states.
    #[test]
    fn glasses_have_their_stated_indices() {
        let stated = [
            1.51680, 1.67003, 1.48656, 1.85025, 1.67271, 1.72828, 1.78472,
        ];
        for ((name, terms), stated) in GLASSES.iter().zip(stated) {
            let squared = 0.5875618 * 0.5875618;
            let sum: f64 = (0..3)
                .map(|i| terms[i] * squared / (squared - terms[i + 3]))
                .sum();
            let index = (1.0 + sum).sqrt();
            assert!((index - stated).abs() < 1e-5, "{name}: {index}");
        }
    }
}
