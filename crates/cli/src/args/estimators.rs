//! Arguments of `etalon estimators`.

use crate::arg_values::{parse_define, parse_light_chooser, parse_seconds, parse_seed, whole};
use clap::Args;
use etalon_render::resources::MOST_THREADS;
use etalon_scene::LightSamplerKind;
use std::path::PathBuf;

/// Arguments of `estimators`.
#[derive(Debug, Args, Clone)]
pub struct EstimatorsArgs {
    /// The scene (Mitsuba 3 XML, pbrt-v4 or glTF 2.0).
    pub scene: PathBuf,
    /// Integrators, each in place of the scene's innermost one [default: the scene's].
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    pub integrators: Vec<String>,
    /// Samplers: independent, stratified, sobol [default: the scene's].
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    pub samplers: Vec<String>,
    /// Reconstruction filters: box, tent, gaussian, … [default: the scene's].
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    pub filters: Vec<String>,
    /// Rules by which a point chooses the light that it asks: automatic, uniform, power, tree
    /// [default: the scene's].
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = parse_light_chooser)]
    pub light_choosers: Vec<LightSamplerKind>,
    /// Time for all rendering together (s).
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub time: f64,
    /// The length of each picture at equal time (s), such as you mean to render: who learns stands differently in short and
    /// long ones [default: as long as there is time for 24].
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true)]
    pub picture_time: Option<f64>,
    /// A converged picture to measure errors against [default: rendered with the first estimator].
    #[arg(long, value_name = "FILE.exr")]
    pub reference: Option<PathBuf>,
    /// Share of the time for rendering a reference.
    #[arg(
        long,
        value_name = "SHARE",
        default_value_t = 0.3,
        allow_negative_numbers = true,
        conflicts_with = "reference"
    )]
    pub reference_share: f64,
    /// Write a self-contained HTML report.
    #[arg(long, value_name = "OUT.html")]
    pub report: Option<PathBuf>,
    /// Write everything that was found as JSON (docs/estimators-json.md).
    #[arg(long, value_name = "FILE.json")]
    pub json: Option<PathBuf>,
    /// Seed of all randomness.
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = parse_seed,
        allow_negative_numbers = true)]
    pub seed: u64,
    /// Threads [default: one per processor].
    #[arg(long, value_name = "T", value_parser = whole::<1, MOST_THREADS>, allow_negative_numbers = true)]
    pub threads: Option<u32>,
    /// Give a scene parameter ($key) a value.
    #[arg(short = 'D', value_name = "key=value", value_parser = parse_define)]
    pub define: Vec<(String, String)>,
    /// Folder with further data (`NAME.eta.spd` of metals, such as Mitsuba's data/ior).
    #[arg(long, value_name = "DIR")]
    pub data: Vec<PathBuf>,
    /// A picture of what surrounds a scene of glTF, which has no place for it.
    #[arg(long, value_name = "FILE.exr")]
    pub environment: Option<PathBuf>,
    /// Say nothing but the result and errors.
    #[arg(short, long)]
    pub quiet: bool,
}
