//! `etalon info`.

mod scene;

use super::fireflies::Fireflies;
use super::{answer, fail, plugins};
use crate::args::InfoArgs;
use etalon_film::{InvalidKind, InvalidSample, LightCarriers, RenderedImage, read_developed};
use etalon_images::{Channel, Error, raster_file};
use etalon_sampling::ReplicateKind;
use std::path::Path;
use std::process::ExitCode;

/// Says what is in a scene or an image.
pub fn run(args: &InfoArgs) -> ExitCode {
    let Some(file) = &args.file else {
        return plugins::run(args.plugins.as_deref().unwrap_or_default());
    };
    let extension = file.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        _ if etalon_render::pipeline::is_scene(file) => scene::run(file, args.json),
        Some("exr" | "checkpoint") => match read_developed(file) {
            Ok(developed) if args.json => answer(&as_json(&developed), ExitCode::SUCCESS),
            Ok(developed) => answer(&image(&developed), ExitCode::SUCCESS),
            Err(error) => fail(error),
        },
        _ if args.json => fail(
            "`--json` tells of scenes (.xml, .pbrt, .gltf, .glb), images (.exr) and checkpoints (.checkpoint)",
        ),
        _ => match contents(file) {
            Some(Ok(text)) => answer(&text, ExitCode::SUCCESS),
            Some(Err(reason)) => fail(format!("{}: {reason}", file.display())),
            None => match picture(file) {
                Ok(text) => answer(&text, ExitCode::SUCCESS),
                Err(error) => fail(format!(
                    "neither a scene (.xml, .pbrt, .gltf, .glb) nor an image: {error}"
                )),
            },
        },
    }
}

/// What a file other than a picture holds; `None` if it is none that scenes name, or cannot be read.
fn contents(path: &Path) -> Option<Result<String, String>> {
    etalon_scene::describe(&std::fs::read(path).ok()?)
}

/// What a picture of any other format says of itself.
fn picture(path: &Path) -> Result<String, Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::Read {
        path: path.to_owned(),
        source,
    })?;
    let header = raster_file::decode_header(&bytes, path)?;
    let mut text = format!(
        "{} × {} pixels\n{}, {} channels of {} bits\n",
        header.width, header.height, header.format, header.channels, header.bits
    );
    for note in raster_file::decode(&bytes, path)?.notes(false) {
        text += &format!("note         {note}\n");
    }
    Ok(text)
}

/// The mean of a channel, and how many of its samples are not finite.
fn mean_of(channel: &Channel) -> (f64, usize) {
    let finite = channel.samples.iter().filter(|v| v.is_finite()).count();
    let mean = channel.samples.iter().map(|v| f64::from(*v)).sum::<f64>()
        / channel.samples.len().max(1) as f64;
    (mean, channel.samples.len() - finite)
}

/// An image for programs.
fn as_json(developed: &RenderedImage) -> String {
    let image = &developed.image;
    let channels: Vec<_> = (image.channels().iter())
        .map(|channel| {
            let (mean, not_finite) = mean_of(channel);
            serde_json::json!({ "name": channel.name, "mean": mean, "not_finite": not_finite })
        })
        .collect();
    let facts = serde_json::json!({
        "width": image.width(),
        "height": image.height(),
        "channels": channels,
        "mean_relative_standard_error": developed.mean_relative_standard_error(),
        "metadata": developed.metadata,
    });
    format!("{facts:#}\n")
}

