//! The tasks of the house: `cargo xtask validate`, `accelerators`, `references`, `mutants`, `calibrate`, `calibrate-conform`, `conform-references`, `efficiency`, `speed`, `bits`, `book`, `denoiser`, `gallery`, `farm-test`, `scenes`, `plugins`, `tables`, `tabulate`.

mod accelerators;
mod bits;
mod book;
mod calibrate;
mod calibrate_conform;
mod compatibility;
mod conform_references;
mod denoiser;
mod efficiency;
mod farm_test;
mod gallery;
mod hearing;
mod load;
mod mutants;
mod plugins;
mod references;
mod scenes;
mod schema;
mod speed;
mod tables;
mod tabulate;
mod validate;
mod words;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// The tasks of the house.
#[derive(Parser)]
#[command(
    name = "cargo xtask",
    after_help = "Examples:\n  cargo xtask validate\n  cargo xtask validate --only cornell-box\n  cargo xtask references --only veach-mis\n  cargo xtask tables"
)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Render every claim and decide whether it holds
    Validate(validate::Arguments),
    /// Render the references of claims with Mitsuba 3 and POV-Ray
    References(references::Arguments),
    /// Plant physical faults in a copy of the workspace, and show that the claims find them
    Mutants(mutants::Arguments),
    /// Show that the validation's error rates are what they are said to be
    Calibrate(calibrate::Arguments),
    /// Show on simulated programs that `etalon conform` accuses as rarely as it says
    CalibrateConform(calibrate_conform::CalibrateConformArguments),
    /// Render the references of those questions of `etalon conform` that have no closed form
    ConformReferences(conform_references::ConformReferencesArguments),
    /// Measure by how much estimators are better than others (`benches/efficiency.toml`)
    Efficiency(efficiency::Arguments),
    /// Measure noise, time and efficiency on a list of scenes, beside Mitsuba 3's (`benches/speed.toml`)
    Speed(speed::Arguments),
    /// Compare accelerators with each other, and with Embree if it is found
    Accelerators(accelerators::Arguments),
    /// Check that threads and build profiles do not change a bit (builds `release`: minutes)
    Bits,
    /// Make a book of the pages of `docs/` (target/book), if mdBook is installed
    Book,
    /// Measure what `etalon denoise` takes away, what it leaves and what it says of it
    Denoiser(denoiser::DenoiserArguments),
    /// Render the pictures of the book (`docs/gallery`) that have changed
    Gallery(gallery::Arguments),
    /// Run the job files of `etalon farm` by the engines that are installed, one node killed on the way, and compare bits
    FarmTest(farm_test::Arguments),
    /// Write the generated files of `scenes/` anew
    Scenes,
    /// Write the pages of `docs/` on plugins and parameters anew: what there is, asked of the code
    Plugins,
    /// Write the generated tables of the spectrum crate anew
    Tables(tables::Arguments),
    /// Tabulate the BRDF of any model, and draw models and tables
    Tabulate(tabulate::Arguments),
}

fn main() -> ExitCode {
    let done = match Arguments::parse().task {
        Task::Validate(arguments) => return validate::run(&arguments),
        Task::Mutants(arguments) => return mutants::run(&arguments),
        Task::Calibrate(arguments) => return calibrate::run(&arguments),
        Task::CalibrateConform(arguments) => return calibrate_conform::run(&arguments),
        Task::Speed(arguments) => return speed::run(&arguments),
        Task::References(arguments) => references::run(&arguments),
        Task::ConformReferences(arguments) => conform_references::run(&arguments),
        Task::Efficiency(arguments) => efficiency::run(&arguments),
        Task::Accelerators(arguments) => accelerators::run(&arguments),
        Task::Bits => bits::run(),
        Task::Book => book::run(),
        Task::Denoiser(arguments) => denoiser::run(&arguments),
        Task::Gallery(arguments) => gallery::run(&arguments),
        Task::FarmTest(arguments) => farm_test::run(&arguments),
        Task::Scenes => scenes::run(),
        Task::Plugins => plugins::run(),
        Task::Tables(arguments) => tables::run(&arguments),
        Task::Tabulate(arguments) => tabulate::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}
