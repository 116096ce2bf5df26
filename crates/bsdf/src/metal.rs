//! Reading the complex refractive index of a conductor: by name, or as `eta` and `k`.

use crate::ShadingContext;
use crate::ior::number_from_params;
use etalon_params::{Diagnostic, Params};
use etalon_spectrum::{Spectrum, conductors, parse_spd};
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};
use glam::Vec4;

/// η and k, with textures. The outside is vacuum, as in Mitsuba 3, unless the scene says otherwise.
#[derive(Clone, Debug)]
pub struct Metal {
    eta: TextureId,
    k: TextureId,
    /// 1 over the index outside.
    inverse_exterior: f32,
}

impl Metal {
    /// Reads `material` (a name, or `none` for a perfect mirror), or `eta` (0) and `k` (1), whose
    /// defaults are the perfect mirror too; and `ext_eta`, a number or a name (vacuum), by which
    /// both are divided.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let exterior = number_from_params(params, "ext_eta", "vacuum");
        let inverse_exterior = (1.0 / exterior?) as f32;
        params.note_default("material", "a string", "none");
        let name = params.string("material").unwrap_or("none");
        if name == "none" {
            return Some(Self {
                eta: build.texture(params, "eta", Some(0.0), SpectrumKind::Unbounded),
                k: build.texture(params, "k", Some(1.0), SpectrumKind::Unbounded),
                inverse_exterior,
            });
        }
        if params.has("eta") || params.has("k") {
            params.error_at("material", "give either `material` or `eta` and `k`");
            params.ignore(&["eta", "k"]);
            return None;
        }
        // Whoever provides files for a name means them, even where data for it come with us.
        let provided = build.assets().bytes(&file(name, "eta")).is_ok();
        let (eta, k) = match conductors::lookup(name) {
            Some(found) if !provided => found,
            _ => (
                from_file(params, build, name, "eta")?,
                from_file(params, build, name, "k")?,
            ),
        };
        Some(Self {
            eta: build.spectrum(eta),
            k: build.spectrum(k),
            inverse_exterior,
        })
    }

    /// η and k at a point relative to the outside, per lane.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> (Vec4, Vec4) {
        let relative = self.inverse_exterior;
        (
            site.spectrum(self.eta) * relative,
            site.spectrum(self.k) * relative,
        )
    }
}

/// The name of the file with one part of a conductor's index.
fn file(name: &str, part: &str) -> String {
    format!("{name}.{part}.spd")
}

/// The spectrum in `NAME.PART.spd`, found as the scene's files are.
fn from_file(
    params: &Params<'_>,
    build: &mut dyn Build,
    name: &str,
    part: &str,
) -> Option<Spectrum> {
    let path = file(name, part);
    let refuse = |message: String, help: String| {
        let mut error = Diagnostic::error(
            params
                .node
                .properties
                .iter()
                .find(|p| p.name == "material")
                .map_or(params.node.plugin.span, |p| p.span),
            message,
        );
        error = error.help(help);
        params.diagnostics.push(error);
        None
    };
    let bytes = match build.assets().bytes(&path) {
        Ok(bytes) => bytes,
        Err(_) => {
            let near = etalon_params::suggest::nearest(name, conductors::names())
                .map(|near| format!("did you mean `{near}`? Otherwise "))
                .unwrap_or_default();
            return refuse(
                format!("no data for the conductor `{name}`"),
                format!(
                    "{near}put `{name}.eta.spd` and `{name}.k.spd` beside the scene, point \
                     `--data DIR` at the `data/ior` of an installed Mitsuba, or give `eta` and `k`"
                ),
            );
        }
    };
    let parsed = String::from_utf8(bytes.to_vec())
        .map_err(|_| "it is not text".to_owned())
        .and_then(|text| {
            parse_spd(&text).map_err(|(line, message)| format!("line {line}: {message}"))
        })
        .and_then(|(wavelengths, values)| {
            Spectrum::tabulated(&wavelengths, &values).map_err(|error| error.to_string())
        });
    match parsed {
        Ok(spectrum) => Some(spectrum),
        Err(message) => refuse(
            format!("`{path}` cannot be read: {message}"),
            "expected lines of a wavelength in nm and a value".to_owned(),
        ),
    }
}
