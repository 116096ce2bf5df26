//! `cargo xtask accelerators`: how accelerators compare, and Embree beside them: building, memory, what a ray looks
//! at, rays per second, and cost against the number of primitives.

mod measure;
mod page;
mod table;

use clap::builder::PossibleValuesParser;
use etalon_benches::embree::Device;
use etalon_benches::scenes::Scene;
use etalon_geometry::AcceleratorKind;
use etalon_validation::folders;
use measure::{Plan, Row};
use serde::Serialize;
use std::fs;
use std::path::PathBuf;

/// Which scenes and accelerators, and how long.
#[derive(clap::Args)]
#[command(
    after_help = "Embree takes part if its library is found: the one that ETALON_EMBREE names, the system's, or that of\n`python3 -m venv target/venv && target/venv/bin/pip install embreex`.\n\nExamples:\n  cargo xtask accelerators\n  cargo xtask accelerators --only sphere --accelerator wide --sizes 0\n  cargo xtask accelerators --sizes 10000000 --repeats 3"
)]
pub(crate) struct Arguments {
    /// Only this scene: sphere, balls, forest, slivers, teapot (may be given several times)
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Only this accelerator (may be given several times)
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(AcceleratorKind::ALL.map(AcceleratorKind::name)))]
    accelerator: Vec<String>,
    /// How often everything is timed, by turns; the best time counts
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    repeats: u32,
    /// Largest sphere whose cost is measured against its number of triangles, from 100 on; 0 for none
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    sizes: usize,
    /// Threads of both programs; all without it
    #[arg(long, value_name = "T")]
    threads: Option<usize>,
    /// Folder of the page and the numbers
    #[arg(long, value_name = "DIR", default_value = "target/accelerators")]
    out: PathBuf,
}

/// Everything that was measured.
#[derive(Serialize)]
struct Report {
    threads: usize,
    embree: bool,
    rows: Vec<Row>,
    /// The sphere with more and more triangles.
    sizes: Vec<Row>,
}

/// Measures, prints the table and writes the page.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.unwrap_or(0));
    let pool = pool.build().map_err(|e| e.to_string())?;
    pool.install(|| measured(arguments))
}

fn measured(arguments: &Arguments) -> Result<(), String> {
    let workspace = folders::root();
    let threads = rayon::current_num_threads();
    let embree = Device::find(&workspace, threads);
    let embree = embree
        .inspect_err(|why| eprintln!("Etalon alone: {why}"))
        .ok();
    let named = |kind: &AcceleratorKind| {
        let asked = &arguments.accelerator;
        asked.is_empty() || asked.iter().any(|name| name == kind.name())
    };
    let plan = Plan {
        kinds: AcceleratorKind::ALL.into_iter().filter(named).collect(),
        embree: embree.as_ref(),
        repeats: arguments.repeats,
    };
    let mut report = Report {
        threads,
        embree: embree.is_some(),
        rows: Vec::new(),
        sizes: Vec::new(),
    };
    println!("{}", table::head(threads));
    for name in scenes(&arguments.only)? {
        let rows = plan.measure(&Scene::named(name).expect("one of them"));
        table::lines(&rows)
            .iter()
            .for_each(|line| println!("{line}"));
        report.rows.extend(rows);
    }
    let mut triangles = 100;
    while triangles <= arguments.sizes {
        report.sizes.extend(plan.measure(&Scene::sphere(triangles)));
        eprintln!("sphere of {triangles} triangles measured");
        triangles *= 10;
    }
    let write = |name: &str, text: String| {
        let path = arguments.out.join(name);
        fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
    };
    fs::create_dir_all(&arguments.out).map_err(|e| format!("{}: {e}", arguments.out.display()))?;
    let json = serde_json::to_string_pretty(&report).map_err(|e| e.to_string())?;
    write("accelerators.json", json)?;
    write("accelerators.html", page::page(&report))?;
    println!(
        "\nPage: {}",
        arguments.out.join("accelerators.html").display()
    );
    Ok(())
}

/// The scenes asked for.
fn scenes(only: &[String]) -> Result<Vec<&'static str>, String> {
    if let Some(unknown) = only
        .iter()
        .find(|name| !Scene::NAMES.contains(&name.as_str()))
    {
        return Err(format!(
            "there is no scene {unknown:?}; there are {}",
            Scene::NAMES.join(", ")
        ));
    }
    let asked = |name: &&str| only.is_empty() || only.iter().any(|asked| asked == name);
    Ok(Scene::NAMES.into_iter().filter(asked).collect())
}
