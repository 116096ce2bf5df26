//! Hair (`materials.cpp`, `HairMaterial`; `bxdfs.cpp`, `HairBxDF`): the model of Chiang et al. 2016 in both.
//!
//! Absorption is given itself, or by a reflectance c (the paper's equation 9), with β the azimuthal roughness:
//!
//! ```text
//! σₐ = [ln c / (5.969 − 0.215 β + 2.532 β² − 10.73 β³ + 5.574 β⁴ + 0.245 β⁵)]²
//! ```
//!
//! or by concentrations of pigments, by default 1.3 of eumelanin; a pigment that is not given is absent, where Mitsuba has defaults.

use super::super::parameters::Parameters;
use super::super::spectrum_value::{FloatOrTexture, SpectrumOrTexture};
use super::Mapper;
use super::dielectrics::between_vacuum;
use super::node::{Draft, Given, given};
use super::spectrum::{Role, computed};
use etalon_math::float64;
use etalon_params::{Class, Node, Value};
use std::sync::Arc;

impl<'a> Mapper<'a> {
    /// Hair; `None` after a mistake.
    pub(crate) fn hair(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let index = self.single_index(params, "eta", 1.55);
        let along = self.plain_number(params, "beta_m", 0.3);
        let around = self.plain_number(params, "beta_n", 0.3);
        let tilt = self.plain_number(params, "alpha", 2.0);
        let draft = between_vacuum(Draft::of(params, Class::Bsdf, "hair"), index?);
        let (along, around, tilt) = (along?, around?, tilt?);
        let draft = draft
            .from(
                params,
                "beta_m",
                "longitudinal_roughness",
                Value::Float(along),
            )
            .from(
                params,
                "beta_n",
                "azimuthal_roughness",
                Value::Float(around),
            )
            .from(params, "alpha", "scale_tilt", Value::Float(tilt));
        if let Some(sigma) = self.colour_if_given(params, "sigma_a", Role::Unbounded) {
            return Some(draft.given("sigma_a", sigma).node());
        }
        let colour = ["reflectance", "color"]
            .into_iter()
            .find(|name| params.has(name));
        if params.has("sigma_a") {
            return None;
        }
        if let Some(name) = colour {
            let sigma = self.absorption_of_colour(params, name, around)?;
            return Some(draft.given("sigma_a", sigma).node());
        }
        let pigments = ["eumelanin", "pheomelanin"];
        let none = !pigments.iter().any(|name| params.has(name));
        let [dark, red] = [
            self.plain_number(params, "eumelanin", if none { 1.3 } else { 0.0 }),
            self.plain_number(params, "pheomelanin", 0.0),
        ];
        Some(
            draft
                .from(params, "eumelanin", "eumelanin", Value::Float(dark?))
                .from(params, "pheomelanin", "pheomelanin", Value::Float(red?))
                .node(),
        )
    }

    fn absorption_of_colour(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        beta: f64,
    ) -> Option<Given> {
        let SpectrumOrTexture::Value(value) = params.spectrum_texture(name)? else {
            self.refuse_value(
                params,
                name,
                "hair of a textured colour",
                "a spectrum or an rgb colour",
            );
            return None;
        };
        let curve = self.curve(params, name, value, Role::Reflectance)?;
        let terms = [0.245, 5.574, -10.73, 2.532, -0.215, 5.969];
        let divisor = terms.iter().fold(0.0, |sum, term| sum * beta + term);
        // Nothing is perfectly black, as its absorption would have no end.
        let sigma = computed(&curve, |c| {
            let quotient = float64::ln(c.clamp(1e-4, 1.0)) / divisor;
            quotient * quotient
        });
        Some(given(sigma, params.span(name)))
    }

    /// A number where pbrt admits textures and Etalon does not; `None` after a mistake.
    fn plain_number(&self, params: &Parameters<'a>, name: &str, default: f64) -> Option<f64> {
        match params.float_texture(name) {
            None if params.has(name) => None,
            None => Some(default),
            Some(FloatOrTexture::Value(x)) => Some(x),
            Some(FloatOrTexture::Texture(_)) => {
                let what = format!("textured `{name}` of `{}`", params.entity.kind);
                self.refuse_value(params, name, &what, "a number");
                None
            }
        }
    }
}
