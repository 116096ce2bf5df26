//! `etalon denoise`.

use super::fail;
use crate::args::DenoiseArgs;
use crate::say;
use etalon_film::read_developed;
use etalon_render::denoise::{OpenImageDenoise, denoise};
use etalon_render::write_guard::WriteGuard;
use std::process::ExitCode;

/// Denoises an image.
pub fn run(args: &DenoiseArgs) -> ExitCode {
    match denoised(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => fail(message),
    }
}

fn denoised(args: &DenoiseArgs) -> Result<(), String> {
    let output = WriteGuard::of([&args.input]).claim_exr(&args.output)?;
    let picture = read_developed(&args.input).map_err(|error| error.to_string())?;
    let library = args
        .oidn
        .as_ref()
        .map(|place| OpenImageDenoise::find(place.as_deref()));
    let denoised = denoise(&picture, library.transpose()?.as_ref())
        .map_err(|reason| format!("{}: {reason}", args.input.display()))?;
    output.write_with(|path| denoised.write_exr(path))?;
    if !args.quiet {
        // Both relative to what is shown: in the noisy picture a pixel that is too bright hides its error.
        let error = |image: &etalon_film::RenderedImage| {
            let relative = image.standard_error_relative_to(&denoised);
            100.0 * relative.unwrap_or(f64::NAN)
        };
        say::remark(&format!(
            "{}: mean relative error about {:.2} %, of {:.2} % before\n",
            args.output.display(),
            error(&denoised),
            error(&picture)
        ));
    }
    Ok(())
}
