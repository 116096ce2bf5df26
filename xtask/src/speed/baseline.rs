//! `cargo xtask speed --check`: samples per second over Mitsuba's, held to what they were (`benches/speed-baseline.toml`).

use super::{Arguments, Defines, FilterChoice, SamplerChoice, SceneEntry, measure, table};
use crate::references::mitsuba;
use crate::scenes::ply;
use etalon_benches::scenes::displaced_sphere;
use etalon_validation::folders;
use serde::Deserialize;
use std::cmp::Ordering;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// `benches/speed-baseline.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpeedBaseline {
    /// Variant of Mitsuba.
    variant: String,
    /// Threads of both programs.
    threads: u32,
    /// Samples per pixel.
    spp: u32,
    /// Pictures by each program.
    pictures: u32,
    /// A ratio may be lower than that of the file by this share of it.
    tolerance: f64,
    scenes: Vec<HeldRatio>,
}

/// A scene's ratio.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct HeldRatio {
    name: String,
    /// Relative to `scenes`.
    scene: PathBuf,
    #[serde(default)]
    defines: Defines,
    /// Triangles of the sphere whose file is the scene's parameter `mesh`.
    sphere: Option<usize>,
    /// Etalon's samples per second over Mitsuba's.
    ratio: f64,
}

/// What is said of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Fell,
    Holds,
    /// By more than the tolerance: the file should say so.
    Rose,
}

impl Verdict {
    fn of(ratio: f64, held: f64, tolerance: f64) -> Self {
        let within = tolerance * held;
        match ratio.partial_cmp(&(held - within)) {
            Some(Ordering::Greater | Ordering::Equal) if ratio > held + within => Self::Rose,
            Some(Ordering::Greater | Ordering::Equal) => Self::Holds,
            // NaN is no speed.
            Some(Ordering::Less) | None => Self::Fell,
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Fell => "**fell**",
            Self::Holds => "holds",
            Self::Rose => "rose: raise the baseline",
        }
    }
}

/// How the whole comparison ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CheckOutcome {
    /// No ratio fell.
    Holds,
    /// At least one did.
    Fell,
    /// There is nothing to compare with.
    NoMitsuba,
}

impl CheckOutcome {
    /// Its exit code. 2 is for what could not be measured.
    pub(super) fn exit_code(self) -> ExitCode {
        ExitCode::from(match self {
            Self::Holds => 0,
            Self::Fell => 1,
            Self::NoMitsuba => 3,
        })
    }
}

/// Measures all scenes of the file, and prints the table.
pub(super) fn check(arguments: &Arguments) -> Result<CheckOutcome, String> {
    let baseline = read(&folders::root().join("benches/speed-baseline.toml"))?;
    let Some(python) = mitsuba::installed() else {
        eprintln!("Mitsuba is not installed: no ratio can be measured");
        return Ok(CheckOutcome::NoMitsuba);
    };
    let settings = Arguments {
        variant: baseline.variant.clone(),
        threads: baseline.threads,
        spp: baseline.spp,
        seeds: baseline.pictures,
        filter: FilterChoice::Scene,
        sampler: SamplerChoice::Scene,
        cpu_time: true,
        ..arguments.clone()
    };
    let wanted: Vec<&HeldRatio> = (baseline.scenes.iter())
        .filter(|held| arguments.wants(&held.name))
        .collect();
    if wanted.is_empty() {
        return Err("no scene of the baseline has such a name".to_owned());
    }
    println!(
        "| scene | samples/s over Mitsuba's `{}` | baseline | |",
        baseline.variant
    );
    println!("|---|---|---|---|");
    let mut outcome = CheckOutcome::Holds;
    for held in wanted {
        let row = super::pool(settings.threads)?
            .install(|| measure(&settings, &held.entry()?, Some(&python)))?;
        let ratio = table::rate_ratio(&row).ok_or("Mitsuba rendered nothing")?;
        let verdict = Verdict::of(ratio, held.ratio, baseline.tolerance);
        println!(
            "| {} | {ratio:.3} | {:.3} | {} |",
            held.name,
            held.ratio,
            verdict.text()
        );
        if verdict == Verdict::Fell {
            outcome = CheckOutcome::Fell;
        }
    }
    Ok(outcome)
}

fn read(path: &Path) -> Result<SpeedBaseline, String> {
    let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
}

impl HeldRatio {
    /// The scene, with its mesh if it has one that is made here.
    fn entry(&self) -> Result<SceneEntry, String> {
        let mut defines = self.defines.clone();
        if let Some(triangles) = self.sphere {
            let file = sphere(triangles)?;
            defines.insert("mesh".to_owned(), file.display().to_string().into());
        }
        Ok(SceneEntry {
            name: self.name.clone(),
            scene: folders::scenes().join(&self.scene),
            defines,
        })
    }
}

/// The file of the sphere with about so many triangles, written unless it is there.
fn sphere(triangles: usize) -> Result<PathBuf, String> {
    let folder = folders::root().join("target/speed");
    let file = folder.join(format!("sphere-{triangles}.ply"));
    if !file.exists() {
        let bytes = ply::Mesh::from(&displaced_sphere(triangles)).to_ply();
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&file, bytes))
            .map_err(|e| format!("{}: {e}", file.display()))?;
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fall_beyond_the_tolerance_is_told_from_noise() {
        let of = |ratio| Verdict::of(ratio, 1.25, 0.04);
        assert_eq!(of(1.25), Verdict::Holds);
        assert_eq!(of(1.201), Verdict::Holds);
        assert_eq!(of(1.199), Verdict::Fell);
        assert_eq!(of(1.299), Verdict::Holds);
        assert_eq!(of(1.301), Verdict::Rose);
        assert_eq!(of(f64::NAN), Verdict::Fell);
    }

    #[test]
    fn the_baseline_names_scenes_that_are_there() {
        let file = folders::root().join("benches/speed-baseline.toml");
        let baseline = read(&file).expect("the file reads");
        assert!((0.0..0.2).contains(&baseline.tolerance) && baseline.pictures > 1);
        for held in &baseline.scenes {
            let scene = folders::scenes().join(&held.scene);
            assert!(scene.exists(), "{}: {}", held.name, scene.display());
            assert!(held.ratio > 0.0, "{}", held.name);
        }
    }

    #[test]
    fn a_missing_opponent_has_an_exit_code_of_its_own() {
        let codes = [
            CheckOutcome::Holds,
            CheckOutcome::Fell,
            CheckOutcome::NoMitsuba,
        ]
        .map(|outcome| format!("{:?}", outcome.exit_code()));
        assert!(codes[0] != codes[1] && codes[1] != codes[2] && codes[0] != codes[2]);
        let broken = format!("{:?}", ExitCode::from(super::super::COULD_NOT_MEASURE));
        assert!(!codes.contains(&broken));
    }
}
