//! Arguments of `replicates`.

use crate::arg_values::whole;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `replicates`.
#[derive(Debug, Args, Clone)]
pub struct ReplicatesArgs {
    /// The pictures, one for each seed: two or more.
    #[arg(required = true, num_args = 1.., value_name = "SEED.exr")]
    pub pictures: Vec<PathBuf>,
    /// The image to write.
    #[arg(short, long, value_name = "OUT.exr")]
    pub output: PathBuf,
    /// Samples per pixel of each picture, where they are known.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole::<1, { u32::MAX }>, allow_negative_numbers = true)]
    pub spp: u32,
    /// What made the pictures: its name and version.
    #[arg(long, value_name = "NAME", default_value = "another program")]
    pub program: String,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}
