//! `etalon convert`.

use super::{fail, note};
use crate::args::ConvertArgs;
use etalon_images::raster::Raster;
use etalon_images::{Image, Losses, exr, hdr, pfm, png, raster};
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
    if !args.exposure.is_finite() {
        return Err("--exposure must be a finite number of stops".to_owned());
    }
    let mut image = read(&args.input)?;
    if let Some(prefix) = &args.channels {
        image = chosen(&image, prefix)?;
    }
    let losses = match extension(&args.output).as_str() {
        "png" => png::write(&args.output, &image, args.exposure),
        "hdr" | "rgbe" => hdr::write(&args.output, &brightened(image, args.exposure)),
        "pfm" => {
            let image = brightened(image, args.exposure);
            pfm::write(&args.output, &image).map(|()| Losses::default())
        }
        _ => {
            return Err(format!(
                "cannot write `{}`: the name must end in .png, .hdr or .pfm",
                args.output.display()
            ));
        }
    }
    .map_err(|error| error.to_string())?;
    Ok(losses_in_words(&losses))
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

fn read(path: &Path) -> Result<Image, String> {
    match extension(path).as_str() {
        "exr" => {
            let document = exr::read(path).map_err(|error| error.to_string())?;
            Ok(document.flatten().0)
        }
        "hdr" | "rgbe" | "pfm" => {
            let raster = raster::read(path).map_err(|error| error.to_string())?;
            Ok(planes(&raster))
        }
        _ => Err(format!(
            "cannot read `{}`: the name must end in .exr, .hdr or .pfm",
            path.display()
        )),
    }
}

/// The planes of a picture of floats, by their usual names.
fn planes(raster: &Raster) -> Image {
    let names: &[&str] = match raster.channels() {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    };
    let values = raster.to_linear();
    let mut image = Image::new(raster.width(), raster.height());
    for (index, name) in names.iter().enumerate() {
        let plane = values.iter().skip(index).step_by(names.len()).copied();
        image.push(*name, plane.collect());
    }
    image
}

/// The image made of the channels that begin with `prefix`.
fn chosen(image: &Image, prefix: &str) -> Result<Image, String> {
    let sets: [&[&str]; 5] = [
        &["R", "G", "B"],
        &["X", "Y", "Z"],
        &["U", "V"],
        &["T"],
        &["I"],
    ];
    for names in sets {
        let found: Vec<&[f32]> = names
            .iter()
            .filter_map(|name| image.channel(&format!("{prefix}.{name}")))
            .collect();
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
        "there are no channels `{prefix}.R`, … in the image; it has {}",
        names.join(", ")
    ))
}

fn brightened(image: Image, exposure: f32) -> Image {
    let factor = etalon_math::float::pow(2.0, exposure);
    let mut bright = Image::new(image.width(), image.height());
    for channel in image.into_channels() {
        let factor = if channel.name == "A" { 1.0 } else { factor };
        let samples = channel.samples.iter().map(|v| v * factor).collect();
        bright.push(channel.name, samples);
    }
    bright
}
