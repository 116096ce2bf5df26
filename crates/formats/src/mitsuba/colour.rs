//! Colours as only Mitsuba 0.x wrote them: `<srgb>`, `#rrggbb`, `<blackbody>`, and spectra of
//! three numbers.

use super::attribute::Attributes;
use super::number;
use super::reader::Reader;
use super::version::{Version, is_old};
use etalon_math::float64;
use etalon_params::{DVec3, Diagnostic, SpectrumText, Value};
use etalon_spectrum::{LAMBDA_MAX, LAMBDA_MIN, Spectrum};

/// The colour of an `<rgb>`: one number, three, or in old files `#rrggbb`, whose parts count 1/255
/// each and are linear, as Mitsuba 0.6 has it.
pub(crate) fn rgb(
    reader: &mut Reader<'_>,
    attributes: &Attributes<'_>,
    version: Version,
) -> Option<DVec3> {
    let value = attributes.required("value");
    let old = is_old(version);
    if let Some(colour) = hexadecimal(&value.text).filter(|_| old) {
        reader.report(
            Diagnostic::note(
                value.span,
                "the parts of this `<rgb>` are read as linear, as in Mitsuba 0.6",
            )
            .help("a colour picked from a screen is written `<srgb>`"),
        );
        return Some(colour);
    }
    match attributes.list(reader, "value", &[1, 3]).as_deref() {
        Some(&[r, g, b]) => Some(DVec3::new(r, g, b)),
        Some(&[grey]) => Some(DVec3::splat(grey)),
        _ => None,
    }
}

/// The linear colour of an `<srgb>`, whose parts are encoded with the sRGB transfer function
/// (IEC 61966-2-1:1999).
pub(crate) fn srgb(reader: &mut Reader<'_>, attributes: &Attributes<'_>) -> Option<DVec3> {
    let value = attributes.required("value");
    let encoded = match hexadecimal(&value.text) {
        Some(colour) => colour,
        None => match attributes.list(reader, "value", &[1, 3]).as_deref() {
            Some(&[r, g, b]) => DVec3::new(r, g, b),
            Some(&[grey]) => DVec3::splat(grey),
            _ => return None,
        },
    };
    let linear = |e: f64| {
        if e <= 0.040_45 {
            e / 12.92
        } else {
            float64::pow((e + 0.055) / 1.055, 2.4)
        }
    };
    Some(DVec3::from_array(encoded.to_array().map(linear)))
}

/// The parts of `#rrggbb`, each from 0 to 1.
fn hexadecimal(text: &str) -> Option<DVec3> {
    let digits = text.trim().strip_prefix('#')?;
    let sound = digits.len() == 6 && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    let part = |i: usize| {
        let value = u8::from_str_radix(&digits[i..i + 2], 16).ok()?;
        Some(f64::from(value) / 255.0)
    };
    sound.then(|| Some(DVec3::new(part(0)?, part(2)?, part(4)?)))?
}

/// What a `<spectrum>` of numbers without wavelengths means, if it is one that Mitsuba 0.x
/// understood: `intent="illuminant"` makes a number one of white light, and three numbers are an
/// rgb colour (with the usual build of Mitsuba 0.x, whose spectra had three samples).
pub(crate) fn spectrum_without_wavelengths(
    reader: &mut Reader<'_>,
    attributes: &Attributes<'_>,
    version: Version,
) -> Option<Value> {
    let value = attributes.get("value")?;
    if value.text.contains(':') {
        return None;
    }
    let count = number::tokens(&value.text).count();
    let illuminant = attributes
        .get("intent")
        .is_some_and(|intent| intent.text.eq_ignore_ascii_case("illuminant"));
    if count == 1 && illuminant {
        return attributes.float(reader, "value").map(Value::Float);
    }
    if count != 3 || !is_old(version) {
        return None;
    }
    let numbers = attributes.list(reader, "value", &[3])?;
    reader.report(
        Diagnostic::note(
            value.span,
            "three numbers without wavelengths are read as an rgb colour",
        )
        .help("write `<rgb>`, or pairs such as `400:0.1, 700:0.8` (nm)"),
    );
    Some(Value::Rgb(DVec3::from_slice(&numbers)))
}

/// The radiance of a `<blackbody>` (W·m⁻²·sr⁻¹·nm⁻¹) at every nanometre, times its `scale`.
pub(crate) fn blackbody(
    reader: &mut Reader<'_>,
    attributes: &Attributes<'_>,
) -> Option<SpectrumText> {
    let attribute = attributes.required("temperature");
    let text = attribute.text.trim();
    let kelvin = number::float(text.strip_suffix(['K', 'k']).unwrap_or(text));
    let spectrum = kelvin
        .ok()
        .and_then(|kelvin| Spectrum::blackbody(kelvin).ok());
    let Some(spectrum) = spectrum else {
        reader.report(
            attribute
                .error_whole(format!("`{}` is not a temperature", number::excerpt(text)))
                .help("a temperature is a number of kelvins above 0, such as `5000K`"),
        );
        return None;
    };
    let scale = match attributes.get("scale") {
        Some(_) => attributes.float(reader, "scale")?,
        None => 1.0,
    };
    let sample = |nm: i32| {
        let nm = f64::from(nm);
        (nm, spectrum.eval_at(nm) * scale)
    };
    let range = LAMBDA_MIN as i32..=LAMBDA_MAX as i32;
    Some(SpectrumText::Samples(range.map(sample).collect()))
}
