//! Samples that went wrong: refused numbers and fireflies, in `--stats` and on standard error.

use crate::workshop::{Workshop, small_scene};
use serde_json::Value;
use std::path::Path;

fn stats(workshop: &Workshop) -> Value {
    serde_json::from_slice(&workshop.read("s.json")).expect("JSON")
}

/// Runs a command that a render told: `etalon …`.
fn run_told(workshop: &Workshop, command: &Value) -> String {
    let command = command.as_str().expect("a command");
    let words: Vec<&str> = command.split(' ').collect();
    assert_eq!(words[0], "etalon");
    workshop.run(&words[1..]).fine().stdout
}

/// The largest of the colours that a replay says were delivered.
fn largest(said: &str) -> f64 {
    let line = said.lines().find(|line| line.starts_with("radiance ("));
    let line = line
        .expect("radiance is delivered")
        .replace("radiance (", "");
    let (colours, _) = line.split_once(')').expect("colours");
    let numbers = colours
        .split(", ")
        .map(|c| c.parse::<f64>().expect("a number"));
    numbers.fold(0.0, f64::max)
}

#[test]
fn the_largest_fireflies_can_be_looked_at() {
    let workshop = Workshop::new();
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let scene = scenes
        .join("caustic-sphere/scene.xml")
        .display()
        .to_string();
    let options = [
        "--integrator",
        "path",
        "-D",
        "resx=32",
        "-D",
        "resy=24",
        "--spp",
        "128",
        "--seed",
        "3",
    ];
    let render = |further: &[&str]| {
        let arguments = ["render", &scene, "-o", "a.exr", "--stats", "s.json"];
        workshop
            .run(&[&arguments[..], &options, further].concat())
            .fine()
    };
    let ran = render(&[]);
    let told = stats(&workshop);
    let flies = &told["fireflies"];
    let count = flies["count"].as_u64().expect("a count");
    assert!(count > 0, "{flies}");
    assert!(ran.stderr.contains("firefl"), "{}", ran.stderr);
    let kept = flies["largest"].as_array().expect("a list");
    assert_eq!(kept.len() as u64, count.min(8));
    let mut before = f64::INFINITY;
    for fly in kept {
        let number = |name: &str| fly[name].as_f64().expect("a number");
        assert!(
            number("lift") <= before && number("lift") >= flies["mean"].as_f64().expect("a mean")
        );
        before = number("lift");
        // All replicates together have 128 samples.
        assert!(
            (number("value") / 128.0 / number("lift") - 1.0).abs() < 1e-5,
            "{fly}"
        );
        let said = run_told(&workshop, &fly["replay"]);
        let ratio = largest(&said) / number("value");
        assert!((ratio - 1.0).abs() < 1e-5, "{fly}: {said}");
    }
    let replay = kept[0]["replay"].as_str().expect("a command");
    assert!(ran.stderr.contains(replay), "{}", ran.stderr);
    // The same, whoever renders what when.
    render(&["--threads", "1", "-q"]);
    assert_eq!(stats(&workshop)["fireflies"], *flies);
    assert!(render(&["-q"]).stderr.is_empty());
}

#[test]
fn an_even_picture_has_none() {
    let workshop = Workshop::new();
    workshop.write("a.xml", small_scene(""));
    let arguments = [
        "render", "a.xml", "-o", "a.exr", "--stats", "s.json", "--spp", "256",
    ];
    let ran = workshop.run(&arguments).fine();
    assert!(!ran.stderr.contains("firefl"), "{}", ran.stderr);
    let flies = &stats(&workshop)["fireflies"];
    assert_eq!(flies["count"], 0);
    assert_eq!(flies["largest"], serde_json::json!([]));
}

#[test]
fn refused_numbers_say_how_to_draw_them_again() {
    let workshop = Workshop::new();
    // Beyond the range of the film's sums.
    let sky = "<emitter type=\"constant\"><spectrum name=\"radiance\" value=\"1e16\"/></emitter>";
    let scene = small_scene("").replace("<emitter type=\"constant\"/>", sky);
    workshop.write("a.xml", scene);
    let arguments = [
        "render", "a.xml", "-o", "a.exr", "--stats", "s.json", "--spp", "32", "--seed", "4",
    ];
    let ran = workshop.run(&arguments).fine();
    let stats = stats(&workshop);
    let faults = &stats["faults"];
    assert_eq!(faults["overflow"], stats["non_finite"]);
    assert_eq!(faults["nan"], 0);
    let first = &faults["first"][0];
    assert_eq!(first["kind"], "overflow");
    assert_eq!(first["source"], "radiance");
    assert_eq!(first["seed"], 4);
    let replay = first["replay"].as_str().expect("a command");
    assert!(ran.stderr.contains(replay), "{}", ran.stderr);
    assert!(largest(&run_told(&workshop, &first["replay"])) > 1e14);
}

#[test]
fn a_filter_that_splats_never_hit_takes_no_light_away() {
    let mean = |integrator: &str, radius: f64| {
        let workshop = Workshop::new();
        let tent =
            format!("<rfilter type=\"tent\"><float name=\"radius\" value=\"{radius}\"/></rfilter>");
        let scene = small_scene(&format!("<integrator type=\"{integrator}\"/>"));
        let width = "<integer name=\"width\"";
        workshop.write("a.xml", scene.replace(width, &format!("{tent}{width}")));
        let arguments = ["render", "a.xml", "-o", "a.exr", "--spp", "256"];
        workshop.run(&arguments).fine();
        let image = workshop.image("a.exr").image;
        let green = image.channel("G").expect("G");
        green.iter().sum::<f32>() / green.len() as f32
    };
    for integrator in ["bdpt", "vcm"] {
        let [narrow, path] = [integrator, "path"].map(|name| mean(name, 1e-9));
        // Mutant rejected: connections with the camera keep their share, and never arrive.
        assert!(
            (narrow / path - 1.0).abs() < 0.01,
            "{integrator}: {narrow}, {path}"
        );
    }
}

#[test]
fn what_turns_out_black_is_said() {
    // Paths are too short to find what the sky shines on.
    let short = "<integrator type=\"path\"><integer name=\"max_depth\" value=\"1\"/><boolean name=\"hide_emitters\" value=\"true\"/></integrator>";
    let workshop = Workshop::new();
    workshop.write("a.xml", small_scene(short));
    let ran = workshop.run(&["render", "a.xml", "-o", "a.exr"]).fine();
    let said = "warning: the picture is black";
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
    assert!(!ran.stderr.contains("standard error"), "{}", ran.stderr);
}
