//! Arguments of `denoise`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `denoise`.
#[derive(Debug, Args, Clone)]
pub struct DenoiseArgs {
    /// An image that was rendered with `--features`.
    pub input: PathBuf,
    /// The image to write.
    #[arg(short, long, value_name = "OUT.exr")]
    pub output: PathBuf,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}
