//! Reading the complex refractive index of a conductor: by name, or as `eta` and `k`.

use crate::TextureSite;
use crate::interface::relative_index::{held_table, number_from_params};
use crate::lane_bsdf_at_point::spectra;
use etalon_math::lane::Lane;
use etalon_params::{Diagnostic, ParameterKind, Params, Property, Value};
use etalon_spectrum::{Spectrum, conductor_colour, conductors, parse_spd};
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};

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
    /// defaults are the perfect mirror too and which belong together where they are colours (see
    /// [`conductor_colour`]); and `ext_eta`, a number or a name (vacuum), by which
    /// both are divided.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let exterior = number_from_params(params, "ext_eta", "vacuum");
        Self::within(params, build, exterior?)
    }

    /// The same without `ext_eta`, where what is outside is known.
    pub(crate) fn within(
        params: &Params<'_>,
        build: &mut dyn Build,
        exterior: f64,
    ) -> Option<Self> {
        let inverse_exterior = (1.0 / exterior) as f32;
        params.note_default("material", ParameterKind::String, "none");
        let name = params.string("material").unwrap_or("none");
        if name == "none" {
            let [eta, k] = match of_colours(params) {
                Some((eta, k)) => [build.spectrum(eta), build.spectrum(k)],
                None => [("eta", 0.0), ("k", 1.0)].map(|(name, default)| {
                    build.texture(params, name, Some(default), SpectrumKind::Index)
                }),
            };
            return Some(Self {
                eta,
                k,
                inverse_exterior,
            });
        }
        if params.has("eta") || params.has("k") {
            params.error_at("material", "give either `material` or `eta` and `k`");
            params.ignore(&["eta", "k"]);
            return None;
        }
        // Files in the search path take precedence over built-in data of the same name.
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

    /// η and k at several points relative to the outside, per wavelength.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> [F::Spectrum; 2] {
        let inverse_exterior = F::from_fn(|i| at(i).0.inverse_exterior);
        [
            spectra::<F, _, T>(&at, |metal| metal.eta) * inverse_exterior,
            spectra::<F, _, T>(&at, |metal| metal.k) * inverse_exterior,
        ]
    }
}

/// `eta` and `k` where one of them is a colour and the other a colour or a number.
fn of_colours(params: &Params<'_>) -> Option<(Spectrum, Spectrum)> {
    let find = |name| params.node.property(name);
    let triple = |property: Option<&Property>, default| match property.map(|p| &p.value) {
        None => Some([default; 3]),
        Some(Value::Float(x)) => Some([*x; 3]),
        Some(Value::Integer(i)) => Some([*i as f64; 3]),
        Some(Value::Rgb(rgb)) => Some(rgb.to_array()),
        Some(_) => None,
    };
    let given = [find("eta"), find("k")];
    let mut colours = given
        .into_iter()
        .flatten()
        .filter(|p| matches!(p.value, Value::Rgb(_)));
    let span = colours.next()?.span;
    let (eta, k) = (triple(given[0], 0.0)?, triple(given[1], 1.0)?);
    let made = match conductor_colour::metal(eta, k) {
        Some(name) => {
            let message = format!(
                "`eta` and `k` are the colours of the metal `{name}`: its measured curves are taken"
            );
            let help = format!("`material` `{name}` says the same");
            params
                .diagnostics
                .push(Diagnostic::note(span, message).help(help));
            conductors::lookup(name)?
        }
        // The error is reported where the two are read individually.
        None => conductor_colour::smooth(eta, k).ok()?,
    };
    given.into_iter().flatten().for_each(Property::mark_used);
    Some(made)
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
    let material = params.node.property("material");
    let span = material.map_or(params.node.plugin.span, |p| p.span);
    let refuse = |message: String, help: String| {
        let error = Diagnostic::error(span, message).help(help);
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
        });
    match parsed {
        Ok(table) => {
            if let Some(line) = table.header {
                let message =
                    format!("line {line} of `{path}` holds no number: it is taken for a header");
                params.diagnostics.push(Diagnostic::note(span, message));
            }
            let samples = table.wavelengths.into_iter().zip(table.values);
            held_table(params, span, &samples.collect::<Vec<_>>())
        }
        Err(message) => refuse(
            format!("`{path}` cannot be read: {message}"),
            "expected lines of a wavelength in nm and a value".to_owned(),
        ),
    }
}
