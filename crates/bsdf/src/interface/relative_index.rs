//! Reading refractive indices.
//!
//! `int_ior` and `ext_ior` are a number or the name of a dielectric, as in Mitsuba. Where a
//! model can disperse they may also be a spectrum, or Cauchy's or Sellmeier's coefficients as a
//! string (an extension: see `docs/extensions.md`).

use etalon_params::{
    Class, Diagnostic, ParameterKind, Params, Property, Span, SpectrumText, Value,
};
use etalon_spectrum::{
    LAMBDA_MAX, LAMBDA_MIN, RefractiveIndex, Spectrum, SpectrumError, refractive_index,
};
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};
use glam::Vec4;

use crate::TextureSite;

/// The index inside over the index outside.
#[derive(Clone, Debug)]
pub enum RelativeIndex {
    /// The same at every wavelength.
    Constant(f32),
    /// A function of the wavelength.
    Dispersive {
        /// Inside: the side away from the normal.
        interior: Index,
        /// Outside.
        exterior: Index,
    },
}

/// One medium's index.
#[derive(Clone, Debug)]
pub enum Index {
    /// A number, a formula or a table.
    Formula(RefractiveIndex),
    /// A nested spectrum.
    Texture(TextureId),
}

impl Index {
    fn eval<T: Textures>(&self, site: &TextureSite<'_, T>) -> Vec4 {
        match self {
            Self::Formula(index) => index.eval(site.lambda),
            Self::Texture(texture) => site.spectrum(*texture),
        }
    }
}

impl RelativeIndex {
    /// Reads `int_ior` (a name by default) and `ext_ior` (air by default).
    pub fn from_params(
        params: &Params<'_>,
        build: &mut dyn Build,
        default_interior: &str,
    ) -> Option<Self> {
        let interior = read(params, build, "int_ior", default_interior);
        let exterior = read(params, build, "ext_ior", "air");
        Some(match (interior?, exterior?) {
            (Given::Number(interior), Given::Number(exterior)) => {
                Self::Constant((interior / exterior) as f32)
            }
            (interior, exterior) => Self::Dispersive {
                interior: interior.into_index(),
                exterior: exterior.into_index(),
            },
        })
    }

    /// The same for a model that has one index for all wavelengths, as f64.
    pub fn constant_from_params(params: &Params<'_>, default_interior: &str) -> Option<f64> {
        let interior = number_from_params(params, "int_ior", default_interior);
        let exterior = number_from_params(params, "ext_ior", "air");
        Some(interior? / exterior?)
    }

    /// The index at a point, per lane. Where a nested spectrum gives none (it is zero beyond its
    /// table) the interface is taken to be absent: 1.
    #[inline]
    pub fn eval<T: Textures>(&self, site: &TextureSite<'_, T>) -> Vec4 {
        match self {
            Self::Constant(eta) => Vec4::splat(*eta),
            Self::Dispersive { interior, exterior } => {
                let eta = interior.eval(site) / exterior.eval(site);
                let given = eta.cmpgt(Vec4::ZERO) & eta.cmplt(Vec4::INFINITY);
                Vec4::select(given, eta, Vec4::ONE)
            }
        }
    }
}

/// The value of a property.
enum Given {
    Number(f64),
    Index(Index),
}

impl Given {
    fn into_index(self) -> Index {
        match self {
            Self::Number(value) => Index::Formula(RefractiveIndex::Constant(value as f32)),
            Self::Index(index) => index,
        }
    }
}

const ACCEPTED: &str = "a number above 0, the name of a dielectric, `cauchy: A B [C]`, \
                        `sellmeier: B1 B2 B3 C1 C2 C3` (µm) or `sellmeier: NAME`, or a spectrum";

fn named(name: &str) -> Option<f64> {
    refractive_index::lookup(name.trim())
}

fn positive(params: &Params<'_>, name: &str, value: f64) -> Option<f64> {
    if value > 0.0 && value.is_finite() {
        return Some(value);
    }
    params.refuse(name, value, "a number above 0");
    None
}

fn unknown_name(params: &Params<'_>, property: &Property, word: &str) {
    let message = format!("no refractive index is known for `{word}`");
    let error = Diagnostic::error(property.span, message);
    // A glass of a catalogue, such as `sf11`, is known with its dispersion only.
    let asked = word.to_lowercase();
    let glass = refractive_index::dispersive_names()
        .find(|name| *name == asked || name.strip_prefix("n-") == Some(&asked));
    params.diagnostics.push(match glass {
        Some(glass) => error.help(format!(
            "it is known with its dispersion: `sellmeier: {glass}`"
        )),
        None => error.suggest(word, refractive_index::names()),
    });
}

/// One index for all wavelengths: a number or a name; `default` is a name.
pub fn number_from_params(params: &Params<'_>, name: &str, default: &str) -> Option<f64> {
    params.note_default(name, ParameterKind::Words("a number or a name"), default);
    let Some(property) = params.property(name) else {
        return named(default);
    };
    match &property.value {
        Value::Float(value) => positive(params, name, *value),
        Value::Integer(value) => positive(params, name, *value as f64),
        Value::String(word) => {
            let found = named(word);
            if found.is_none() {
                unknown_name(params, property, word);
            }
            found
        }
        other => {
            params.diagnostics.push(
                Diagnostic::error(
                    property.span,
                    format!(
                        "`{name}` of `{}` is one index for all wavelengths: a number or a name, \
                         not {}",
                        params.node.plugin.value,
                        other.kind()
                    ),
                )
                .help("`dielectric` and `roughdielectric` can disperse"),
            );
            None
        }
    }
}

