//! What varies in space, or does not: the volumes of a medium's parameters.

use etalon_params::questions::Question;
use etalon_params::{Params, Value};
use etalon_spectrum::Spectrum;
use etalon_transport::{Build, SpectrumKind, TextureId, refuse_varying};

/// The spectrum of the parameter `name`: a number, a colour, a spectrum, or a volume that is the same everywhere.
pub(crate) fn constant(
    params: &Params<'_>,
    name: &str,
    default: f64,
    kind: SpectrumKind,
    build: &mut dyn Build,
) -> TextureId {
    let property = params.node.properties.iter().find(|p| p.name == name);
    match property.map(|p| &p.value) {
        // As in Mitsuba, whatever the colour is of; one beyond 1 has no such spectrum.
        Some(Value::Rgb(rgb)) if rgb.max_element() <= 1.0 => {
            build.texture(params, name, Some(default), SpectrumKind::Reflectance)
        }
        Some(Value::Rgb(rgb)) if name.starts_with("sigma_") && name != "sigma_t" => {
            params.property(name);
            match Spectrum::unbounded(rgb.to_array()) {
                Ok(spectrum) => build.spectrum(spectrum),
                Err(error) => {
                    params.error_at(name, error.to_string());
                    build.texture(params, name, Some(default), kind)
                }
            }
        }
        _ => {
            refuse_varying(params, name);
            build.texture(params, name, Some(default), kind)
        }
    }
}

/// The radiance of a medium that emits: `emission`, if it is given.
pub(crate) fn emission(params: &Params<'_>, build: &mut dyn Build) -> Option<TextureId> {
    params.note("emission", || Question {
        kind: "a spectrum or texture".to_owned(),
        ..Question::default()
    });
    let given = params.has("emission");
    given.then(|| build.texture(params, "emission", None, SpectrumKind::Emission))
}
