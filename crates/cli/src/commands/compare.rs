//! `etalon compare`.

use super::{answer, fail, note};
use crate::args::CompareArgs;
use etalon_film::{RenderedImage, read_developed};
use etalon_render::compared::Compared;
use etalon_render::judge::{ImageComparison, Tolerances};
use etalon_render::metrics::PixelErrors;
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
    let names = [&args.a, &args.b].map(|path| path.display().to_string());
    let images = [&first, &second];
    let rules = Tolerances {
        image_bound: args.bound,
        tile_bound: args.tile_bound,
        alpha: args.alpha,
        rounding: 0.0,
    };
    let compared = match Compared::new(images, &names, rules) {
        Ok(compared) => compared,
        Err(message) => return fail(message),
    };
    compared.remarks(images, &names).iter().for_each(note);
    if let Some(file) = report
        && let Err(message) = file.write_text(&compared.report(images, &names))
    {
        return fail(message);
    }
    let judgement = match compared {
        Compared::Identical => return say_identical(args),
        Compared::Unfit(reason) => return say_inconclusive(args, &reason, images),
        Compared::Judged(judgement) => judgement,
    };
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

/// Says that these images cannot be judged, which is no pass.
fn say_inconclusive(args: &CompareArgs, reason: &str, images: [&RenderedImage; 2]) -> ExitCode {
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

fn say_identical(args: &CompareArgs) -> ExitCode {
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
