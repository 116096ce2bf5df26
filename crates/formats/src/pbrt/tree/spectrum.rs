//! Spectra: what a value of pbrt is as a reflectance, as a quantity without bounds, and as light.
//!
//! Reflectances and quantities stand as they are: both programs make smooth spectra of `rgb` (Jakob and Hanika 2019), and spectra by samples are
//! piecewise linear. Of light, pbrt divides by the luminance that the spectrum has, for an `rgb` that of its white, and multiplies by `scale`
//! (`lights.cpp`: every light's `Create` divides by `SpectrumToPhotometric`); its film shows luminance 1 as 1 (`film.h`, `PixelSensor`). In
//! Etalon, light of luminance 1 by its own measure (`cie::luminance`) is shown as 1. So an `rgb` is Etalon's `rgb` times the factor, and
//! any other spectrum is divided by its luminance.

use super::super::parameters::Parameters;
use super::super::spectrum_value::SpectrumValue;
use super::color_space::to_rec709;
use super::node::{Draft, word};
use super::{Mapper, spectrum_file};
use etalon_params::{Class, DVec3, SpectrumText, Value};
use etalon_spectrum::{LAMBDA_MAX, LAMBDA_MIN, Spectrum, cie, named_illuminants};

/// What a spectrum is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Role {
    /// A share of light, from 0 to 1.
    Reflectance,
    /// A quantity from 0 on: an index, a density.
    Unbounded,
    /// Light, with a factor.
    Emission(f64),
}

/// Where pbrt's names of illuminants differ from Etalon's.
const ILLUMINANT: &str = "stdillum-";

/// Daylight of about 6000 K, the white of ACES, by pbrt's name and Etalon's.
const ACES_WHITE: (&str, &str) = ("illum-acesD60", "D60");

/// What may be written for spectra that are not light.
const ACCEPTED: &str = "an rgb colour, pairs of a wavelength and a value, or a file of them";

impl<'a> Mapper<'a> {
    /// The value in the tree for a spectrum that stands at the parameter `name`; `None` after a mistake.
    pub(crate) fn spectrum(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        value: SpectrumValue<'a>,
        role: Role,
    ) -> Option<Value> {
        match (value, role) {
            (SpectrumValue::Rgb(..), _) => {
                let rgb = self.rgb(params, name, value, role)?;
                Some(Value::Rgb(match role {
                    Role::Emission(factor) => rgb * factor,
                    _ => rgb,
                }))
            }
            (SpectrumValue::Blackbody(kelvin), _) => {
                let body = Spectrum::blackbody(kelvin).ok();
                let Some(body) = body else {
                    params.refuse(name, kelvin, "temperatures above 0 kelvin");
                    return None;
                };
                self.scaled(params, name, &samples_of(&body), role)
            }
            (SpectrumValue::Samples(samples), _) => self.scaled(params, name, samples, role),
            (SpectrumValue::Named(spectrum), Role::Emission(factor))
                if spectrum.starts_with(ILLUMINANT) || spectrum == ACES_WHITE.0 =>
            {
                self.illuminant(params, name, spectrum, factor)
            }
            (SpectrumValue::Named(spectrum), _) => {
                if is_known_to_pbrt(spectrum) {
                    let what = format!("spectrum `{spectrum}` in this place");
                    self.refuse_value(params, name, &what, ACCEPTED);
                    return None;
                }
                let samples = self.spectrum_file(params, name, spectrum)?;
                self.scaled(params, name, &samples, role)
            }
        }
    }

    /// Light of a default spectrum, which is the white of the colour space: D65.
    pub(crate) fn white_light(factor: f64) -> Value {
        Value::Float(factor)
    }

    /// The spectrum as a function of the wavelength, for what must be computed from it.
    pub(crate) fn curve(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        value: SpectrumValue<'a>,
        role: Role,
    ) -> Option<Spectrum> {
        let made = match self.spectrum(params, name, value, role)? {
            Value::Rgb(rgb) if role == Role::Reflectance => Spectrum::reflectance(rgb.to_array()),
            Value::Rgb(rgb) => Spectrum::unbounded(rgb.to_array()),
            Value::Spectrum(SpectrumText::Samples(pairs)) => {
                let (wavelengths, values): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
                Spectrum::tabulated(&wavelengths, &values)
            }
            _ => return None,
        };
        let refused = |error: &dyn std::fmt::Display| params.error_at(name, error.to_string());
        made.map_err(|error| refused(&error)).ok()
    }

