//! Options for looking on while a picture renders, and for looking at pictures.

use super::framing::ShownArgs;
use super::port::{Port, parse_port};
use crate::arg_values::parse_tev;
use clap::Args;
use std::path::PathBuf;

/// Where the picture is shown while it renders.
#[derive(Debug, Args, Clone, Default)]
pub struct PreviewArgs {
    /// Show the picture while it renders, with its error map, exposure and pixel values, in a page on
    /// http://127.0.0.1:PORT/ [default PORT: 8750, or one that is free].
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "any", value_parser = parse_port,
        conflicts_with = "replay")]
    pub preview: Option<Port>,
    /// Send the picture while it renders to a `tev` that listens [default HOST:PORT: 127.0.0.1:14158].
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, default_missing_value = crate::preview::tev::ADDRESS,
        value_parser = parse_tev, conflicts_with = "replay")]
    pub tev: Option<String>,
}

/// Arguments of `view`.
#[derive(Debug, Args, Clone)]
pub struct ViewArgs {
    /// An image or picture (EXR, HDR, PFM, PNG, JPEG, BMP, TGA, PNM).
    #[arg(value_name = "FILE.exr")]
    pub file: PathBuf,
    /// Another one, to flip between the two and see their difference.
    #[arg(value_name = "OTHER.exr")]
    pub other: Option<PathBuf>,
    /// The port of the page [default: 8750, or one that is free].
    #[arg(long, value_name = "PORT", value_parser = parse_port, allow_hyphen_values = true)]
    pub port: Option<Port>,
    /// How it is shown at first.
    #[command(flatten)]
    pub shown: ShownArgs,
}
