//! `--stats FILE.json`.

use crate::workshop::{Workshop, cornell_box};
use serde_json::Value;

#[test]
fn every_figure_is_there() {
    let workshop = Workshop::new();
    let further = [
        "--spp",
        "16",
        "--threads",
        "2",
        "--seed",
        "5",
        "--stats",
        "s.json",
    ];
    workshop.render("a.exr", &further);
    let stats: Value = serde_json::from_slice(&workshop.read("s.json")).expect("JSON");
    let number = |name: &str| {
        stats[name]
            .as_f64()
            .unwrap_or_else(|| panic!("{name} in {stats}"))
    };
    for name in [
        "load_seconds",
        "build_seconds",
        "render_seconds",
        "rays_per_second",
    ] {
        assert!(number(name) >= 0.0);
    }
    assert_eq!(number("samples"), 24.0 * 20.0 * 16.0);
    assert!(number("rays") > number("samples"));
    let rate = number("samples") / number("render_seconds");
    assert!((number("samples_per_second") / rate - 1.0).abs() < 1e-9);
    assert_eq!(number("threads"), 2.0);
    assert_eq!(number("seed"), 5.0);
    assert_eq!(number("spp"), 16.0);
    assert_eq!(number("replicates"), 8.0);
    assert_eq!(number("non_finite"), 0.0);
    assert!(number("mean_relative_standard_error") > 0.0);
    assert_eq!(stats["integrator"], "path");
    assert_eq!(stats["scene"], cornell_box());
    let metadata = workshop.image("a.exr").metadata.expect("metadata");
    assert_eq!(stats["scene_hash"], metadata.scene_hash);
    if cfg!(target_os = "linux") {
        assert!(number("peak_memory_bytes") > 1e6);
    }
}

#[test]
fn a_folder_that_is_not_there_is_found_out_first() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let arguments = ["render", &scene, "-o", "a.exr", "--stats", "nowhere/s.json"];
    let ran = workshop.run(&arguments).refused();
    assert!(ran.stderr.contains("nowhere/s.json"), "{}", ran.stderr);
    assert!(workshop.files().is_empty());
}
