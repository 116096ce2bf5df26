//! `etalon compare`.

use super::{answer, fail, note};
use crate::args::CompareArgs;
use etalon_film::{LightCarriers, RenderedImage, read_developed};
use etalon_images::{Channel, Image};
use etalon_render::judge::{self, ImageComparison, Tolerances};
use etalon_render::metrics::PixelErrors;
use etalon_render::report::comparison;
use etalon_render::write_guard::{Destination, WriteGuard};
use etalon_statistics::Verdict;
use std::process::ExitCode;

/// Exit code of images that differ.
const DIFFERENT: u8 = 1;
/// Exit code of a comparison that needs more samples.
const INCONCLUSIVE: u8 = 3;

/// Compares two images.
pub fn run(args: &CompareArgs) -> ExitCode {
    let mut guard = WriteGuard::of([&args.a, &args.b]);
    let report = args.report.as_deref();
    match report.map(|path| guard.claim(path)).transpose() {
        Ok(report) => compare(args, report.as_ref()),
        Err(message) => fail(message),
    }
}

fn compare(args: &CompareArgs, report: Option<&Destination>) -> ExitCode {
    let first = match read_developed(&args.a) {
        Ok(image) => image,
        Err(error) => return fail(error),
    };
    let second = match read_developed(&args.b) {
        Ok(image) => image,
        Err(error) => return fail(error),
    };
    // Images of different sizes are bad input in any case.
    let size = |image: &RenderedImage| (image.image.width(), image.image.height());
    let ((width, height), (other_width, other_height)) = (size(&first), size(&second));
    if (width, height) != (other_width, other_height) {
        return fail(format!(
            "the images differ in size: {width} × {height} ({}) and {other_width} × {other_height} ({})",
            args.a.display(),
            args.b.display()
        ));
    }
    for (path, image) in [(&args.a, &first), (&args.b, &second)] {
        if let Some(what) = not_a_number(&image.image) {
            return fail(format!("{}: {what}", path.display()));
        }
    }
    if identical(&first.image, &second.image) {
        return say_identical(args, report);
    }
    let unfit = [(&args.a, &first), (&args.b, &second)]
        .into_iter()
        .find_map(|(path, image)| Some(format!("{} {}", path.display(), unfit(image)?)));
    if let Some(reason) = unfit {
        return say_inconclusive(args, report, &reason, [&first, &second]);
    }
    let black = [(&args.a, &first), (&args.b, &second)]
        .into_iter()
        .find_map(|(path, image)| Some(format!("{} {}", path.display(), black(image)?)));
    if let Some(reason) = black {
        return say_inconclusive(args, report, &reason, [&first, &second]);
    }
    if let Some(seed) = shared_seed(&first, &second) {
        note(format!(
            "both images were rendered with seed {seed}: what they share of their noise \
             makes the comparison less sharp; `--seed` gives another one"
        ));
    }
    if let Some(remark) = other_scenes(&first, &second) {
        note(remark);
    }
    for (path, image) in [(&args.a, &first), (&args.b, &second)] {
        if let Some(warning) = LightCarriers::of(image).and_then(LightCarriers::warning) {
            note(format!("{}: {warning}", path.display()));
        }
    }
    let rules = Tolerances {
        image_bound: args.bound,
        tile_bound: args.tile_bound,
        alpha: args.alpha,
        rounding: 0.0,
    };
    let judgement = match judge::judge(&first, &second, rules) {
        Ok(judgement) => judgement,
        Err(message) => return fail(message),
    };
    if let Some(file) = report {
        let names = [args.a.display().to_string(), args.b.display().to_string()];
        let html = comparison::judged(&judgement, &first, &second, &names);
        if let Err(message) = file.write_text(&html) {
            return fail(message);
        }
    }
    let errors = PixelErrors::of(&first.image, &second.image);
    let text = match args.json {
        true => {
            let mut facts = serde_json::json!(judgement);
            facts["pixel_errors"] = serde_json::json!(errors);
            facts["more_samples"] = serde_json::json!(judgement.more_samples());
            format!("{facts:#}\n")
        }
        false => table(&judgement, errors),
    };
    let code = match judgement.verdict {
        Verdict::Agrees => ExitCode::SUCCESS,
        Verdict::Differs => ExitCode::from(DIFFERENT),
        Verdict::Undecided => ExitCode::from(INCONCLUSIVE),
    };
    answer(&text, code)
}

