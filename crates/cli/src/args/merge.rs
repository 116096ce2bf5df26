//! Arguments of `merge`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `merge`.
#[derive(Debug, Args, Clone)]
pub struct MergeArgs {
    /// The parts, in any order, or a folder with them.
    #[arg(required = true, value_name = "PART.exr|DIR")]
    pub parts: Vec<PathBuf>,
    /// The image to write.
    #[arg(short, long, value_name = "OUT.exr")]
    pub output: PathBuf,
    /// Merge what there is, if parts are missing: into a larger part.
    #[arg(long)]
    pub partial: bool,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}
