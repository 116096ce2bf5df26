//! What `render` leaves behind: the image, the statistics, and a few lines on how it went.

use super::convert::losses_in_words;
use super::fireflies::{Again, Fireflies, faults_to_json, fireflies_to_json};
use super::{note, sample_budget};
use crate::args::RenderArgs;
use crate::say;
use etalon_film::{LightCarriers, Metadata, RenderedImage, UnfinishedFacts, light_carriers};
use etalon_images::{Losses, hdr, pfm, png, write_atomically};
use etalon_integrators::RenderPlan;
use etalon_render::pipeline::{Loaded, Rendered};
use etalon_render::resources;
use etalon_render::target::Noise;
use etalon_transport::{Camera, Surfaces, World};
use std::io::Write;
use std::path::Path;

/// Writes the image and the statistics, and says how it went.
pub(super) fn deliver(
    args: &RenderArgs,
    loaded: &Loaded,
    rendered: &Rendered,
    plan: &RenderPlan,
    pilot: Option<(u32, f64)>,
) -> Result<(), String> {
    let metadata = rendered.developed.metadata.as_ref();
    let losses = match &rendered.part {
        Some(part) => part
            .write_exr(args.output())
            .map(|()| Losses::default())
            .map_err(|error| error.to_string()),
        None => write_image(args.output(), &rendered.developed),
    }?;
    if !args.quiet {
        losses_in_words(&losses).iter().for_each(note);
    }
    if let Some(picture) = args.outputs.as_ref().and_then(|o| o.picture.as_deref()) {
        write_picture(args, picture, &rendered.developed)?;
    }
    if let Some(facts) = metadata.and_then(|m| m.unfinished.as_ref()) {
        say::remark(&unfinished_in_words(args, facts));
    }
    let dealt = metadata.and_then(|m| m.adaptive.as_ref());
    let again = Again {
        args,
        plan,
        pilot: dealt.map(|dealt| dealt.pilot),
    };
    if let Some(path) = &args.stats {
        let text = format!("{:#}\n", stats(&again, loaded, rendered, pilot));
        write_atomically(path, |file| file.write_all(text.as_bytes()))
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    if let Some(metadata) = &rendered.developed.metadata {
        tell_trouble(args, &rendered.developed, metadata, &again);
    }
    if let Some(aim) = args.error {
        match relative_error(rendered) {
            Some(error) if error <= aim && !args.quiet => say::remark(&format!(
                "relative standard error {:.3} %, of {} % aimed at\n",
                100.0 * error,
                100.0 * aim
            )),
            Some(error) if error <= aim => {}
            Some(error) => say::remark(&format!(
                "warning: the target is missed: relative standard error {:.3} % instead of {} %\n",
                100.0 * error,
                100.0 * aim
            )),
            None => say::remark("warning: whether the target is reached is unknown\n"),
        }
    }
    for remark in &rendered.outcome.remarks {
        say::remark(&format!("note: {remark}\n"));
    }
    let black = is_black(&rendered.developed);
    if black {
        say::remark("warning: the picture is black: not one sample found light\n");
    }
    if !args.quiet && !black {
        tell_few(loaded, &rendered.developed);
    }
    if !args.quiet {
        let seconds = rendered.time.as_secs_f64();
        let per_second = |n: u64| n as f64 * 1e-6 / seconds;
        let error = match rendered.developed.mean_relative_standard_error() {
            _ if black => "black".to_owned(),
            Some(0.0) => "no noise (all replicates are alike)".to_owned(),
            Some(error) => format!("mean relative standard error {:.2} %", 100.0 * error),
            None if rendered.outcome.replicates == 0 => "no standard error".to_owned(),
            None => "no standard error (one replicate)".to_owned(),
        };
        let stopped = match rendered.outcome.replicates {
            done if done < rendered.replicates => {
                format!(
                    "stopped after {done} of {} replicates, ",
                    rendered.replicates
                )
            }
            _ => String::new(),
        };
        say::remark(&format!(
            "{}: {stopped}{seconds:.2} s, {:.2} M samples/s, {:.2} M rays/s, {error}\n",
            args.output().display(),
            per_second(rendered.outcome.samples),
            per_second(rendered.outcome.rays),
        ));
    }
    Ok(())
}

/// Writes the picture beside the image.
fn write_picture(args: &RenderArgs, path: &Path, developed: &RenderedImage) -> Result<(), String> {
    let development = args.shown.development()?;
    let written = png::write(path, &developed.image, development);
    let losses = written.map_err(|error| error.to_string())?;
    if !args.quiet && losses.not_finite > 0 {
        note(format!(
            "{}: {} samples are not finite and magenta",
            path.display(),
            losses.not_finite
        ));
    }
    Ok(())
}

/// Describes the samples of an image without any finished replicate.
fn unfinished_in_words(args: &RenderArgs, facts: &UnfinishedFacts) -> String {
    let image = args.output().display();
    let each = match (facts.least, facts.most) {
        (least, most) if least == most => format!("{least}"),
        (least, most) => format!("{least} to {most}"),
    };
    let mut text = format!(
        "warning: stopped within the first replicate: {image} is of {each} of {} samples per pixel, \
         without standard errors\n",
        facts.samples_per_replicate
    );
    if facts.without > 0 {
        text += &format!(
            "warning: {} pixels have no sample yet and are black\n",
            facts.without
        );
    }
    if args.part.is_some() {
        text += &format!("warning: {image} is no part that `etalon merge` takes\n");
    }
    if args.resume {
        text += &format!(
            "note: the same command goes on from {}\n",
            sample_budget::checkpoint(args).display()
        );
    }
    text
}

/// Whether nothing at all was found, in any channel but alpha.
fn is_black(developed: &RenderedImage) -> bool {
    let channels = developed.metadata.iter().flat_map(|m| &m.channels);
    let mut means = channels
        .filter(|name| *name != "A")
        .filter_map(|name| developed.image.channel(name));
    means.all(|means| means.iter().all(|mean| *mean == 0.0))
}

/// The share of pixels without light, of those that show something, that is told.
const UNLIT: f64 = 0.01;

/// Says where few samples carry the light, or none found any although there is a surface.
fn tell_few(loaded: &Loaded, developed: &RenderedImage) {
    if let Some(warning) = LightCarriers::of(developed).and_then(LightCarriers::warning) {
        say::remark(&format!("note: {warning}\n"));
    }
    if developed.metadata.as_ref().is_none_or(|m| m.replicates < 2) {
        return;
    }
    let colours = developed.colours();
    let unlit = light_carriers::unlit(&developed.image, &colours);
    let width = developed.image.width();
    let scene = &loaded.compiled.scene;
    let shows_something = |pixel: &usize| {
        let corner = glam::Vec2::new((pixel % width) as f32, (pixel / width) as f32);
        let offset = glam::IVec2::from(developed.frame.offset).as_vec2();
        let within = [[0.5, 0.5], [0.1, 0.1], [0.9, 0.1], [0.1, 0.9], [0.9, 0.9]];
        within.into_iter().any(|within| {
            let raster = offset + corner + glam::Vec2::from(within);
            let seen = scene.camera().ray(raster, glam::Vec2::splat(0.5), 0.0);
            scene.surfaces().intersect(&seen.ray).is_some()
        })
    };
    let count = unlit.iter().filter(|pixel| shows_something(pixel)).count();
    let all = width * developed.image.height();
    let seen = all - (unlit.len() - count);
    if count as f64 >= UNLIT * seen as f64 && count > 0 {
        say::remark(&format!(
            "note: in {count} of {seen} pixels that show something no sample found light: their standard error of 0 says \
             nothing\n"
        ));
    }
}

/// Says which samples went wrong, and how to look at the first or largest of them.
fn tell_trouble(
    args: &RenderArgs,
    developed: &RenderedImage,
    metadata: &Metadata,
    again: &Again<'_>,
) {
    let faults = metadata.faults.total();
    if faults > 0 {
        say::remark(&format!(
            "warning: {faults} contributions were not finite; see `etalon info`\n"
        ));
        if let Some(command) = again.of_faults(&metadata.faults) {
            say::remark(&format!("look at the first of them with\n  {command}\n"));
        }
    }
    let fireflies = Fireflies::of(developed, metadata);
    if let Some(fireflies) = fireflies.filter(|_| !args.quiet)
        && let Some(largest) = fireflies.first()
    {
        let count = match fireflies.count {
            1 => "one sample is a firefly: it lifts its pixel".to_owned(),
            count => format!("{count} samples are fireflies: the largest lifts its pixel"),
        };
        note(format!(
            "{count} by {:.3}; look at it with\n  {}",
            fireflies.lift(largest),
            again.of_outlier(largest)
        ));
    }
}

/// The relative standard error that `--error` is about.
fn relative_error(rendered: &Rendered) -> Option<f64> {
    Noise::of(&rendered.developed)?.relative()
}

/// Writes an EXR with everything, or the colours alone in a simpler format.
fn write_image(path: &Path, developed: &RenderedImage) -> Result<Losses, String> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("pfm") => pfm::write(path, &developed.image).map(|()| Losses::default()),
        Some("hdr" | "rgbe") => hdr::write(path, &developed.image),
        _ => developed.write_exr(path).map(|()| Losses::default()),
    }
    .map_err(|error| error.to_string())
}