fn image(developed: &RenderedImage) -> String {
    let image = &developed.image;
    let mut text = format!("{} × {} pixels\n", image.width(), image.height());
    for channel in image.channels() {
        let (mean, not_finite) = mean_of(channel);
        text += &format!("  {:<20} mean {mean:.6}", channel.name);
        if not_finite > 0 {
            text += &format!(", {not_finite} not finite");
        }
        text.push('\n');
    }
    if let Some(primaries) = image.chromaticities() {
        text += &format!("chromaticities {primaries}\n");
    }
    let Some(m) = &developed.metadata else {
        for note in image.colour().iter().flat_map(|colour| &colour.notes) {
            text += &format!("note         {note}\n");
        }
        text += "no metadata of Etalon\n";
        return text;
    };
    text += &format!("scene        {} ({})\n", m.scene, m.scene_hash);
    text += &format!("integrator   {}\n", m.integrator);
    text += &format!(
        "samples      {} per pixel, {} replicates, {}, seed {}\n",
        m.spp, m.replicates, m.sampler, m.seed
    );
    if m.replicate_kind == ReplicateKind::Blocks && m.replicates > 1 {
        text += "replicates   blocks of one sequence: standard errors are upper estimates\n";
    }
    if let Some(part) = &m.part {
        text += &match &m.checkpoint {
            Some(_) => format!(
                "checkpoint   {} of {} replicates are finished; `etalon render --resume` continues from them, \
                 `etalon merge` takes them\n",
                part.replicates.count(),
                part.of
            ),
            None => format!(
                "part         the replicates {} of 0 to {}, with exact sums for `etalon merge`\n",
                part.replicates,
                part.of.saturating_sub(1)
            ),
        };
    }
    if let Some(begun) = &m.unfinished {
        let what = match m.replicates {
            0 => "the picture is of the first replicate, which",
            _ => "another replicate",
        };
        text += &format!(
            "interrupted  {what} has {} to {} of {} samples per pixel, {:.1} on average\n",
            begun.least, begun.most, begun.samples_per_replicate, begun.mean
        );
    }
    if let Some(dealt) = &m.adaptive {
        text += &format!(
            "dealt        {} to {} to a pixel of a replicate, {:.2} on average, by a pilot of {} samples \
             per pixel\n",
            dealt.least, dealt.most, dealt.mean, dealt.pilot
        );
    }
    if let Some(features) = m.features {
        text += &format!(
            "features     of {} samples per pixel, and the first half of the replicates, for `etalon denoise`\n",
            features.spp
        );
    }
    if let Some(method) = &m.denoised {
        text += &format!(
            "denoised     {method}: biased, with standard errors that are the denoiser's estimates\n"
        );
    }
    text += &format!("film         {}, {}\n", m.film.pixel_format, m.film.filter);
    if let Some(seconds) = m.seconds {
        text += &format!("time         {seconds:.2} s\n");
    }
    if let Some(error) = developed.mean_relative_standard_error() {
        text += &format!(
            "noise        {:.2} % mean relative standard error\n",
            100.0 * error
        );
    }
    if m.unlit_pixels > 0 {
        text += &format!(
            "unlit        {} pixels in which no sample found light: their standard error of 0 says nothing\n",
            m.unlit_pixels
        );
    }
    if let Some(warning) = LightCarriers::of(developed).and_then(LightCarriers::warning) {
        text += &format!("few samples  {warning}\n");
    }
    text += &format!("version      {} ({})\n", m.version, m.floating_point);
    if m.faults.total() > 0 {
        text += &format!("not finite   {} contributions, such as\n", m.faults.total());
        text.extend(m.faults.first.iter().map(offence));
    }
    let fireflies = Fireflies::of(developed, m).filter(|found| found.count > 0);
    if let Some(found) = fireflies {
        text += &format!("fireflies    {}, the largest of them\n", found.count);
        text.extend(found.largest().map(|outlier| {
            let ([x, y], replicate, sample) = (outlier.pixel, outlier.replicate, outlier.sample);
            format!(
                "  pixel ({x}, {y}), replicate {replicate}, sample {sample}: lifts its pixel by {:.3} \
                 (`--replay {x},{y},{replicate},{sample}`)\n",
                found.lift(outlier)
            )
        }));
    }
    text
}

/// Where a number that was refused came from.
fn offence(offence: &InvalidSample) -> String {
    let InvalidSample {
        replicate,
        pixel: [x, y],
        source,
        ..
    } = offence;
    let kind = match offence.kind {
        InvalidKind::Nan => "not a number",
        InvalidKind::Infinite => "infinite",
        InvalidKind::Overflow => "out of range",
    };
    // With the options of the render, this draws the sample again.
    let (sample, replay) = offence.sample.map_or_else(Default::default, |sample| {
        let replay = format!(" (`--replay {x},{y},{replicate},{sample}`)");
        (format!(", sample {sample}"), replay)
    });
    format!("  pixel ({x}, {y}), replicate {replicate}{sample}: {source} is {kind}{replay}\n")
}
