//! The command line.

mod conform;
mod convert;
mod denoise;
mod estimators;
mod farm;
mod framing;
mod merge;
mod port;
mod preview;
mod replay_address;
mod replicates;

pub use conform::{AskedArgs, ConformArgs, ConformCommand, ConformExportArgs, ConformRunArgs};
pub use convert::{ConvertArgs, ConvertSceneArgs};
pub use denoise::DenoiseArgs;
pub use estimators::EstimatorsArgs;
pub use farm::{FarmArgs, PathMap};
pub use framing::{FramingArgs, ShownArgs};
pub use merge::MergeArgs;
pub use port::Port;
pub use preview::{PreviewArgs, ViewArgs};
pub use replay_address::ReplayAddress;
pub use replicates::ReplicatesArgs;

use replay_address::parse_replay;

use crate::arg_values::{
    parse_accelerator, parse_define, parse_error, parse_light_chooser, parse_probability,
    parse_rate, parse_seconds, parse_seed, whole,
};
use crate::frames::{Frame, FrameRange};
use crate::outputs::Outputs;
use clap::{Args, Parser, Subcommand};
use etalon_render::part::PartOfMany;
use etalon_render::resources::{MOST_REPLICATES, MOST_THREADS};
use etalon_scene::{AcceleratorKind, LightSamplerKind};
use std::path::{Path, PathBuf};

/// A spectral renderer whose estimators are held to account by statistics.
#[derive(Debug, Parser)]
#[command(
    name = "etalon",
    version,
    about,
    max_term_width = 100,
    after_help = "\
`etalon --version --verbose` says of which commit and for which processors this program was built.

Exit codes: 0 done, 2 bad input or usage, 130 ended by Ctrl-C or a signal; `compare`: 1 different, 3 inconclusive."
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene (Mitsuba 3 XML, pbrt-v4 or glTF 2.0) to an EXR with standard errors.
    #[command(after_help = "\
Ctrl-C, SIGTERM and SIGHUP stop within two seconds. An image is written of the replicates that are
finished; if none is, of the samples that there are, without standard errors. With `--resume` nothing
is lost. During a pilot, or a second time, they end without an image.

Exit codes: 0 done, 2 bad input or usage, 130 ended by Ctrl-C or such a signal.

Examples:
  etalon render scenes/cornell-box/scene.xml
  etalon render scene.xml -o cornell.png
  etalon render scene.xml -o small.png --scale 25% --spp 16
  etalon render scene.xml -o corner.png --crop 100,50,64,64 --exposure 1.5
  etalon render scene.xml -o top.exr --sensor top --size 640x480
  etalon render scene.xml --preview               # look on at http://127.0.0.1:8750/
  etalon render scene.xml -o out.exr --spp 256 --seed 7 -D colour=0.5
  etalon render scene.xml -o direct.exr --integrator direct --stats stats.json
  etalon render scene.xml -o out.exr --error 0.01
  etalon render scene.xml -o out.exr --error 0.01 --adaptive
  etalon render scene.xml -o out.exr --spp 4096 --resume
  etalon render scene.xml -o a.exr --part 1/2
  etalon render scene.xml -o walk.####.exr --frames 1..48 --fps 24 --resume
  etalon render scene.xml --replay 12,7,0,3")]
    Render(RenderArgs),
    /// Put the parts of a render together: to the bit what an unsplit render gives.
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage, or parts that do not belong together.

Examples:
  etalon render scene.xml -o a.exr --part 1/2   # on one machine
  etalon render scene.xml -o b.exr --part 2/2   # on another
  etalon merge a.exr b.exr -o whole.exr
  etalon merge parts -o whole.exr               # all that are in the folder
  etalon merge a.exr -o so-far.exr --partial")]
    Merge(MergeArgs),
    /// Put pictures of different seeds, by whatever program, into one image with standard errors.
    ///
    /// Then `compare` can judge them. Each picture is of the same scene with a seed of its own: linear Rec. 709 (EXR,
    /// Radiance HDR, PFM), the first row on top.
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage.

Examples:
  etalon replicates seed-*.exr -o mine.exr --spp 64 --program 'mine 1.0'
  etalon replicates a.hdr b.hdr c.hdr d.hdr -o mine.exr
  etalon compare mine.exr etalon.exr --report mine.html")]
    #[command(visible_alias = "gather")]
    Replicates(ReplicatesArgs),
    /// Write the job files that render a scene on a cluster: for Slurm, Open Job Description or GNU parallel.
    ///
    /// `-o` is the folder for job files, parts and the picture; all other options are those of `render`. Each task renders
    /// one part of the replicates, or one frame, may be started again at any time, and goes on from its checkpoint.
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage.

