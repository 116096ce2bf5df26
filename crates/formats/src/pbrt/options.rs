//! `Option` directives.

use super::number::{self, excerpt};
use super::reader::Reader;
use super::statement::Statement;
use etalon_params::{Diagnostic, Spanned};

/// The options that change pictures, each with its place if it is given.
///
/// Missing here are those that say how pbrt works rather than what it renders, and which are ignored: `msereferenceimage`,
/// `msereferenceout` and `pixelstats` ask for further files, `rendercoordsys` and `wavefront` choose between ways of computing the
/// same picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Whether all samples of a pixel lie in its centre.
    pub disable_pixel_jitter: Option<Spanned<bool>>,
    /// Whether textures are looked up at points.
    pub disable_texture_filtering: Option<Spanned<bool>>,
    /// Whether all samples have the same wavelengths.
    pub disable_wavelength_jitter: Option<Spanned<bool>>,
    /// A factor for the edge lengths of displaced meshes.
    pub displacement_edge_scale: Option<Spanned<f64>>,
    /// Whether all materials are diffuse.
    pub force_diffuse: Option<Spanned<bool>>,
    /// The seed of the random numbers.
    pub seed: Option<Spanned<i32>>,
}

/// All options, as they are called without hyphens, underscores and capitals.
const NAMES: [&str; 11] = [
    "disablepixeljitter",
    "disabletexturefiltering",
    "disablewavelengthjitter",
    "displacementedgescale",
    "forcediffuse",
    "msereferenceimage",
    "msereferenceout",
    "pixelstats",
    "rendercoordsys",
    "seed",
    "wavefront",
];

/// Of an option that is given twice, the later one counts, as in pbrt.
pub(crate) fn option(reader: &mut Reader<'_>, statement: Statement) {
    let (name, value) = (statement.name(0), statement.name(1));
    let plain: String = name
        .value
        .chars()
        .filter(|c| !matches!(c, '-' | '_'))
        .map(|c| c.to_ascii_lowercase())
        .collect();
    let options = &mut reader.scene_options;
    let set = match plain.as_str() {
        "disablepixeljitter" => set(&mut options.disable_pixel_jitter, &value, boolean),
        "disabletexturefiltering" => set(&mut options.disable_texture_filtering, &value, boolean),
        "disablewavelengthjitter" => set(&mut options.disable_wavelength_jitter, &value, boolean),
        "displacementedgescale" => set(&mut options.displacement_edge_scale, &value, float),
        "forcediffuse" => set(&mut options.force_diffuse, &value, boolean),
        "seed" => set(&mut options.seed, &value, integer),
        "pixelstats" | "wavefront" => boolean(&value.value).map(|_| ()),
        "rendercoordsys" => match value.value.as_str() {
            "camera" | "cameraworld" | "world" => Ok(()),
            _ => Err("camera, cameraworld, world"),
        },
        "msereferenceimage" | "msereferenceout" => Ok(()),
        _ => {
            let message = format!("there is no option `{}`", excerpt(&name.value));
            let mistake = Diagnostic::error(name.span, message);
            reader.report(mistake.suggest(&plain, NAMES));
            return;
        }
    };
    if let Err(accepted) = set {
        let value_shown = excerpt(&value.value);
        let message = format!("`{value_shown}` is not a value of the option `{plain}`");
        let mistake = Diagnostic::error(value.span, message);
        reader.report(mistake.help(format!("accepted: {accepted}")));
    }
}

fn set<T>(
    option: &mut Option<Spanned<T>>,
    value: &Spanned<String>,
    read: impl Fn(&str) -> Result<T, &'static str>,
) -> Result<(), &'static str> {
    *option = Some(Spanned {
        value: read(&value.value)?,
        span: value.span,
    });
    Ok(())
}

fn boolean(text: &str) -> Result<bool, &'static str> {
    match text {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err("true, false"),
    }
}

fn float(text: &str) -> Result<f64, &'static str> {
    let number = number::float(text.as_bytes());
    let whole = number.filter(|(_, length)| *length == text.len());
    whole.map(|(value, _)| value).ok_or("a number")
}

fn integer(text: &str) -> Result<i32, &'static str> {
    let number = number::integer(text.as_bytes());
    let whole = number.filter(|(_, length)| *length == text.len());
    whole.map(|(value, _)| value).ok_or("an integer")
}
