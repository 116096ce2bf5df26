//! The commands of the binary.

mod again;
pub mod compare;
pub mod conform;
pub mod convert;
pub mod convert_scene;
mod delivery;
pub mod denoise;
pub mod estimators;
pub mod farm;
mod fireflies;
mod frames;
pub mod info;
pub mod merge;
pub mod movie;
mod options;
mod plugins;
pub mod render;
pub mod replay;
pub mod replicates;
mod sample_budget;
pub mod strategies;
pub mod view;

use crate::args::Command;
use crate::{interrupt, say};
use std::process::ExitCode;

/// Exit code for input that cannot be used.
pub const BAD_INPUT: u8 = 2;

/// Runs a command; failures have been explained on standard error.
pub fn run(command: &Command) -> ExitCode {
    if let Err(error) = interrupt::outlive_too_large_files() {
        note(format!(
            "a file that grows too large will end the process: {error}"
        ));
    }
    if let Some(remark) = etalon_render::machine::remark() {
        note(remark);
    }
    match command {
        Command::Render(args) => render::run(args),
        Command::Merge(args) => merge::run(args),
        Command::Replicates(args) => replicates::run(args),
        Command::Farm(args) => farm::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Conform(args) => conform::run(args),
        Command::Estimators(args) => estimators::run(args),
        Command::Denoise(args) => denoise::run(args),
        Command::Convert(args) => convert::run(args),
        Command::ConvertScene(args) => convert_scene::run(args),
        Command::View(args) => view::run(args),
        Command::Movie(args) => movie::run(args),
        Command::Info(args) => info::run(args),
        Command::Completions(args) => {
            let mut command = <crate::args::Cli as clap::CommandFactory>::command();
            let mut script = Vec::new();
            clap_complete::generate(args.shell, &mut command, "etalon", &mut script);
            answer(&String::from_utf8_lossy(&script), ExitCode::SUCCESS)
        }
    }
}

/// Says the result of a command, and gives `code` if that was possible.
fn answer(text: &str, code: ExitCode) -> ExitCode {
    say::result(text).map_or_else(fail, |()| code)
}

/// Says something worth knowing.
fn note(message: impl std::fmt::Display) {
    say::remark(&format!("note: {message}\n"));
}

/// Says why a command failed, in one line, and gives its exit code.
fn fail(message: impl std::fmt::Display) -> ExitCode {
    say::remark(&format!("error: {message}\n"));
    ExitCode::from(BAD_INPUT)
}