Examples:
  etalon farm --engine slurm scene.xml -o job --parts 8 --spp 4096
  etalon farm --engine slurm walk.xml -o job --frames 1..240 --submit
  etalon farm --engine openjd scene.xml -o job
  etalon farm --engine parallel scene.xml -o job --parts 4 && HOSTS=machines.txt sh job/submit.sh")]
    Farm(FarmArgs),
    /// Decide whether two images agree, tile by tile, from their replicates.
    #[command(after_help = "\
Exit codes: 0 equivalent, 1 different, 2 bad input or usage, 3 inconclusive.

Examples:
  etalon compare a.exr b.exr
  etalon compare a.exr b.exr --report difference.html --bound 0.01")]
    Compare(CompareArgs),
    /// Ask another renderer questions whose answers are known, and say whether it is right.
    ///
    /// Each question is a small scene whose picture is known in closed form, posed several times at random. A driver, a short
    /// TOML file, says how the program is run. What is decided, and how to write a driver: docs/conform.md.
    #[command(after_help = "\
Exit codes: 0 the program agrees in all that it can express, 1 it differs, 2 something is broken, or bad input, 3 something is undecided.

Examples:
  etalon conform list
  etalon conform truth sphere-light-small
  etalon conform run --driver mitsuba
  etalon conform export --to questions && render-them questions/jobs.jsonl && etalon conform judge questions")]
    Conform(ConformArgs),
    /// Measure which of several estimators is better on a scene, and by how much.
    ///
    /// Every combination of the integrators, samplers, filters and light choosers takes part. Ratios are to the
    /// first. A short pilot fixes how much each renders before anything is measured.
    #[command(after_help = "\
Exit codes: 0 measured, 2 bad input or usage.

Examples:
  etalon estimators scene.xml --integrators path,ptracer --time 60
  etalon estimators scene.xml --samplers independent,stratified,sobol --time 60 --report noise.html
  etalon estimators scene.xml --integrators path,direct --reference converged.exr --time 30 \\
    --json figures.json")]
    Estimators(EstimatorsArgs),
    /// Denoise an image that was rendered with `--features`, and estimate the error that is left.
    ///
    /// The result is biased and has no replicates: its standard errors are what the denoiser estimates. It is marked, `compare`
    /// gives no verdict on it, and `merge`, `estimators` and `replicates` refuse it.
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage.

Examples:
  etalon render scene.xml -o noisy.exr --spp 32 --features
  etalon denoise noisy.exr -o quiet.exr
  etalon denoise noisy.exr -o quiet.exr --oidn
  etalon view noisy.exr quiet.exr")]
    Denoise(DenoiseArgs),
    /// Turn an image into a picture one can look at (PNG, sRGB), or into HDR or PFM.
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage.

Examples:
  etalon convert out.exr out.png
  etalon convert out.exr bright.png --exposure 2
  etalon convert out.exr noise.png --channels standard_error
  etalon convert aov.exr depth.png --channels depth --range 0..20")]
    Convert(ConvertArgs),
    /// Write a scene of pbrt-v4 or glTF, or one with includes and parameters, as one file of Mitsuba's XML.
    ///
    /// What the scene file has within (meshes, curves, grids, pictures) becomes files beside the output; other files stay where they are. The
    /// picture is the same. What Mitsuba 3 does not have stands there as Etalon's own plugin (docs/extensions.md).
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage.

Examples:
  etalon convert-scene scene.pbrt scene.xml
  etalon convert-scene model.glb model.xml
  etalon convert-scene old.xml new.xml")]
    ConvertScene(ConvertSceneArgs),
    /// Look at an image in the browser, or at two and their difference.
    ///
    /// A page on this machine with exposure, zoom, pixel values, standard errors and all layers; a file that changes is
    /// read again. Ctrl-C ends it.
    #[command(after_help = "\
Exit codes: 2 bad input or usage, 130 ended by Ctrl-C.

Examples:
  etalon view out.exr
  etalon view out.exr reference.exr --exposure 1")]
    View(ViewArgs),
    /// Make the frames of an animation a file that plays.
    ///
    /// An animated PNG is written here and plays in every browser; for other kinds `ffmpeg` is called, if it is
    /// installed.
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage.

Examples:
  etalon movie walk.*.exr -o walk.png --fps 24
  etalon movie walk.####.exr --frames 1..240 -o walk.mp4")]
    Movie(MovieArgs),
    /// Say what is in a scene or an image, or which plugins there are.
    #[command(after_help = "\
Exit codes: 0 done, 2 bad input or usage.

Examples:
  etalon info out.exr
  etalon info scene.xml
  etalon info scene.xml --json
  etalon info --plugins
  etalon info --plugins roughconductor")]
    Info(InfoArgs),
    /// Write the completions of this command line for a shell to standard output.
    #[command(after_help = "\