fn stats(
    again: &Again<'_>,
    loaded: &Loaded,
    rendered: &Rendered,
    pilot: Option<(u32, f64)>,
) -> serde_json::Value {
    let seconds = rendered.time.as_secs_f64();
    let metadata = rendered.developed.metadata.as_ref();
    serde_json::json!({
        "scene": again.args.scene.display().to_string(),
        "scene_hash": loaded.hash,
        "integrator": loaded.integrator_name,
        "load_seconds": loaded.load_time.as_secs_f64(),
        "build_seconds": loaded.build_time.as_secs_f64(),
        "render_seconds": seconds,
        "samples": rendered.outcome.samples,
        "rays": rendered.outcome.rays,
        "samples_per_second": rendered.outcome.samples as f64 / seconds,
        "rays_per_second": rendered.outcome.rays as f64 / seconds,
        "spp": metadata.map(|m| m.spp),
        "replicates": rendered.outcome.replicates,
        "replicate_kind": metadata.map(|m| m.replicate_kind),
        "part": metadata.and_then(|m| m.part.as_ref()),
        "mean_relative_standard_error": rendered.developed.mean_relative_standard_error(),
        "relative_standard_error": relative_error(rendered),
        "pilot_spp": pilot.map(|(samples, _)| samples),
        "pilot_seconds": pilot.map(|(_, seconds)| seconds),
        "adaptive": metadata.and_then(|m| m.adaptive.as_ref()),
        "resumed_replicates": rendered.finished,
        "unfinished": metadata.and_then(|m| m.unfinished.as_ref()),
        "non_finite": metadata.map(|m| m.faults.total()),
        "faults": metadata.map(|m| faults_to_json(&m.faults, again)),
        "fireflies": metadata.map(|m| fireflies_to_json(&rendered.developed, m, again)),
        "peak_memory_bytes": resources::peak_memory_bytes(),
        "threads": rayon::current_num_threads(),
        "seed": metadata.map(|m| m.seed),
    })
}
