//! `cargo xtask conform-references`: renders the pictures of those questions of `etalon conform` that have no closed form.

use etalon_conform::mitsuba_xml;
use etalon_conform::mode::Mode;
use etalon_conform::question::Question;
use etalon_conform::questions;
use etalon_conform::replicate::Replicate;
use etalon_conform::scene::Scene;
use etalon_conform::tile::{self, TILES};
use etalon_conform::truth::reference::{self, Estimate, Reference, References};
use etalon_images::Chromaticities;
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderOptions};
use etalon_sampling::SamplerKind;
use etalon_statistics::{Estimate as Difference, Summary};
use etalon_validation::folders;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The estimators, both without bias.
const INTEGRATORS: [&str; 2] = ["path", "bdpt"];

/// Pictures at least, of which their spread is estimated.
const PICTURES: u32 = 16;

/// Two estimators whose difference is this rare by chance do not agree.
const LEVEL: f64 = 1e-4;

/// What to render, and how well.
#[derive(Clone, Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  cargo xtask conform-references\n  cargo xtask conform-references --only cloud --seconds 300"
)]
pub(crate) struct ConformReferencesArguments {
    /// Only the question of this name
    #[arg(long)]
    only: Option<String>,
    /// Seconds for each question and estimator
    #[arg(long, default_value_t = 120)]
    seconds: u64,
    /// Samples per pixel of one picture
    #[arg(long, default_value_t = 16_384)]
    samples: u32,
}

/// Renders them and writes their file anew.
pub(crate) fn run(arguments: &ConformReferencesArguments) -> Result<(), String> {
    let path = folders::root().join("crates/conform/src/truth/references.json");
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut references: References =
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    let open = |question: &&Question| {
        let only = arguments.only.as_deref();
        (question.ask)().1.error != 0.0 && only.is_none_or(|only| only == question.name)
    };
    let asked: Vec<_> = questions::ALL.iter().filter(open).collect();
    if asked.is_empty() {
        return Err("no question of this name has a reference".to_owned());
    }
    for question in asked {
        let made = make(question, arguments)?;
        let error = 100.0 * made.error();
        println!("{}: standard error of the mean {error:.4} %", question.name);
        references.insert(question.name.to_owned(), made);
        let json = serde_json::to_string(&references).map_err(|e| e.to_string())?;
        fs::write(&path, json + "\n").map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}

/// The picture of a question by both estimators.
fn make(question: &Question, arguments: &ConformReferencesArguments) -> Result<Reference, String> {
    let (scene, _) = (question.ask)();
    let folder = folders::root().join("target/conform-references");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let xml = write(&scene, &folder)?;
    let mut answers = Vec::new();
    for integrator in INTEGRATORS {
        let options = LoadOptions {
            integrator: Some(integrator.to_owned()),
            ..LoadOptions::default()
        };
        let loaded = pipeline::load(&xml, &options)
            .map_err(|refusal| format!("{}: {:?}", question.name, refusal.diagnostics))?;
        let pictures = pictures(&loaded, arguments)?;
        let means: Vec<f64> = pictures.iter().map(Replicate::mean).collect();
        let summary = Summary::of(&means).ok_or("too few pictures")?;
        let estimate = Estimate {
            integrator: integrator.to_owned(),
            pictures: pictures.len() as u32,
            samples: arguments.samples,
            mean: summary.mean(),
            standard_error: summary.standard_error(),
        };
        println!(
            "{}: {integrator} {:.6} ± {:.6}, {} pictures",
            question.name, estimate.mean, estimate.standard_error, estimate.pictures
        );
        answers.push((estimate, pictures));
    }
    agree(scene.pixels, &answers).map_err(|how| format!("{}: {how}", question.name))?;
    let whole: f64 = answers.iter().map(|(estimate, _)| estimate.weight()).sum();
    let mut means = vec![0.0; (scene.pixels * scene.pixels) as usize];
    for (estimate, pictures) in &answers {
        let share = estimate.weight() / (whole * pictures.len() as f64);
        for picture in pictures {
            let pixels = means.iter_mut().zip(&picture.luminance);
            pixels.for_each(|(mean, value)| *mean += share * value);
        }
    }
    Ok(Reference {
        scene: reference::fingerprint(&scene),
        estimates: answers.into_iter().map(|(estimate, _)| estimate).collect(),
        means,
    })
}

/// The scene in a folder, for Etalon.
fn write(scene: &Scene, folder: &Path) -> Result<PathBuf, String> {
    // As shipped, roulette ends paths from the fifth bounce on: to connect long ones takes too long.
    let xml = mitsuba_xml::write(scene, "scene", Mode::Shipped)?;
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.join(name), bytes).map_err(|e| format!("{name}: {e}"))
    };
    for (name, bytes) in &xml.files {
        write(name, bytes)?;
    }
    write("scene.xml", xml.text.as_bytes())?;
    Ok(folder.join("scene.xml"))
}

/// As many pictures as the time allows.
fn pictures(
    loaded: &Loaded,
    arguments: &ConformReferencesArguments,
) -> Result<Vec<Replicate>, String> {
    let (start, limit) = (Instant::now(), Duration::from_secs(arguments.seconds));
    let mut pictures = Vec::new();
    let weights = Chromaticities::REC_709.luminance_weights();
    for seed in 1.. {
        let options = RenderOptions {
            spp: Some(arguments.samples),
            seed: Some(u64::from(seed)),
            // Each picture is one scrambled sequence; their spread is the error.
            sampler: Some(SamplerKind::Sobol),
            replicates: Some(1),
            ..RenderOptions::default()
        };
        let plan = pipeline::plan(loaded, &options);
        let rendered = pipeline::render(loaded, &plan, &()).map_err(|e| e.message)?;
        let image = &rendered.developed.image;
        let [Some(r), Some(g), Some(b)] = ["R", "G", "B"].map(|name| image.channel(name)) else {
            return Err("the picture has no colours".to_owned());
        };
        let pixel = |i: usize| {
            let rgb = [r[i], g[i], b[i]].map(f64::from);
            rgb.iter().zip(weights).map(|(c, weight)| c * weight).sum()
        };
        pictures.push(Replicate {
            pose: 0,
            seed,
            luminance: (0..r.len()).map(pixel).collect(),
        });
        if seed >= PICTURES && start.elapsed() > limit {
            break;
        }
    }
    Ok(pictures)
}

/// Checks the means of the picture and of its tiles by both estimators against each other.
fn agree(pixels: u32, answers: &[(Estimate, Vec<Replicate>)]) -> Result<(), String> {
    let [(_, a), (_, b)] = answers else {
        return Err("there are not two estimators".to_owned());
    };
    let compare = |what: &str, of: &dyn Fn(&Replicate) -> f64| {
        let summary = |pictures: &[Replicate]| {
            let values: Vec<f64> = pictures.iter().map(of).collect();
            Summary::of(&values).ok_or("too few pictures")
        };
        let difference = Difference::welch(&summary(a)?, &summary(b)?);
        let means = 1.0 + f64::from(TILES * TILES);
        let interval = difference.interval(1.0 - LEVEL / means);
        match interval.low <= 0.0 && interval.high >= 0.0 {
            true => Ok(()),
            false => Err(format!(
                "the estimators differ in {what}: by {} to {}",
                interval.low, interval.high
            )),
        }
    };
    compare("the mean", &Replicate::mean)?;
    for index in 0..TILES * TILES {
        let place = [index % TILES, index / TILES];
        compare(&format!("tile {place:?}"), &|picture| {
            tile::mean(&picture.luminance, pixels, place)
        })?;
    }
    Ok(())
}
