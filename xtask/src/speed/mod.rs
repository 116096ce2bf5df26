//! `cargo xtask speed`: how noisy pictures are and how long they take, beside Mitsuba 3's.
//!
//! Both programs render the same files in turn, picture by picture with seeds of their own. A picture's
//! noise is its relative variance, the mean over pixels of var / (mean² + 0.01) of the luminance;
//! efficiency is 1 / (relative variance × time), with the shortest time of each program.

mod baseline;
mod cpu_time;
mod opponent;
mod peers;
mod pictures;
mod table;

use crate::references::mitsuba;
use clap::ValueEnum;
use cpu_time::cpu_seconds;
use etalon_film::{BoxFilter, Filter, Gaussian};
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderOptions};
use etalon_sampling::SamplerKind;
use etalon_validation::{claim, folders};
use opponent::Opponent;
use peers::Peer;
use pictures::Pictures;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use table::TableRow;

/// The exit code of a check that could not be made.
const COULD_NOT_MEASURE: u8 = 2;

/// Which scenes, and how.
#[derive(Clone, clap::Args)]
#[command(
    after_help = "Exit code of --check: 0 if no ratio fell, 1 if one did, 2 if it could not be measured, 3 if Mitsuba is not\ninstalled.\n\nMitsuba takes part if an interpreter has it: the one that ETALON_PYTHON names, or target/venv, which\n`cargo xtask references` makes. Its LLVM variants need LLVM 17 or later.\n\nExamples:\n  cargo xtask speed\n  cargo xtask speed --filter gaussian --only cornell\n  cargo xtask speed ~/scenes/*.xml --seeds 32 --json speed.json\n  cargo xtask speed --check\n  cargo xtask speed --peer mitsuba=target/venv/bin/python --peer cycles=python3.11"
)]
pub(crate) struct Arguments {
    /// Scenes to render in place of those of `benches/speed.toml`
    scenes: Vec<PathBuf>,
    /// Hold samples per second over Mitsuba's to `benches/speed-baseline.toml`, which says how both render
    #[arg(long, conflicts_with_all = ["scenes", "spp", "seeds", "filter", "sampler", "threads", "cpu_time", "variant", "defines", "json"])]
    check: bool,
    /// Measure other renderers instead, on scenes of `etalon conform`: the names of its drivers, each with the interpreter that has its
    /// module
    #[arg(long = "peer", value_name = "NAME[=PYTHON]", conflicts_with_all = ["scenes", "check", "only", "spp", "seeds", "filter", "sampler", "threads", "cpu_time", "variant", "defines", "json"])]
    peers: Vec<Peer>,
    /// Only scenes of the list whose names contain this
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Samples per pixel
    #[arg(long, value_name = "N", default_value_t = 32)]
    spp: u32,
    /// Pictures by each program, at least 2
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(2..))]
    seeds: u32,
    /// Reconstruction filter of both programs
    #[arg(long, value_enum, default_value = "box")]
    filter: FilterChoice,
    /// Sampler of Etalon; Mitsuba has the scene's
    #[arg(long, value_enum, default_value = "sobol")]
    sampler: SamplerChoice,
    /// Threads of both programs
    #[arg(long, value_name = "T", default_value_t = 2)]
    threads: u32,
    /// Take the processor time of all threads for the time of a picture: other programs change it little
    #[arg(long)]
    cpu_time: bool,
    /// Variant of Mitsuba
    #[arg(long, default_value = "llvm_ad_spectral")]
    variant: String,
    /// Value of a scene parameter
    #[arg(short = 'D', long = "define", value_name = "KEY=VALUE")]
    defines: Vec<String>,
    /// Write the numbers as JSON to this file, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Arguments {
    /// The processor time of a process so far, if that is to be taken.
    fn cpu_seconds(&self, process: u32) -> Result<Option<f64>, String> {
        (self.cpu_time.then(|| cpu_seconds(process))).transpose()
    }

    /// Whether a scene of this name is to be measured.
    fn wants(&self, name: &str) -> bool {
        let only = self.only.as_ref().map(|only| only.to_lowercase());
        only.is_none_or(|only| name.to_lowercase().contains(&only))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FilterChoice {
    /// The scene's own
    Scene,
    Box,
    /// Mitsuba's default
    Gaussian,
}

impl FilterChoice {
    fn filter(self) -> Option<Filter> {
        match self {
            Self::Scene => None,
            Self::Box => Some(Filter::Box(BoxFilter)),
            Self::Gaussian => Gaussian::new(Gaussian::DEFAULT_DEVIATION).map(Filter::Gaussian),
        }
    }

    fn name(self) -> Option<&'static str> {
        match self {
            Self::Scene => None,
            Self::Box => Some("box"),
            Self::Gaussian => Some("gaussian"),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SamplerChoice {
    /// The scene's own
    Scene,
    Sobol,
    Independent,
}

impl SamplerChoice {
    fn kind(self) -> Option<SamplerKind> {
        match self {
            Self::Scene => None,
            Self::Sobol => Some(SamplerKind::Sobol),
            Self::Independent => Some(SamplerKind::Independent),
        }
    }
}

/// `benches/speed.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    defines: Defines,
    scenes: Vec<SceneEntry>,
}

type Defines = BTreeMap<String, toml::Value>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneEntry {
    name: String,
    scene: PathBuf,
    #[serde(default)]
    defines: Defines,
}

/// Measures, or checks.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    let done = match arguments.check {
        true => baseline::check(arguments).map(baseline::CheckOutcome::exit_code),
        false if !arguments.peers.is_empty() => {
            peers::compare(&arguments.peers).map(|()| ExitCode::SUCCESS)
        }
        false => compare(arguments).map(|()| ExitCode::SUCCESS),
    };
    done.unwrap_or_else(|message| {
        eprintln!("error: {message}");
        match arguments.check {
            true => ExitCode::from(COULD_NOT_MEASURE),
            false => ExitCode::FAILURE,
        }
    })
}

