//! Volumes: the parameters of a medium, constant or varying in space.

use crate::tracking::Tracking;
use etalon_params::questions::Question;
use etalon_params::{ParameterKind, Params, Value};
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
    let property = params.node.property(name);
    match property.map(|p| &p.value) {
        // As in Mitsuba, a reflectance spectrum for any quantity; none exists for a colour above 1.
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
            refuse_varying(params, name, build);
            build.texture(params, name, Some(default), kind)
        }
    }
}

/// Reads `tracking`, and `step` for ray marching; the default is `usual`.
pub(crate) fn tracking(params: &Params<'_>, usual: Tracking) -> Tracking {
    // Only homogeneous media have a closed form.
    let all = ["closed", "ratio", "delta", "residual", "raymarch"];
    let accepted = &all[usize::from(usual != Tracking::Closed)..];
    let chosen = params.choice("tracking", accepted[0], accepted);
    let what = "a length in metres, above 0";
    let step = |_| params.float_where("step", 0.1, what, |step| step > 0.0 && step.is_finite());
    let given = params.property("step");
    match chosen {
        "raymarch" => {
            if given.is_none() {
                params.missing("step", what);
            }
            Tracking::RayMarching(given.map_or(0.1, step) as f32)
        }
        _ => {
            if given.is_some() {
                params.error_at(
                    "step",
                    "`step` has no effect unless `tracking` is `raymarch`",
                );
            }
            match chosen {
                "closed" => Tracking::Closed,
                "delta" => Tracking::Delta,
                "residual" => Tracking::Residual,
                _ => Tracking::Ratio,
            }
        }
    }
}

/// The radiance of a medium that emits: `emission`, if it is given.
pub(crate) fn emission(params: &Params<'_>, build: &mut dyn Build) -> Option<TextureId> {
    params.note("emission", || Question {
        kind: ParameterKind::SpectrumOrTexture,
        ..Question::default()
    });
    let given = params.has("emission");
    given.then(|| build.volume(params, "emission", None, SpectrumKind::Emission))
}