/// A number, a name, a formula or a spectrum.
fn read(params: &Params<'_>, build: &mut dyn Build, name: &str, default: &str) -> Option<Given> {
    params.note_default(
        name,
        ParameterKind::Words("a number, a name, a formula or a spectrum"),
        default,
    );
    let Some(property) = params.property(name) else {
        return named(default).map(Given::Number);
    };
    match &property.value {
        Value::String(text) if text.contains(':') => {
            formula(params, property, text).map(|index| Given::Index(Index::Formula(index)))
        }
        Value::Spectrum(SpectrumText::Uniform(value)) => {
            positive(params, name, *value).map(Given::Number)
        }
        Value::Spectrum(SpectrumText::Samples(samples)) => {
            table(params, property, samples).map(|index| Given::Index(Index::Formula(index)))
        }
        Value::Object(node) if node.class == Class::Texture => Some(Given::Index(Index::Texture(
            build.nested_texture(node, SpectrumKind::Index),
        ))),
        Value::Float(_) | Value::Integer(_) | Value::String(_) => {
            number_from_params(params, name, default).map(Given::Number)
        }
        other => {
            params.diagnostics.push(
                Diagnostic::error(
                    property.span,
                    format!("`{name}` cannot be {}", other.kind()),
                )
                .help(format!("accepted: {ACCEPTED}")),
            );
            None
        }
    }
}

/// `cauchy: A B [C]`, `sellmeier: B1 B2 B3 C1 C2 C3` or `sellmeier: NAME`.
fn formula(params: &Params<'_>, property: &Property, text: &str) -> Option<RefractiveIndex> {
    let refuse = |message: String| {
        params
            .diagnostics
            .push(Diagnostic::error(property.span, message).help(format!("accepted: {ACCEPTED}")));
        None
    };
    let (kind, numbers) = text.split_once(':')?;
    let kind = kind.trim().to_ascii_lowercase();
    // Names hold letters that no list of numbers has (`1e-3` begins with a digit).
    let name = numbers.trim();
    if kind == "sellmeier" && name.starts_with(char::is_alphabetic) {
        let index = refractive_index::dispersive(name);
        if index.is_none() {
            params.diagnostics.push(
                Diagnostic::error(
                    property.span,
                    format!("no dispersion is known for `{name}`"),
                )
                .suggest(name, refractive_index::dispersive_names()),
            );
        }
        return index;
    }
    let mut coefficients = Vec::new();
    for word in numbers
        .split([' ', ',', '\t', '\n'])
        .filter(|w| !w.is_empty())
    {
        match word.parse::<f64>() {
            Ok(value) => coefficients.push(value),
            Err(_) => return refuse(format!("`{word}` is not a number")),
        }
    }
    let index: Result<RefractiveIndex, SpectrumError> = match (kind.as_str(), &coefficients[..]) {
        ("cauchy", &[a, b]) => RefractiveIndex::cauchy(a, b, 0.0),
        ("cauchy", &[a, b, c]) => RefractiveIndex::cauchy(a, b, c),
        ("sellmeier", &[b1, b2, b3, c1, c2, c3]) => {
            RefractiveIndex::sellmeier([b1, b2, b3], [c1, c2, c3])
        }
        ("cauchy" | "sellmeier", given) => {
            return refuse(format!("`{kind}` cannot have {} coefficients", given.len()));
        }
        _ => return refuse(format!("`{kind}` is not a dispersion formula")),
    };
    match index {
        Ok(index) => {
            let mut wavelength = LAMBDA_MIN;
            while wavelength <= LAMBDA_MAX {
                let value = index.eval(Vec4::splat(wavelength as f32)).x;
                if !(value > 0.0 && value.is_finite()) {
                    return refuse(format!(
                        "with these coefficients the index at {wavelength} nm is {value}"
                    ));
                }
                wavelength += 1.0;
            }
            Some(index)
        }
        Err(error) => refuse(error.to_string()),
    }
}

/// A table of (wavelength in nm, index), each above zero.
fn table(
    params: &Params<'_>,
    property: &Property,
    samples: &[(f64, f64)],
) -> Option<RefractiveIndex> {
    for (_, value) in samples {
        positive(params, &property.name, *value)?;
    }
    held_table(params, property.span, samples).map(RefractiveIndex::Tabulated)
}

/// A table of (wavelength in nm, part of an index) that is held at its ends.
pub(crate) fn held_table(
    params: &Params<'_>,
    span: Span,
    samples: &[(f64, f64)],
) -> Option<Spectrum> {
    let (wavelengths, values): (Vec<f64>, Vec<f64>) = samples.iter().copied().unzip();
    let held = refractive_index::held_table(&wavelengths, &values);
    let held = held.map_err(|error| Diagnostic::error(span, error.to_string()));
    let (table, note) = params.diagnostics.keep(held)?;
    if let Some(note) = note {
        params.diagnostics.push(Diagnostic::note(span, note));
    }
    Some(table)
}
