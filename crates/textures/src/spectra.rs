//! `uniform`, `regular`, `irregular`, `blackbody`, `illuminant` and `srgb`: spectra that are the same everywhere.

use crate::reader::Use;
use crate::{Constant, Texture, TextureReader};
use etalon_params::{Params, Value};
use etalon_spectrum::spd::check_unit;
use etalon_spectrum::{Blackbody, Spectrum, named_illuminants};
use etalon_transport::SpectrumKind;
use std::sync::Arc;

/// Reads a spectrum, held to what its purpose admits.
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    purpose: Use,
) -> Option<Texture> {
    let spectrum = spectrum(reader, params, purpose)?;
    let admitted = reader.admitted(spectrum, purpose, params.node.plugin.span)?;
    Some(Texture::from(Constant::new(admitted)))
}

fn spectrum(reader: &TextureReader<'_>, params: &Params<'_>, purpose: Use) -> Option<Spectrum> {
    let span = params.node.plugin.span;
    let numbers = |name| numbers(params, name);
    let required = |name| {
        let number = params.float(name);
        if number.is_none() && !params.has(name) {
            params.missing(name, "a number");
        }
        number
    };
    let spectrum = match params.node.plugin.value.as_str() {
        "uniform" => Spectrum::uniform(required("value")?),
        "regular" => {
            let (min, max) = (required("wavelength_min"), required("wavelength_max"));
            let values = numbers("values");
            let (min, max) = (min?, max?);
            in_nanometres(params, "wavelength_max", &[min, max])?;
            let values = values?;
            match Spectrum::regular(min, max, &values) {
                Ok(_) if purpose.role == SpectrumKind::Index => {
                    let step = (max - min) / (values.len() - 1) as f64;
                    let wavelengths = (0..values.len()).map(|i| min + i as f64 * step);
                    reader.table(&wavelengths.collect::<Vec<_>>(), &values, purpose, span)
                }
                made => made,
            }
        }
        "irregular" => {
            let (wavelengths, values) = (numbers("wavelengths"), numbers("values"));
            in_nanometres(params, "wavelengths", wavelengths.as_deref().unwrap_or(&[]))?;
            let (wavelengths, values) = (wavelengths?, values?);
            match purpose.role {
                SpectrumKind::Index => reader.table(&wavelengths, &values, purpose, span),
                _ => Spectrum::irregular(&wavelengths, &values),
            }
        }
        "illuminant" => {
            let Some(name) = params.string("name") else {
                params.missing("name", "the name of an illuminant");
                return None;
            };
            let Some(lamp) = named_illuminants::named(name) else {
                params.refuse("name", name, named_illuminants::NAMES);
                return None;
            };
            let what = "a finite number not below 0";
            let scale = params.float_where("scale", 1.0, what, |x| x >= 0.0 && x.is_finite());
            Ok(Spectrum::Regular(Arc::new(lamp.scaled(scale as f32))))
        }
        "blackbody" => {
            let min = params.float_or("wavelength_min", etalon_spectrum::LAMBDA_MIN);
            let max = params.float_or("wavelength_max", etalon_spectrum::LAMBDA_MAX);
            Blackbody::with_range(required("temperature")?, min, max)
                .map(|body| Spectrum::Blackbody(Arc::new(body)))
        }
        _ => {
            let unbounded = params.boolean_or("unbounded", false);
            let Some(property) = params.property("color") else {
                params.missing("color", "an rgb colour");
                return None;
            };
            let Value::Rgb(rgb) = &property.value else {
                let kind = property.value.kind();
                params.error_at(
                    "color",
                    format!("`color` must be an rgb colour, not {kind}"),
                );
                return None;
            };
            if !unbounded {
                // As in Mitsuba, this plugin takes reflectances only.
                return reader.checked(Spectrum::reflectance(rgb.to_array()), property.span);
            }
            let purpose = Use {
                role: SpectrumKind::Unbounded,
                nested: false,
            };
            return reader.colour(*rgb, purpose, property.span);
        }
    };
    reader.checked(spectrum, span)
}

/// `None`, after a diagnostic, if the wavelengths in a property cannot be meant in nanometres.
fn in_nanometres(params: &Params<'_>, name: &str, wavelengths: &[f64]) -> Option<()> {
    let checked = check_unit(wavelengths);
    checked
        .map_err(|message| params.error_at(name, message))
        .ok()
}

/// A list of numbers separated by commas or spaces.
pub(crate) fn numbers(params: &Params<'_>, name: &str) -> Option<Vec<f64>> {
    let Some(text) = params.string(name) else {
        if !params.has(name) {
            params.missing(name, "numbers separated by commas or spaces");
        }
        return None;
    };
    let words = text.split([',', ' ', '\t', '\n', '\r']);
    words
        .filter(|word| !word.is_empty())
        .map(|word| {
            let number = word.parse::<f64>().ok();
            if number.is_none() {
                params.error_at(name, format!("`{word}` in `{name}` is not a number"));
            }
            number
        })
        .collect()
}
