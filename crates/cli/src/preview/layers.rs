//! The layers of an image that can be looked at: its colour, and every group of channels beside it.

use crate::commands::convert;
use etalon_film::{RenderedImage, SAMPLES, STANDARD_ERROR, read_developed};
use etalon_images::Image;
use std::borrow::Cow;
use std::path::Path;

/// What the colour of the picture itself is called.
const COLOUR: &str = "colour";

/// Three planes, and their standard errors if there are any.
#[derive(Debug)]
pub(super) struct Planes {
    /// Width and height (pixels).
    pub size: [usize; 2],
    /// The planes one after the other: red, green, blue, then their standard errors, which may be missing.
    pub values: Vec<f32>,
}

/// Reads a file that can be shown.
///
/// # Errors
/// One sentence.
pub(super) fn read(path: &Path) -> Result<RenderedImage, String> {
    if path
        .extension()
        .is_some_and(|kind| kind.eq_ignore_ascii_case("exr"))
    {
        return read_developed(path).map_err(|error| error.to_string());
    }
    let (image, _, _) = convert::read(path)?;
    Ok(RenderedImage {
        frame: etalon_images::Frame {
            offset: [0, 0],
            size: [image.width(), image.height()],
        },
        image,
        metadata: None,
    })
}

/// Reads a file that has something to show.
///
/// # Errors
/// One sentence, also for an image without colours or channels to show.
pub fn shown(path: &Path) -> Result<RenderedImage, String> {
    let picture = read(path)?;
    match names(&picture.image).is_empty() {
        true => Err(format!(
            "{}: there is nothing to look at in it",
            path.display()
        )),
        false => Ok(picture),
    }
}

/// The layers of an image, its colour first.
pub(super) fn names(image: &Image) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut of_colour: &[&str] = &[];
    if image.colour().is_some() {
        names.push(COLOUR.to_owned());
        of_colour = &["R", "G", "B", "X", "Y", "Z", "A"];
    }
    for channel in image.channels() {
        let name = channel.name.as_str();
        if of_colour.contains(&name) || name.starts_with(STANDARD_ERROR) || name == SAMPLES {
            continue;
        }
        let layer = match name.rsplit_once('.') {
            Some((layer, letter)) if letter.len() == 1 => layer,
            _ => name,
        };
        if !names.iter().any(|known| known == layer) && planes(image, layer).is_some() {
            names.push(layer.to_owned());
        }
    }
    names
}

/// The planes of a layer.
pub(super) fn planes(image: &Image, layer: &str) -> Option<Planes> {
    let size = [image.width(), image.height()];
    if layer != COLOUR {
        let chosen = convert::chosen(image, layer).ok()?;
        let colour = ["R", "G", "B"].map(|name| chosen.channel(name).unwrap_or_default());
        let values = colour.concat();
        return Some(Planes { size, values });
    }
    let mut values = image.colour()?.planes.concat();
    if let Some(errors) = errors(image) {
        values.extend(errors.iter().flat_map(|plane| plane.iter()));
    }
    Some(Planes { size, values })
}

/// The standard errors of red, green and blue, or of the luminance, if it is what there is.
fn errors(image: &Image) -> Option<[Cow<'_, [f32]>; 3]> {
    let of = |name: &str| {
        image.channel(name)?;
        image.channel(&format!("{STANDARD_ERROR}{name}"))
    };
    match ["R", "G", "B"].map(of) {
        [Some(r), Some(g), Some(b)] => Some([r, g, b].map(Cow::Borrowed)),
        _ if image.channel("X").is_none() => of("Y").map(|y| [y, y, y].map(Cow::Borrowed)),
        _ => None,
    }
}
