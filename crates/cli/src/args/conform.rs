//! Arguments of `conform`.

use crate::arg_values::whole;
use clap::{Args, Subcommand};
use etalon_conform::mode::Mode;
use etalon_conform::tier::Tier;
use etalon_render::part::PartOfMany;
use std::path::PathBuf;

/// Arguments of `conform`.
#[derive(Debug, Args)]
pub struct ConformArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: ConformCommand,
}

/// What `conform` does.
#[derive(Debug, Subcommand)]
pub enum ConformCommand {
    /// Name the questions and the drivers that there are.
    List,
    /// Say what is true of a question: its formula, its source and its picture.
    Truth {
        /// The question's name.
        question: String,
    },
    /// Have a program answer, and judge its answers.
    #[command(after_help = "\
Exit codes: 0 it agrees in all that it can express, 1 it differs, 2 something is broken, or bad input, 3 something is undecided.

Examples:
  etalon conform run --driver mitsuba
  etalon conform run --driver mine.toml --tier quick --only 'sphere-*'
  etalon conform run --driver mine.toml -o today --baseline last.json    # in a project's CI")]
    Run(ConformRunArgs),
    /// Write the scenes and a list of pictures, for a program that renders elsewhere.
    Export(ConformExportArgs),
    /// Judge the pictures in a folder that `export` or `run` made.
    Judge {
        /// The folder.
        folder: PathBuf,
        /// The program's name in full [default: as the folder has it].
        #[arg(long)]
        program: Option<String>,
    },
    /// Put the reports of several programs on one page.
    Page {
        /// The reports.
        #[arg(required = true, num_args = 1.., value_name = "REPORT.json")]
        reports: Vec<PathBuf>,
        /// The page to write.
        #[arg(short, long, value_name = "PAGE.html")]
        output: PathBuf,
    },
    /// Say what changed between two reports; exit code 1 if anything became worse.
    Diff {
        /// The older report.
        old: PathBuf,
        /// The newer one.
        new: PathBuf,
    },
}

/// What is asked, and how much.
#[derive(Debug, Args)]
pub struct AskedArgs {
    /// How much is rendered: `quick` asks the questions of few samples, with 16 pictures of each; `standard` all, with 32, four times
    /// as many of what is undecided, and some of four times the samples of what does not agree; `full` these of everything.
    #[arg(long, value_name = "TIER", default_value = "standard")]
    pub tier: Tier,
    /// Only questions whose names fit; `*` stands for anything, and commas stand between several.
    #[arg(
        long,
        value_name = "GLOB,…",
        value_delimiter = ',',
        default_value = "*"
    )]
    pub only: Vec<String>,
    /// Ask for agreement within 0.1 %, in place of 0.5 %; much will be undecided.
    #[arg(long)]
    pub strict: bool,
    /// The seed of all poses.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub pose_seed: u64,
    /// What the program leaves out: `measure` all that biases (this decides whether it is right), `shipped` nothing (this tells).
    #[arg(long, value_name = "MODE", default_value = "measure")]
    pub mode: Mode,
}

/// Arguments of `conform run`.
#[derive(Debug, Args)]
pub struct ConformRunArgs {
    /// A driver: the name of one that comes with Etalon, or a TOML file.
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub driver: String,
    /// What is asked.
    #[command(flatten)]
    pub asked: AskedArgs,
    /// Ask part I of N of the questions, at the error rates of all; `judge` puts parts in one folder together.
    #[arg(long, value_name = "I/N")]
    pub part: Option<PartOfMany>,
    /// The folder for scenes, pictures and the report [default: conform-NAME, in this folder].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// An earlier report: only what is worse than it counts.
    #[arg(long, value_name = "OLD.json")]
    pub baseline: Option<PathBuf>,
    /// Pictures at a time, each with one thread [default: one per processor].
    #[arg(long, value_name = "N", value_parser = whole::<1, 1024>, allow_negative_numbers = true)]
    pub workers: Option<u32>,
    /// The longest that a picture may take (s).
    #[arg(long, value_name = "SECONDS", default_value_t = 120, value_parser = whole::<1, 86400>, allow_negative_numbers = true)]
    pub limit: u32,
    /// What runs drivers in Python [default: `ETALON_PYTHON`, or python3].
    #[arg(long, value_name = "PROGRAM")]
    pub python: Option<PathBuf>,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}

/// Arguments of `conform export`.
#[derive(Debug, Args)]
pub struct ConformExportArgs {
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    pub to: PathBuf,
    /// What is asked.
    #[command(flatten)]
    pub asked: AskedArgs,
}