Examples:
  etalon completions bash > ~/.local/share/bash-completion/completions/etalon
  etalon completions zsh > ~/.zfunc/_etalon
  etalon completions fish > ~/.config/fish/completions/etalon.fish")]
    Completions(CompletionsArgs),
}

/// Arguments of `render`.
#[derive(Debug, Args, Clone)]
#[command(group = clap::ArgGroup::new("wanted").args(["output", "replay"]))]
#[command(group = clap::ArgGroup::new("piloted").multiple(true).args(["error", "adaptive"]))]
pub struct RenderArgs {
    /// The scene (Mitsuba 3 XML, pbrt-v4 or glTF 2.0).
    pub scene: PathBuf,
    /// The image to write: .exr; .png writes a picture beside an .exr; .hdr and .pfm hold no
    /// standard errors [default: the scene's name with .exr, in this folder].
    #[arg(short, long, value_name = "OUT.exr")]
    pub output: Option<PathBuf>,
    /// What is written for it.
    #[arg(skip)]
    pub outputs: Option<Outputs>,
    /// Draw one sample again, and say what happened vertex by vertex: sample S of replicate R of
    /// the pixel in column X and row Y, counted from 0. Nothing is rendered.
    #[arg(long, value_name = "X,Y,R,S", value_parser = parse_replay, allow_hyphen_values = true,
        conflicts_with_all = ["error", "time", "resume", "strategies", "part", "stats"])]
    pub replay: Option<ReplayAddress>,
    /// Samples per pixel; rounded up to what the sampler can stratify [default: the scene's].
    #[arg(long, value_name = "N", value_parser = whole::<1, { u32::MAX }>, allow_negative_numbers = true)]
    pub spp: Option<u32>,
    /// Seed of all randomness [default: the scene's sampler's, or 0].
    #[arg(long, value_name = "S", value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: Option<u64>,
    /// Threads [default: one per processor].
    #[arg(long, value_name = "T", value_parser = whole::<1, MOST_THREADS>, allow_negative_numbers = true)]
    pub threads: Option<u32>,
    /// Replace the type of the innermost integrator (keeps max_depth, rr_depth, hide_emitters; all
    /// of its parameters if it has that type).
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,
    /// How a point chooses the light that it asks: automatic, uniform, power, tree [default: the
    /// scene's].
    #[arg(long, value_name = "NAME", value_parser = parse_light_chooser)]
    pub light_chooser: Option<LightSamplerKind>,
    /// How surfaces are looked up: linear, octree, bvh-mean, bvh, wide. The picture is the same [default: wide].
    #[arg(long, value_name = "NAME", value_parser = parse_accelerator)]
    pub accelerator: Option<AcceleratorKind>,
    /// Give a scene parameter ($key) a value.
    #[arg(short = 'D', value_name = "key=value", value_parser = parse_define)]
    pub define: Vec<(String, String)>,
    /// What part of the scene.
    #[command(flatten)]
    pub framing: FramingArgs,
    /// How a picture beside the image is shown.
    #[command(flatten)]
    pub shown: ShownArgs,
    /// Who looks on.
    #[command(flatten)]
    pub preview: PreviewArgs,
    /// Replicates the image is the mean of [default: 8, or fewer if spp is less].
    #[arg(long, value_name = "R", value_parser = whole::<1, MOST_REPLICATES>, allow_negative_numbers = true)]
    pub replicates: Option<u32>,
    /// Independent replicates instead of blocks of one sequence: noisier, with unbiased squared standard errors.
    #[arg(long)]
    pub independent_replicates: bool,
    /// Also write what `etalon denoise` needs: albedo, normal and depth, and the first half of the (independent) replicates.
    #[arg(long, conflicts_with_all = ["resume", "part", "replay", "strategies"])]
    pub features: bool,
    /// As many samples as a relative standard error below REL takes, with 95 % confidence.
    #[arg(long, value_name = "REL", value_parser = parse_error, allow_negative_numbers = true, conflicts_with_all = ["spp", "time", "part", "strategies"])]
    pub error: Option<f64>,
    /// As many samples as fit into so many seconds.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true, conflicts_with_all = ["spp", "part", "strategies"])]
    pub time: Option<f64>,
    /// More samples where the noise is, as a pilot finds it; the pilot is no part of the image.
    #[arg(long, conflicts_with = "strategies")]
    pub adaptive: bool,
    /// Samples per pixel of the pilot before `--error` and `--adaptive` [default: 64].
    #[arg(long, value_name = "N", requires = "piloted",
        value_parser = whole::<16, { 1 << 20 }>, allow_negative_numbers = true)]
    pub pilot: Option<u32>,
    /// Keep a checkpoint beside the image (OUT.checkpoint), and go on from it if there is one; of a
    /// sequence, go on after the frames that are finished.
    #[arg(long, conflicts_with = "strategies")]
    pub resume: bool,
    /// Render frames A to B of an animation, each with a number in its name (`####` in OUT says where): the
    /// shutter counts from the frame's number divided by --fps.
    #[arg(long, value_name = "A..B", value_parser = FrameRange::parse, allow_hyphen_values = true,
        conflicts_with_all = ["part", "strategies"])]
    pub frames: Option<FrameRange>,
    /// Frames per unit of scene time.
    #[arg(long, value_name = "N", default_value_t = 24.0, requires = "frames", value_parser = parse_rate,
        allow_negative_numbers = true)]
    pub fps: f64,
    /// The frame that these arguments are about.
    #[arg(skip)]
    pub frame: Option<Frame>,
    /// Also write every technique of `bdpt` alone, weighted and unweighted, and a page with all.
    #[arg(long, value_name = "DIR", conflicts_with = "part")]
    pub strategies: Option<PathBuf>,
    /// Render part I of N: its share of the replicates, for `etalon merge`.
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    pub part: Option<PartOfMany>,
    /// Write time, rays, memory and more as JSON.
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
    /// Folder with further data (`NAME.eta.spd` of metals, such as Mitsuba's data/ior).
    #[arg(long, value_name = "DIR")]
    pub data: Vec<PathBuf>,
    /// A picture of what surrounds a scene of glTF, which has no place for it.
    #[arg(long, value_name = "FILE.exr")]
    pub environment: Option<PathBuf>,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}

