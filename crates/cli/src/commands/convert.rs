//! `etalon convert`.

use super::{fail, note};
use crate::args::ConvertArgs;
use etalon_images::{
    Colour, Error, Format, Image, Losses, View, exr, hdr, pfm, png, raster_file, srgb, view,
};
use etalon_render::write_guard::WriteGuard;
use std::path::Path;
use std::process::ExitCode;

/// Turns an image into a picture, or into another format.
pub fn run(args: &ConvertArgs) -> ExitCode {
    match convert(args) {
        Ok(notes) => {
            notes.iter().for_each(note);
            ExitCode::SUCCESS
        }
        Err(message) => fail(message),
    }
}

fn convert(args: &ConvertArgs) -> Result<Vec<String>, String> {
    let development = args.shown.development()?;
    let exposure = development.exposure;
    let output = WriteGuard::of([&args.input]).claim(&args.output)?;
    let in_words = |error: Error| error.to_string();
    let (image, mut notes, text) = read(&args.input)?;
    let colour = match &args.channels {
        Some(prefix) => chosen(&image, prefix)?,
        None => {
            let colour = image.needed_colour(&args.input).map_err(in_words)?;
            // In our own files the picture has no layer, and what else there is was asked for.
            notes.extend(colour.notes.iter().filter(|_| text.is_empty()).cloned());
            of_colour(&image, &colour)
        }
    };
    let is_png = extension(&args.output) == "png";
    let colour = match args.range {
        Some(range) => ranged(colour, range, is_png),
        None => colour,
    };
    if !is_png && development.view != View::Srgb {
        return Err("--view shows pictures on a screen: only a .png can have it".to_owned());
    }
    let losses = match extension(&args.output).as_str() {
        "png" => output.write_with(|path| png::write(path, &colour, development)),
        "hdr" | "rgbe" => {
            let image = brightened(colour, exposure, &mut notes);
            output.write_with(|path| hdr::write(path, &image))
        }
        "pfm" => {
            let image = brightened(colour, exposure, &mut notes);
            output.write_with(|path| pfm::write(path, &image).map(|()| Losses::default()))
        }
        _ => {
            return Err(format!(
                "cannot write `{}`: the name must end in .png, .hdr or .pfm",
                args.output.display()
            ));
        }
    }?;
    let input = args.input.display();
    let notes = notes.iter().map(|note| format!("`{input}`: {note}"));
    Ok(notes.chain(losses_in_words(&losses)).collect())
}

/// What a simpler format could not hold, for people.
pub(super) fn losses_in_words(losses: &Losses) -> Vec<String> {
    let kinds = [
        (losses.negative, "are negative and became 0"),
        (losses.too_bright, "are brighter than the format's white"),
        (losses.not_finite, "are not finite"),
    ];
    let notes = kinds.into_iter().filter(|(count, _)| *count > 0);
    notes
        .map(|(count, what)| format!("{count} samples {what}"))
        .collect()
}

fn extension(path: &Path) -> String {
    path.extension()
        .map(|e| e.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

/// The image in a file, remarks about it, and its metadata, which are empty if it is not our own.
pub(crate) fn read(path: &Path) -> Result<(Image, Vec<String>, String), String> {
    let read = || {
        let bytes = std::fs::read(path).map_err(|source| Error::Read {
            path: path.to_owned(),
            source,
        })?;
        if Format::of(&bytes) == Some(Format::Exr) {
            let document = exr::decode(&bytes, path)?;
            let text = document.text.clone();
            return Ok((document.flatten().0, Vec::new(), text));
        }
        let raster = raster_file::decode(&bytes, path)?;
        let notes = raster.notes(false).map(str::to_owned).collect();
        Ok((raster.to_image(), notes, String::new()))
    };
    read().map_err(|error: Error| error.to_string())
}

/// The image of a colour alone, in linear Rec. 709.
pub(super) fn of_colour(image: &Image, colour: &Colour<'_>) -> Image {
    let mut picture = Image::new(image.width(), image.height());
    for (name, plane) in ["R", "G", "B"].into_iter().zip(&colour.planes) {
        picture.push(name, plane.to_vec());
    }
    if let Some(alpha) = colour.alpha {
        picture.push("A", alpha.to_vec());
    }
    picture
}

/// The image made of the channels that begin with `prefix`, or of the one that is called so.
pub(crate) fn chosen(image: &Image, prefix: &str) -> Result<Image, String> {
    if let Some(colour) = image.colour_of_layer(prefix) {
        let opaque = Colour {
            alpha: None,
            ..colour
        };
        return Ok(of_colour(image, &opaque));
    }
    let sets: [&[&str]; 5] = [&[""], &["X", "Y", "Z"], &["U", "V"], &["T"], &["I"]];
    for names in sets {
        let whole = |name: &&str| match *name {
            "" => prefix.to_owned(),
            letter => format!("{prefix}.{letter}"),
        };
        let channels = names.iter().map(whole);
        let found: Vec<&[f32]> = channels.filter_map(|name| image.channel(&name)).collect();
        if found.len() == names.len() {
            let mut chosen = Image::new(image.width(), image.height());
            for (position, name) in ["R", "G", "B"].into_iter().enumerate() {
                let samples = match (found.get(position), found.len()) {
                    (Some(samples), _) => samples.to_vec(),
                    (None, 1) => found[0].to_vec(),
                    (None, _) => vec![0.0; image.width() * image.height()],
                };
                chosen.push(name, samples);
            }
            return Ok(chosen);
        }
    }
    let names: Vec<&str> = image.channels().iter().map(|c| c.name.as_str()).collect();
    Err(format!(
        "there are no channels `{prefix}.R`, … in the image, nor one called `{prefix}`; it has {}",
        names.join(", ")
    ))
}

/// The image with A as 0 and B as 1; of a PNG, such that its numbers are in proportion although they are encoded.
fn ranged(mut image: Image, [a, b]: [f64; 2], is_png: bool) -> Image {
    for name in ["R", "G", "B"] {
        for sample in image.channel_mut(name).into_iter().flatten() {
            let part = ((f64::from(*sample) - a) / (b - a)) as f32;
            *sample = if is_png { srgb::decode(part) } else { part };
        }
    }
    image
}

fn brightened(mut image: Image, exposure: f32, notes: &mut Vec<String>) -> Image {
    let gain = view::gain(exposure);
    let mut infinite = 0;
    for name in ["R", "G", "B"] {
        let samples = image.channel_mut(name).into_iter().flatten();
        for sample in samples {
            // In double precision, so that no finite gain makes black something else than black.
            let bright = (f64::from(*sample) * gain) as f32;
            infinite += usize::from(sample.is_finite() && bright.is_infinite());
            *sample = bright;
        }
    }
    if infinite > 0 {
        notes.push(format!(
            "{infinite} samples are beyond 32-bit floats after the exposure, and became infinite"
        ));
    }
    image
}