/// Whether two images are of different scenes, as far as their files say.
fn other_scenes(first: &RenderedImage, second: &RenderedImage) -> Option<String> {
    let (first, second) = (first.metadata.as_ref()?, second.metadata.as_ref()?);
    // Another integrator by the command line is another hash, and the same scene.
    if first.scene_hash == second.scene_hash || first.integrator != second.integrator {
        return None;
    }
    Some(match first.scene == second.scene {
        true => format!(
            "the images are of different states of {}: its files or what `-D` said have changed",
            first.scene
        ),
        false => format!(
            "the images are of different scenes, {} and {}: what differs may be the scenes, not the estimators",
            first.scene, second.scene
        ),
    })
}

/// The first pixel that is not a finite number, if there is one.
fn not_a_number(image: &Image) -> Option<String> {
    image.channels().iter().find_map(|channel| {
        let (pixel, value) = (channel.samples.iter().enumerate()).find(|(_, v)| !v.is_finite())?;
        let (x, y) = (pixel % image.width(), pixel / image.width());
        Some(format!(
            "pixel ({x}, {y}) of channel `{}` is {value}: there is nothing to compare",
            channel.name
        ))
    })
}

/// Why an image does not carry what a judgement is made of, if it does not.
fn unfit(image: &RenderedImage) -> Option<String> {
    let Some(metadata) = &image.metadata else {
        return Some("was not written by Etalon: it has no replicates to judge by".to_owned());
    };
    if let Some(facts) = metadata
        .unfinished
        .as_ref()
        .filter(|_| metadata.replicates == 0)
    {
        return Some(format!(
            "was interrupted within its first replicate, at {:.1} of {} samples per pixel, and so has no \
             standard error: render it to its end",
            facts.mean, facts.samples_per_replicate
        ));
    }
    if let Some(method) = &metadata.denoised {
        return Some(format!(
            "was denoised ({method}): it is biased and has no replicates, and no verdict is made of it"
        ));
    }
    if metadata.replicates < 2 {
        return Some(
            "has a single replicate and so no standard error: render it with --replicates"
                .to_owned(),
        );
    }
    let faults = metadata.faults.total();
    if faults > 0 {
        return Some(format!(
            "left out {faults} contributions that were not finite or out of range: what it shows is not \
             what was to be rendered (`etalon info` says where)"
        ));
    }
    let whole = metadata.tiles(None);
    whole
        .is_none_or(|means| means.replicates() < 2)
        .then(|| "carries no tile means of its replicates: there is nothing to judge by".to_owned())
}

/// Why a black image cannot be judged, if it is one.
///
/// Its replicates do not spread, but that is no knowledge: of n samples that all found nothing, the chance of one to
/// find something is below ln(1/α)/n with confidence 1 − α, and what it would find has no bound. An estimator
/// that misses what is rare leaves the same picture as a scene without light.
fn black(image: &RenderedImage) -> Option<String> {
    let metadata = image.metadata.as_ref()?;
    let colours = image.colours();
    let mut planes = colours.iter().filter_map(|name| image.image.channel(name));
    let is_black = planes.all(|pixels| pixels.iter().all(|value| *value == 0.0));
    is_black.then(|| {
        format!(
            "is black: not one of its {} samples per pixel found light, and so nothing tells how far it may \
             be off; either there is none, or `{}` cannot find it or needs more samples",
            metadata.spp, metadata.integrator
        )
    })
}

/// Says that these images cannot be judged, which is no pass.
fn say_inconclusive(
    args: &CompareArgs,
    report: Option<&Destination>,
    reason: &str,
    images: [&RenderedImage; 2],
) -> ExitCode {
    if let Some(file) = report {
        let names = [&args.a, &args.b].map(|path| path.display().to_string());
        let html = comparison::inconclusive(reason, images[0], images[1], &names);
        if let Err(message) = file.write_text(&html) {
            return fail(message);
        }
    }
    let verdict = Verdict::Undecided.to_string();
    let errors = PixelErrors::of(&images[0].image, &images[1].image);
    let text = match args.json {
        true => format!(
            "{:#}\n",
            serde_json::json!({ "verdict": verdict, "reason": reason, "pixel_errors": errors })
        ),
        false => format!("inconclusive: {reason}\n{}", errors_in_words(errors)),
    };
    answer(&text, ExitCode::from(INCONCLUSIVE))
}