impl RenderArgs {
    /// The image to write: there is one, unless a sample is replayed.
    pub fn output(&self) -> &Path {
        (self.outputs.as_ref()).map_or(Path::new(""), |outputs| &outputs.image)
    }
}

/// Arguments of `compare`.
#[derive(Debug, Args, Clone)]
pub struct CompareArgs {
    /// One image, rendered by Etalon (or a reference).
    pub a: PathBuf,
    /// The other.
    pub b: PathBuf,
    /// Write a self-contained HTML report.
    #[arg(long, value_name = "OUT.html")]
    pub report: Option<PathBuf>,
    /// Print the verdict as JSON.
    #[arg(long)]
    pub json: bool,
    /// The bias of the image mean that would matter, relative to the channel's mean.
    #[arg(long, value_name = "DELTA", default_value_t = 0.005, value_parser = parse_probability,
        allow_negative_numbers = true)]
    pub bound: f64,
    /// The bias of a tile that would matter, relative to the tile's own mean (plus `--bound` of
    /// the image's).
    #[arg(long, value_name = "DELTA", default_value_t = 0.03, value_parser = parse_probability,
        allow_negative_numbers = true)]
    pub tile_bound: f64,
    /// Probability of calling equal images different.
    #[arg(long, value_name = "ALPHA", default_value_t = 0.001, value_parser = parse_probability,
        allow_negative_numbers = true)]
    pub alpha: f64,
}

/// Arguments of `movie`.
#[derive(Debug, Args, Clone)]
pub struct MovieArgs {
    /// The frames, in order (EXR, PNG or what `etalon convert` reads), or one name with `####` for their numbers.
    #[arg(required = true, value_name = "FRAME.exr")]
    pub files: Vec<PathBuf>,
    /// Which numbers the frames of one name have: all of them must be there.
    #[arg(long, value_name = "A..B", value_parser = FrameRange::parse, allow_hyphen_values = true)]
    pub frames: Option<FrameRange>,
    /// The file to write: .png (animated), or what ffmpeg makes, such as .mp4, .webm, .mkv, .gif.
    #[arg(short, long, value_name = "OUT.png")]
    pub output: PathBuf,
    /// Frames per second.
    #[arg(long, value_name = "N", default_value_t = 24.0, value_parser = parse_rate, allow_negative_numbers = true)]
    pub fps: f64,
    /// How it is shown.
    #[command(flatten)]
    pub shown: ShownArgs,
}

/// Arguments of `info`.
#[derive(Debug, Args, Clone)]
pub struct InfoArgs {
    /// An image, a scene or a checkpoint.
    #[arg(required_unless_present = "plugins")]
    pub file: Option<PathBuf>,
    /// Say it as JSON, of a scene or an image.
    #[arg(long, conflicts_with = "plugins")]
    pub json: bool,
    /// Say which plugins scenes may have, or what the parameters of one are.
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "", conflicts_with = "file")]
    pub plugins: Option<String>,
}

/// Arguments of `completions`.
#[derive(Debug, Args, Clone)]
pub struct CompletionsArgs {
    /// For which shell.
    pub shell: clap_complete::Shell,
}
