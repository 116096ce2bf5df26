//! The `etalon` command line.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = etalon::args::Cli::parse();
    etalon::commands::run(&cli.command)
}