    /// An `rgb` in linear Rec. 709.
    fn rgb(
        &self,
        params: &Parameters<'_>,
        name: &str,
        value: SpectrumValue<'_>,
        role: Role,
    ) -> Option<DVec3> {
        let SpectrumValue::Rgb(written, space) = value else {
            return None;
        };
        let rgb = to_rec709(written, space, role);
        let most = match role {
            Role::Reflectance => 1.0,
            _ => f64::INFINITY,
        };
        // What is out of range by rounding of the matrices is not.
        const ROUNDING: f64 = 1e-9;
        let fits = |x: f64| (-ROUNDING..=most + ROUNDING).contains(&x);
        if rgb.to_array().into_iter().all(fits) {
            return Some(rgb.clamp(DVec3::ZERO, DVec3::splat(most)));
        }
        let shown = |v: DVec3| format!("({}, {}, {})", v.x, v.y, v.z);
        let what = match (rgb == DVec3::from_array(written), role) {
            (true, Role::Reflectance) => "numbers from 0 to 1".to_owned(),
            (true, _) => "numbers from 0 on".to_owned(),
            (false, _) => format!(
                "colours within Rec. 709, in whose coordinates this is {}",
                shown(rgb)
            ),
        };
        params.refuse(name, shown(written.into()), &what);
        None
    }

    /// Samples in their role.
    fn scaled(
        &self,
        params: &Parameters<'_>,
        name: &str,
        samples: &[[f64; 2]],
        role: Role,
    ) -> Option<Value> {
        let factor = match role {
            Role::Emission(factor) => {
                let luminance = cie::luminance(|lambda| at(samples, lambda));
                if !(luminance > 0.0 && luminance.is_finite()) {
                    let message = "pbrt divides light by its luminance, and this has none";
                    params.error_at(name, message);
                    return None;
                }
                factor / luminance
            }
            _ => 1.0,
        };
        let pairs = samples.iter().map(|[nm, value]| (*nm, value * factor));
        Some(Value::Spectrum(SpectrumText::Samples(pairs.collect())))
    }

    /// An illuminant of the CIE, whose luminance is 1 in Etalon by itself.
    fn illuminant(
        &self,
        params: &Parameters<'_>,
        name: &str,
        spectrum: &str,
        factor: f64,
    ) -> Option<Value> {
        let own = match spectrum == ACES_WHITE.0 {
            true => ACES_WHITE.1,
            false => spectrum.trim_start_matches(ILLUMINANT),
        };
        if named_illuminants::named(own).is_none() {
            let what = format!("illuminant `{spectrum}`");
            let accepted = "stdillum-A, stdillum-D50, stdillum-D65, stdillum-F1 to stdillum-F12, illum-acesD60";
            self.refuse_value(params, name, &what, accepted);
            return None;
        }
        let lamp = Draft::new(Class::Texture, "illuminant", params.span(name))
            .plain("name", word(own))
            .plain("scale", Value::Float(factor));
        Some(lamp.value().value)
    }

    /// The samples in a file.
    fn spectrum_file(
        &mut self,
        params: &Parameters<'_>,
        name: &str,
        file: &str,
    ) -> Option<Vec<[f64; 2]>> {
        match spectrum_file::read(&self.scene.search, file) {
            Ok((samples, source)) => {
                self.files.push(source);
                Some(samples)
            }
            Err(mistake) => {
                self.diagnostics.push(mistake.at(params.span(name)));
                None
            }
        }
    }
}

/// Whether a name is one of pbrt's own spectra rather than of a file.
fn is_known_to_pbrt(name: &str) -> bool {
    let families = [
        "glass-",
        "metal-",
        "stdillum-",
        "illum-",
        "canon_",
        "nikon_",
        "sony_",
        "hasselblad_",
    ];
    families.iter().any(|family| name.starts_with(family))
}

/// The value at a wavelength, linear between samples and 0 beyond them (pbrt's `PiecewiseLinearSpectrum`).
fn at(samples: &[[f64; 2]], lambda: f64) -> f64 {
    let after = samples.partition_point(|[nm, _]| *nm < lambda);
    match (
        after.checked_sub(1).and_then(|i| samples.get(i)),
        samples.get(after),
    ) {
        (_, Some([nm, value])) if *nm == lambda => *value,
        (Some([a, from]), Some([b, to])) => from + (to - from) * (lambda - a) / (b - a),
        _ => 0.0,
    }
}

/// A spectrum at every nanometre.
pub(crate) fn samples_of(spectrum: &Spectrum) -> Vec<[f64; 2]> {
    let sample = |nm: i32| [f64::from(nm), spectrum.eval_at(f64::from(nm))];
    (LAMBDA_MIN as i32..=LAMBDA_MAX as i32)
        .map(sample)
        .collect()
}

/// A function of a spectrum, at every nanometre.
pub(crate) fn computed(spectrum: &Spectrum, of: impl Fn(f64) -> f64) -> Value {
    let pairs = samples_of(spectrum).into_iter();
    let pairs = pairs.map(|[nm, value]| (nm, of(value)));
    Value::Spectrum(SpectrumText::Samples(pairs.collect()))
}
