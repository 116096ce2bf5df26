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
    /// Let Intel's Open Image Denoise 2 filter, if it is found: the system's, or that in this folder or file.
    #[arg(long, value_name = "PATH", num_args = 0..=1, require_equals = true)]
    pub oidn: Option<Option<PathBuf>>,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}
