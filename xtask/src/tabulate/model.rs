//! What is tabulated, from words.

use etalon_benches::material::LoneMaterial;
use etalon_spectrum::colour_space::XYZ_TO_RGB;
use etalon_spectrum::{Spectrum, cie};
use glam::{Vec3, Vec4};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A material, evaluated at directions and wavelengths.
pub(super) struct Model(LoneMaterial);

impl Model {
    /// The material that words describe: the name of a plugin and `key=value`s, a file whose only element is a
    /// `<bsdf>`, or a table.
    pub(super) fn read(words: &[String]) -> Result<Self, String> {
        LoneMaterial::read(&material(words)?, Vec::new()).map(Self)
    }

    /// f cos θi for the known `wo` and the sampled `wi`, at wavelengths in nm.
    pub(super) fn value(&self, wo: Vec3, wi: Vec3, wavelengths: &[f32]) -> Vec<f32> {
        self.0.value(wo, wi, wavelengths)
    }

    /// The BRDF, without the cosine.
    pub(super) fn brdf(&self, wo: Vec3, wi: Vec3, wavelengths: &[f32]) -> Vec<f32> {
        let values = self.value(wo, wi, wavelengths);
        values.into_iter().map(|value| value / wi.z).collect()
    }
}

/// Weights by which spectra at `count` wavelengths in 360–830 nm, lit by D65, become linear Rec. 709.
pub(super) fn rgb_weights(count: usize) -> (Vec<f32>, Vec<[f64; 3]>) {
    let wavelengths: Vec<f32> = (0..count)
        .map(|i| 360.0 + 470.0 * i as f32 / (count - 1) as f32)
        .collect();
    let light = Spectrum::d65(1.0).expect("a scale of one is valid");
    let rows: Vec<[f64; 3]> = (wavelengths.iter())
        .map(|&lambda| {
            let xyz = cie::colour_matching(f64::from(lambda));
            let power = f64::from(light.eval(Vec4::splat(lambda)).x);
            XYZ_TO_RGB.map(|row| power * (row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]))
        })
        .collect();
    // A white reflectance is white, in spite of the sum's error.
    let totals: [f64; 3] = std::array::from_fn(|c| rows.iter().map(|row| row[c]).sum());
    let weights = rows
        .into_iter()
        .map(|row| std::array::from_fn(|c| row[c] / totals[c]))
        .collect();
    (wavelengths, weights)
}

fn material(words: &[String]) -> Result<String, String> {
    let [first, rest @ ..] = words else {
        return Err("name a model, for example: roughconductor material=Au alpha=0.3".to_owned());
    };
    let path = Path::new(first);
    match path.extension().and_then(|e| e.to_str()) {
        Some("xml") if rest.is_empty() => {
            return fs::read_to_string(path).map_err(|e| format!("{first}: {e}"));
        }
        Some("bsdf" | "binary" | "brdf") if rest.is_empty() => {
            let real = path.canonicalize().map_err(|e| format!("{first}: {e}"))?;
            return Ok(element(
                "measured",
                &[("filename", &real.to_string_lossy())],
            ));
        }
        _ => {}
    }
    let pairs: Vec<(&str, &str)> = (rest.iter())
        .map(|word| {
            word.split_once('=')
                .ok_or_else(|| format!("`{word}` is not of the form key=value"))
        })
        .collect::<Result<_, _>>()?;
    Ok(element(first, &pairs))
}

/// A `<bsdf>`; a value is a number, `true`, `false`, a colour `r,g,b`, a spectrum `nm:value,…`, or a string.
fn element(plugin: &str, pairs: &[(&str, &str)]) -> String {
    let mut out = format!("<bsdf type=\"{}\">", escaped(plugin));
    for (key, value) in pairs {
        let numbers = value.split(',').map(|part| part.parse::<f64>().is_ok());
        let kind = if value.parse::<f64>().is_ok() {
            "float"
        } else if matches!(*value, "true" | "false") {
            "boolean"
        } else if numbers.clone().count() == 3 && numbers.clone().all(|number| number) {
            "rgb"
        } else if value.split(',').all(|pair| {
            let pair = pair.split_once(':');
            pair.is_some_and(|(a, b)| a.parse::<f64>().is_ok() && b.parse::<f64>().is_ok())
        }) {
            "spectrum"
        } else {
            "string"
        };
        let _ = write!(
            out,
            "<{kind} name=\"{}\" value=\"{}\"/>",
            escaped(key),
            escaped(value)
        );
    }
    out + "</bsdf>"
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}
