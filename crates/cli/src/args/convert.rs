//! Arguments of the commands that write a file in another format.

use super::ShownArgs;
use crate::arg_values::parse_range;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `convert`.
#[derive(Debug, Args, Clone)]
pub struct ConvertArgs {
    /// The image to read (EXR, HDR, PFM, PNG, JPEG, BMP, TGA, PNM).
    pub input: PathBuf,
    /// The picture to write (.png, .hdr, .pfm).
    pub output: PathBuf,
    /// How it is shown.
    #[command(flatten)]
    pub shown: ShownArgs,
    /// Show the channels PREFIX.R, PREFIX.G, PREFIX.B (or X, Y, Z), or the one channel PREFIX,
    /// instead of R, G, B.
    #[arg(long, value_name = "PREFIX")]
    pub channels: Option<String>,
    /// Show A as black and B as white, in proportion, as depths, normals and errors want it: 0..10 or -1..1.
    #[arg(long, value_name = "A..B", value_parser = parse_range, allow_hyphen_values = true, conflicts_with_all = ["exposure", "view"])]
    pub range: Option<[f64; 2]>,
}

/// Arguments of `convert-scene`.
#[derive(Debug, Args, Clone)]
pub struct ConvertSceneArgs {
    /// The scene to read (.xml, .pbrt, .pbrt.gz, .gltf, .glb).
    pub input: PathBuf,
    /// The scene to write (.xml).
    pub output: PathBuf,
}
