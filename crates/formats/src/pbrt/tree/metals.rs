//! Metals (`materials.cpp`, `ConductorMaterial`; `util/spectrum.cpp` for the names).
//!
//! The index is given by `eta` and `k`, by default those of copper, or follows from a `reflectance` r at normal incidence: η = 1 and
//! k = 2√r / √(1 − r). Named metals are those of the same name in Etalon, whose tables are other measurements. Two oxides are transparent and
//! have formulas, with λ in µm and k = 0:
//!
//! ```text
//! MgO    n² = 2.956362 − 0.01062387 λ² − 0.0000204968 λ⁴ + 0.0219577/(λ² − 0.01428322)     (R. E. Stephens, I. H. Malitson 1952)
//! TiO2   n² = 5.913 + 0.2441/(λ² − 0.0803)                                                 (J. R. Devore 1951: rutile, ordinary ray)
//! ```

use super::super::parameters::Parameters;
use super::super::spectrum_value::{SpectrumOrTexture, SpectrumValue};
use super::Mapper;
use super::node::{Draft, Given, given, word};
use super::spectrum::{Role, computed, samples_of};
use etalon_params::{Class, Node, Span, SpectrumText, Value};
use etalon_spectrum::{LAMBDA_MAX, LAMBDA_MIN, conductors};
use std::sync::Arc;

/// The reflectance that counts for one of 1, as in pbrt.
const MOST_REFLECTANCE: f64 = 0.9999;

impl<'a> Mapper<'a> {
    /// A metal, rough or not; `None` after a mistake.
    pub(crate) fn conductor(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let draft = self.roughness(params, "")?.model(params, "conductor");
        Some(self.metal_under(params, "", draft)?.node())
    }

    /// The node with the index of the metal whose parameters begin with `prefix`; `None` after a mistake.
    pub(crate) fn metal_under(
        &mut self,
        params: &Parameters<'a>,
        prefix: &str,
        draft: Draft,
    ) -> Option<Draft> {
        Some(match self.metal_index(params, prefix)? {
            Metal::Named(name, span) => draft.given("material", given(word(name), span)),
            Metal::Index(index) => {
                let [eta, k] = *index;
                draft.given("eta", eta).given("k", k)
            }
        })
    }

    fn metal_index(&mut self, params: &Parameters<'a>, prefix: &str) -> Option<Metal<'a>> {
        let name = |last: &str| format!("{prefix}{last}");
        let (eta, k) = (name("eta"), name("k"));
        // It has no prefix in `coatedconductor`.
        if params.has("reflectance") {
            if params.has(&eta) || params.has(&k) {
                let message = "`reflectance` cannot be given together with `eta` or `k`";
                params.error_at("reflectance", message);
                params.ignore(&["reflectance", &eta, &k]);
                return None;
            }
            return self.metal_of_reflectance(params, "reflectance");
        }
        let given_eta = params.spectrum_texture(&eta);
        let given_k = params.spectrum_texture(&k);
        if (given_eta.is_none() && params.has(&eta)) || (given_k.is_none() && params.has(&k)) {
            return None;
        }
        let own = [named_metal(given_eta, "-eta"), named_metal(given_k, "-k")];
        if let [Some(a), Some(b)] = own
            && a == b
        {
            let [own_eta, own_k] = self.metal(params, &eta, a)?;
            let places = [params.span(&eta), params.span(&k)];
            return Some(match conductors::lookup(a) {
                Some(_) => Metal::Named(a, places[0]),
                None => Metal::Index(Box::new([
                    given(own_eta, places[0]),
                    given(own_k, places[1]),
                ])),
            });
        }
        let mut part = |parameter: &str, own: Option<&'a str>, is_eta: bool| match own {
            Some(metal) => {
                let [eta, k] = self.metal(params, parameter, metal)?;
                Some(given(if is_eta { eta } else { k }, params.span(parameter)))
            }
            None => self.colour(params, parameter, 0.0, Role::Unbounded),
        };
        let [own_eta, own_k] = own;
        let (eta, k) = (part(&eta, own_eta, true), part(&k, own_k, false));
        Some(Metal::Index(Box::new([eta?, k?])))
    }

    /// η and k of a metal of Etalon's.
    fn metal(&self, params: &Parameters<'_>, parameter: &str, metal: &str) -> Option<[Value; 2]> {
        if let Some(eta) = oxide(metal) {
            let k = Value::Spectrum(SpectrumText::Uniform(0.0));
            return Some([Value::Spectrum(SpectrumText::Samples(eta)), k]);
        }
        let Some((eta, k)) = conductors::lookup(metal) else {
            let what = format!("metal `{metal}`");
            let accepted = "metal-Ag, -Al, -Au, -Cu, -MgO, -TiO2 (each with -eta and -k), or pairs of a wavelength and a value";
            self.refuse_value(params, parameter, &what, accepted);
            return None;
        };
        let sampled = |spectrum| {
            let pairs = samples_of(spectrum).into_iter().map(|[nm, x]| (nm, x));
            Value::Spectrum(SpectrumText::Samples(pairs.collect()))
        };
        Some([sampled(&eta), sampled(&k)])
    }

    fn metal_of_reflectance(&mut self, params: &Parameters<'a>, name: &str) -> Option<Metal<'a>> {
        let span = params.span(name);
        let k = match params.spectrum_texture(name)? {
            SpectrumOrTexture::Texture(_) => {
                let reflectance = self.colour_if_given(params, name, Role::Reflectance)?;
                let k = Draft::new(Class::Texture, "extinction", span);
                k.given("reflectance", reflectance).value().value
            }
            SpectrumOrTexture::Value(value) => {
                let curve = self.curve(params, name, value, Role::Reflectance)?;
                computed(&curve, |r| {
                    let r = r.clamp(0.0, MOST_REFLECTANCE);
                    2.0 * r.sqrt() / (1.0 - r).sqrt()
                })
            }
        };
        let one = Value::Spectrum(SpectrumText::Uniform(1.0));
        let index = [given(one, span), given(k, span)];
        Some(Metal::Index(Box::new(index)))
    }
}

/// The index of a metal.
enum Metal<'a> {
    /// By name, with the place where it stands.
    Named(&'a str, Span),
    /// η and k.
    Index(Box<[Given; 2]>),
}

/// The index of an oxide at every nanometre.
fn oxide(name: &str) -> Option<Vec<(f64, f64)>> {
    let squared = |square: f64| match name {
        "MgO" => Some(
            2.956_362 - 0.010_623_87 * square - 0.000_020_496_8 * square * square
                + 0.021_957_70 / (square - 0.014_283_22),
        ),
        "TiO2" => Some(5.913 + 0.2441 / (square - 0.0803)),
        _ => None,
    };
    let wavelengths = LAMBDA_MIN as i32..=LAMBDA_MAX as i32;
    let sample = |nm: i32| {
        let micrometres = f64::from(nm) * 1e-3;
        Some((f64::from(nm), squared(micrometres * micrometres)?.sqrt()))
    };
    wavelengths.map(sample).collect()
}

/// The metal of a name such as `metal-Ag-eta`, which ends as asked; copper if nothing is given.
fn named_metal<'a>(value: Option<SpectrumOrTexture<'a>>, end: &str) -> Option<&'a str> {
    match value {
        None => Some("Cu"),
        Some(SpectrumOrTexture::Value(SpectrumValue::Named(name))) => {
            name.strip_prefix("metal-")?.strip_suffix(end)
        }
        Some(_) => None,
    }
}