/// Threads for Etalon.
fn pool(threads: u32) -> Result<rayon::ThreadPool, String> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads as usize)
        .build()
        .map_err(|e| e.to_string())
}

/// Measures, and prints the table.
fn compare(arguments: &Arguments) -> Result<(), String> {
    let entries = entries(arguments)?;
    let pool = pool(arguments.threads)?;
    let python = mitsuba::installed();
    if python.is_none() {
        eprintln!("Mitsuba is not there: Etalon alone");
    }
    let mut rows: Vec<TableRow> = Vec::new();
    println!("{}", table::HEAD);
    for entry in &entries {
        match pool.install(|| measure(arguments, entry, python.as_deref())) {
            Ok(row) => {
                println!("{}", table::line(&row));
                rows.push(row);
            }
            // One scene of many that one program cannot read is no reason to measure none.
            Err(message) => eprintln!("error: {message}"),
        }
    }
    if rows.is_empty() {
        return Err("nothing was measured".to_owned());
    }
    if let Some(mean) = table::mean_line(&rows) {
        println!("{mean}");
    }
    if let Some(file) = &arguments.json {
        let text = serde_json::to_string_pretty(&rows).map_err(|e| e.to_string())?;
        fs::write(file, text).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    match entries.len() - rows.len() {
        0 => Ok(()),
        failed => Err(format!("{failed} of {} scenes failed", entries.len())),
    }
}

/// What is to be measured.
fn entries(arguments: &Arguments) -> Result<Vec<SceneEntry>, String> {
    if !arguments.scenes.is_empty() {
        let entry = |scene: &PathBuf| SceneEntry {
            name: scene.display().to_string(),
            scene: scene.clone(),
            defines: Defines::new(),
        };
        return Ok(arguments.scenes.iter().map(entry).collect());
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/speed.toml");
    let wrong = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let text = fs::read_to_string(&path).map_err(|e| wrong(&e))?;
    let list: List = toml::from_str(&text).map_err(|e| wrong(&e))?;
    let wanted = |entry: &SceneEntry| arguments.wants(&entry.name);
    let all = list
        .scenes
        .into_iter()
        .filter(wanted)
        .map(|entry| SceneEntry {
            scene: folders::scenes().join(&entry.scene),
            defines: list
                .defines
                .clone()
                .into_iter()
                .chain(entry.defines)
                .collect(),
            name: entry.name,
        });
    let entries: Vec<SceneEntry> = all.collect();
    if entries.is_empty() {
        return Err("no scene of the list has such a name".to_owned());
    }
    Ok(entries)
}

/// Renders a scene's pictures with both programs, in turn.
fn measure(
    arguments: &Arguments,
    entry: &SceneEntry,
    python: Option<&Path>,
) -> Result<TableRow, String> {
    let mut defines: Vec<(String, String)> = claim::pairs(&entry.defines).collect();
    for define in &arguments.defines {
        let (key, value) = define
            .split_once('=')
            .ok_or_else(|| format!("`{define}` is no KEY=VALUE"))?;
        defines.push((key.to_owned(), value.to_owned()));
    }
    let loaded = load(&entry.scene, &defines, arguments.filter)?;
    let mut opponent = python
        .map(|python| Opponent::start(python, arguments, &entry.scene, &defines))
        .transpose()?;
    let (mut ours, mut theirs) = (Pictures::default(), Pictures::default());
    let mut samples = 0;
    for seed in 1..=arguments.seeds {
        let options = RenderOptions {
            spp: Some(arguments.spp),
            seed: Some(seed.into()),
            sampler: arguments.sampler.kind(),
            ..RenderOptions::default()
        };
        let plan = pipeline::plan(&loaded, &options);
        let before = arguments.cpu_seconds(std::process::id())?;
        let rendered = pipeline::render(&loaded, &plan, &()).map_err(|e| e.message)?;
        let after = arguments.cpu_seconds(std::process::id())?;
        let seconds = match before.zip(after) {
            Some((before, after)) => after - before,
            None => rendered.time.as_secs_f64(),
        };
        samples = rendered.outcome.samples;
        let image = &rendered.developed.image;
        let rgb = ["R", "G", "B"].map(|name| image.channel(name));
        let [Some(r), Some(g), Some(b)] = rgb else {
            return Err("its film has no colours".to_owned());
        };
        let pixels = r.iter().zip(g).zip(b).map(|((r, g), b)| [*r, *g, *b]);
        ours.add(pixels, seconds);
        if let Some(opponent) = &mut opponent {
            let (pixels, seconds) = opponent.picture(arguments, seed)?;
            theirs.add(pixels, seconds);
        }
    }
    let theirs =
        opponent.map(|opponent| theirs.facts(opponent.pixels() * u64::from(arguments.spp)));
    Ok(TableRow {
        scene: entry.name.clone(),
        etalon: ours.facts(samples),
        mitsuba: theirs,
    })
}

/// A scene, with this filter in place of its own.
fn load(
    scene: &Path,
    defines: &[(String, String)],
    filter: FilterChoice,
) -> Result<Loaded, String> {
    let options = LoadOptions {
        defines: defines.to_vec(),
        ..LoadOptions::default()
    };
    let mut loaded = pipeline::load(scene, &options).map_err(|refusal| {
        let first = refusal.diagnostics.first();
        format!(
            "{}: {}",
            scene.display(),
            first.map_or("refused", |d| d.message.as_str())
        )
    })?;
    if let (Some(filter), Some(compiled)) = (filter.filter(), Arc::get_mut(&mut loaded.compiled)) {
        compiled.film.filter = filter;
    }
    Ok(loaded)
}