/// Whether two images hold the same numbers in the same channels, bit for bit. Such images are
/// not two estimates, and there is nothing to test.
fn identical(a: &Image, b: &Image) -> bool {
    let same = |(a, b): (&Channel, &Channel)| {
        let bits = |c: &Channel| c.samples.iter().map(|v| v.to_bits()).collect::<Vec<u32>>();
        a.name == b.name && bits(a) == bits(b)
    };
    (a.width(), a.height(), a.channels().len()) == (b.width(), b.height(), b.channels().len())
        && a.channels().iter().zip(b.channels()).all(same)
}

fn say_identical(args: &CompareArgs, report: Option<&Destination>) -> ExitCode {
    if let Some(file) = report {
        let html = comparison::identical([&args.a, &args.b].map(|path| path.display().to_string()));
        if let Err(message) = file.write_text(&html) {
            return fail(message);
        }
    }
    let verdict = Verdict::Agrees.to_string();
    let text = match args.json {
        true => format!(
            "{:#}\n",
            serde_json::json!({ "verdict": verdict, "identical": true })
        ),
        false => "identical: the same numbers in every channel\n".to_owned(),
    };
    answer(&text, ExitCode::SUCCESS)
}

/// The seed of both images, if it is the same and they are renders of the same scene.
fn shared_seed(a: &RenderedImage, b: &RenderedImage) -> Option<u64> {
    let (a, b) = (a.metadata.as_ref()?, b.metadata.as_ref()?);
    (a.seed == b.seed && a.sampler == b.sampler && a.scene == b.scene).then_some(a.seed)
}

/// A line of figures that decide nothing.
fn errors_in_words(errors: Option<PixelErrors>) -> String {
    errors.map_or_else(String::new, |errors| {
        let PixelErrors {
            mse,
            rel_mse,
            smape,
            flip,
        } = errors;
        let flip = flip.map_or_else(String::new, |flip| format!(", HDR-FLIP {flip:.4}"));
        format!(
            "pixels   MSE {mse:.3e}, relMSE {rel_mse:.3e}, SMAPE {smape:.4}{flip}, noise of both included\n"
        )
    })
}

/// What would decide an open comparison.
fn more_in_words(factor: f64) -> String {
    if factor < 1e4 {
        format!(
            "about {} times the samples of both would decide it, if the bias is what it seems\n",
            factor.ceil().max(2.0)
        )
    } else {
        "the bias is so near its bound that no affordable number of samples would decide it\n"
            .to_owned()
    }
}

/// The judgement as a table for a terminal.
fn table(judgement: &ImageComparison, errors: Option<PixelErrors>) -> String {
    let mut text = String::from(
        "channel        mean       other      bias              interval   could see  verdict\n",
    );
    for row in &judgement.images {
        text += &format!(
            "{:<8} {:>10.5}  {:>10.5}  {:>+7.3} %  [{:>+7.3}, {:>+7.3}] %  {:>6.3} %  {}\n",
            row.channel,
            row.mean,
            row.other_mean,
            100.0 * row.bias,
            100.0 * row.interval[0],
            100.0 * row.interval[1],
            100.0 * row.smallest_detectable,
            row.verdict,
        );
    }
    for row in &judgement.tiles {
        text += &format!(
            "{:<8} {} tiles of {}²: worst {:+.2} % at ({}, {}), p = {:.2e} corrected, {} off\n",
            row.channel,
            row.tiles,
            row.side,
            100.0 * row.worst_bias,
            row.worst[0],
            row.worst[1],
            row.p_exact,
            row.differing,
        );
    }
    text += &errors_in_words(errors);
    text += &judgement
        .more_samples()
        .map_or_else(String::new, more_in_words);
    let verdict = match judgement.verdict {
        Verdict::Undecided => "inconclusive".to_owned(),
        verdict => verdict.to_string(),
    };
    text += &format!(
        "{verdict} (bound {} % of the mean, α = {})\n",
        100.0 * judgement.rules.image_bound,
        judgement.rules.alpha
    );
    text
}
