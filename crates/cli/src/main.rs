//! The `etalon` command line.

use clap::Parser;
use etalon_render::machine;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Some(refusal) = machine::refusal() {
        eprintln!("error: {refusal}");
        return ExitCode::from(2);
    }
    if etalon::version::is_asked_for(std::env::args_os().skip(1)) {
        print!("{}", etalon::version::verbose());
        return ExitCode::SUCCESS;
    }
    let cli = etalon::args::Cli::parse();
    etalon::commands::run(&cli.command)
}
