//! `cargo xtask efficiency`: how many times as efficient one estimator is as another, on the scenes and
//! in the sizes of `benches/efficiency.toml`, which are fixed before anything is measured.
//!
//! References are rendered once, into `target/efficiency`, and kept as long as their scene stays the same.

use etalon_render::estimators::{Findings, Options, Trial, table};
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderOptions};
use etalon_validation::folders;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Which comparisons, and for how long.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  cargo xtask efficiency --only caustic\n  cargo xtask efficiency --time 120 --seed 2"
)]
pub(crate) struct Arguments {
    /// Only comparisons whose names contain this
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Time for each size of a scene, references apart (s)
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    time: f64,
    /// Seed of all measured pictures
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Only render the references
    #[arg(long)]
    references_only: bool,
}

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Plan {
    defines: Defines,
    comparisons: Vec<Comparison>,
}

type Defines = BTreeMap<String, toml::Value>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Comparison {
    name: String,
    scene: String,
    integrators: Vec<String>,
    /// Which ratio of the best to the first is hoped for.
    goal: f64,
    reference: ReferencePlan,
    sizes: Vec<Defines>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReferencePlan {
    integrator: String,
    spp: u32,
}

/// The seed of references, and of nothing else.
const REFERENCE_SEED: u64 = 0x5EED_0F7E_FE7E;

/// Measures, and prints rows of a Markdown table.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/efficiency.toml");
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let plan: Plan = toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    let kept = folders::root().join("target/efficiency");
    fs::create_dir_all(&kept).map_err(|e| format!("{}: {e}", kept.display()))?;
    let wanted = |c: &&Comparison| arguments.only.as_ref().is_none_or(|n| c.name.contains(n));
    let comparisons: Vec<&Comparison> = plan.comparisons.iter().filter(wanted).collect();
    if comparisons.is_empty() {
        return Err("no comparison has such a name".to_owned());
    }
    let mut rows = Vec::new();
    for comparison in comparisons {
        for size in &comparison.sizes {
            let defines = pairs(&plan.defines, size);
            let reference = reference(comparison, &defines, &kept)?;
            if arguments.references_only {
                continue;
            }
            let options = Options {
                load: LoadOptions {
                    defines,
                    ..LoadOptions::default()
                },
                integrators: comparison.integrators.clone(),
                seconds: arguments.time,
                reference: Some(reference),
                seed: arguments.seed,
                ..Options::default()
            };
            let scene = folders::scenes().join(&comparison.scene);
            let trial = Trial::prepare(&scene, &options).map_err(|e| e.to_string())?;
            let findings = trial.run(&()).map_err(|e| e.to_string())?;
            eprintln!("{}", table::text(&findings));
            rows.extend(lines(comparison, size, &findings));
        }
    }
    if !rows.is_empty() {
        println!("| scene | size | estimator | efficiency, ratio | 95 % | goal |");
        println!("|---|---|---|---|---|---|");
        println!("{}", rows.join("\n"));
    }
    Ok(())
}

/// Parameters as on the command line; those of a size come last.
fn pairs(all: &Defines, size: &Defines) -> Vec<(String, String)> {
    etalon_validation::claim::pairs(all)
        .chain(etalon_validation::claim::pairs(size))
        .collect()
}

/// The file of a reference, rendered unless it is there.
fn reference(
    comparison: &Comparison,
    defines: &[(String, String)],
    kept: &Path,
) -> Result<PathBuf, String> {
    let loaded = load(comparison, defines)?;
    let ReferencePlan { integrator, spp } = &comparison.reference;
    let file = kept.join(format!("{}-{integrator}-{spp}.exr", loaded.hash));
    if file.exists() {
        return Ok(file);
    }
    let options = RenderOptions {
        spp: Some(*spp),
        seed: Some(REFERENCE_SEED),
        replicates: Some(32),
        ..RenderOptions::default()
    };
    let plan = pipeline::plan(&loaded, &options);
    eprintln!("reference of {}: {defines:?}", comparison.name);
    let rendered = pipeline::render(&loaded, &plan, &()).map_err(|e| e.message)?;
    let written = rendered.developed.write_exr(&file);
    written.map_err(|reason| format!("{}: {reason}", file.display()))?;
    Ok(file)
}

fn load(comparison: &Comparison, defines: &[(String, String)]) -> Result<Loaded, String> {
    let options = LoadOptions {
        defines: defines.to_vec(),
        integrator: Some(comparison.reference.integrator.clone()),
        ..LoadOptions::default()
    };
    let scene = folders::scenes().join(&comparison.scene);
    pipeline::load(&scene, &options).map_err(|refusal| {
        let first = refusal.diagnostics.first();
        first.map_or_else(String::new, |d| d.one_line(&refusal.sources))
    })
}

/// A row for every estimator but the first.
fn lines(comparison: &Comparison, size: &Defines, findings: &Findings) -> Vec<String> {
    let size: Vec<String> = etalon_validation::claim::pairs(size)
        .map(|(key, value)| format!("{key} {value}"))
        .collect();
    let rows = findings.estimators.iter().filter_map(|row| {
        let gain = row.gains.as_ref()?.efficiency;
        let value = gain.value.map_or("?".to_owned(), |v| format!("{v:.2}"));
        let interval = match (gain.interval, gain.at_least) {
            (Some([low, high]), _) => format!("{low:.2} to {high:.2}"),
            (None, Some(low)) => format!("at least {low:.2}"),
            (None, None) => "none".to_owned(),
        };
        Some(format!(
            "| {} | {} | {} | {value} | {interval} | {} |",
            comparison.name,
            size.join(", "),
            row.name,
            comparison.goal
        ))
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_and_integrator_of_the_plan_exists() {
        let plan: Plan = toml::from_str(include_str!("../../benches/efficiency.toml"))
            .expect("the plan can be read");
        for comparison in &plan.comparisons {
            for size in &comparison.sizes {
                let defines = pairs(&plan.defines, size);
                let loaded = load(comparison, &defines).map(|loaded| loaded.complete);
                assert_eq!(loaded, Ok(true), "{}", comparison.name);
            }
        }
    }
}
