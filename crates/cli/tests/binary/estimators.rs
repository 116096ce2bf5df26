//! `etalon estimators`: what it measures, what it says, and what it refuses.

use crate::workshop::{Ran, Workshop, cornell_box, small_scene};
use serde_json::Value;

/// Compares on the Cornell box, 32² pixels on one
/// thread: small enough for any machine to finish in seconds, and for other tests to go on.
pub(crate) fn estimators(workshop: &Workshop, further: &[&str]) -> Ran {
    let scene = cornell_box();
    let size = ["-D", "resx=32", "-D", "resy=32", "--threads", "1"];
    workshop.run(&[&["estimators", &scene], &size[..], further].concat())
}

/// The findings of a run that wrote `f.json`.
pub(crate) fn findings(workshop: &Workshop) -> Value {
    serde_json::from_slice(&workshop.read("f.json")).expect("JSON")
}

pub(crate) fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn missing_light_counts_as_error() {
    let workshop = Workshop::new();
    let ran = estimators(
        &workshop,
        &[
            &["--integrators", "path,direct", "--time", "2", "--seed", "3"][..],
            &["--json", "f.json", "--report", "r.html"],
        ]
        .concat(),
    )
    .fine();
    // Nobody looks: results on standard output, nothing else anywhere.
    assert_eq!(ran.stderr, "");
    for words in [
        "equal time",
        "equal samples: ",
        "to 1 % error",
        "reference: rendered with `path`",
        "30 % of the time",
    ] {
        assert!(ran.stdout.contains(words), "{words}: {}", ran.stdout);
    }
    let found = findings(&workshop);
    assert_eq!(
        (&found["format"], &found["seed"], &found["threads"]),
        (&1.into(), &3.into(), &1.into())
    );
    assert_eq!(found["reference"]["origin"]["kind"], "rendered");
    assert!(number(&found["reference"]["rel_mse"]) > 0.0);
    let rows = found["estimators"].as_array().expect("rows");
    let (path, direct) = (&rows[0], &rows[1]);
    assert_eq!(
        (&path["name"], &direct["name"]),
        (&"path".into(), &"direct".into())
    );
    assert!(path["gains"].is_null() && path["differences"].as_array().expect("a list").is_empty());
    for row in rows {
        let at = &row["equal_time"];
        let [error, variance, bias, seconds] = ["rel_mse", "variance", "bias_squared", "seconds"]
            .map(|name| number(&at[name]["value"]));
        // Two ways to the same number, from all pictures and from pairs.
        assert!(
            (error - variance - bias).abs() < 1e-9 * error.abs() + 1e-12,
            "{at}"
        );
        let efficiency = number(&row["efficiency"]["value"]);
        assert!((efficiency * error * seconds - 1.0).abs() < 1e-9, "{row}");
        let interval = &row["efficiency"]["interval"];
        assert!(number(&interval[0]) <= efficiency && efficiency <= number(&interval[1]));
        assert!(number(&at["replicates"]) >= 8.0);
        assert_eq!(
            row["equal_samples"]["samples_per_pixel"],
            rows[0]["equal_samples"]["samples_per_pixel"]
        );
    }
    // A third of the light is missing.
    for difference in direct["differences"].as_array().expect("three") {
        assert!(number(&difference["relative"]) < -0.05, "{difference}");
    }
    let share = |row: &Value| {
        let at = &row["equal_time"];
        number(&at["bias_squared"]["value"]) / number(&at["rel_mse"]["value"])
    };
    assert!(share(direct) > 0.3 && share(path).abs() < 0.3, "{found}");

    let html = String::from_utf8(workshop.read("r.html")).expect("UTF-8");
    assert!(html.starts_with("<!DOCTYPE html>"));
    for foreign in ["http:", "https:", "<script src", "<link", "src=\"/", "url("] {
        assert!(!html.contains(foreign), "{foreign}");
    }
    for part in [
        "name=\"viewport\"",
        "light-dark(",
        "<svg class=\"plot\"",
        "etalon estimators ",
    ] {
        assert!(html.contains(part), "{part}");
    }
    // The reference and a picture by each.
    assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 3);
}

#[test]
fn light_choosers_take_part() {
    let workshop = Workshop::new();
    let lists = ["--light-choosers", "uniform,power,tree", "--time", "3"];
    estimators(&workshop, &[&lists[..], &["--json", "f.json"]].concat()).fine();
    let found = findings(&workshop);
    let rows = found["estimators"].as_array().expect("rows");
    let names: Vec<&Value> = rows.iter().map(|row| &row["name"]).collect();
    assert_eq!(names, ["uniform", "power", "tree"]);
}

#[test]
fn samplers_and_filters_take_part() {
    let workshop = Workshop::new();
    let lists = ["--samplers", "sobol,stratified", "--filters", "box,tent"];
    let further = ["--time", "3", "--json", "f.json"];
    let ran = estimators(&workshop, &[lists, further].concat()).fine();
    let found = findings(&workshop);
    let rows = found["estimators"].as_array().expect("rows");
    let names: Vec<&Value> = rows.iter().map(|row| &row["name"]).collect();
    let expected = [
        "sobol, box",
        "sobol, tent",
        "stratified, box",
        "stratified, tent",
    ];
    assert_eq!(names, expected);
    for row in rows {
        assert_eq!(row["integrator"], "path");
        let steps = row["convergence"]["steps"].as_array().expect("steps");
        // Sizes that every sampler stratifies: powers of four.
        for (power, step) in steps.iter().enumerate() {
            assert_eq!(
                number(&step["samples_per_pixel"]),
                f64::from(1u32 << (2 * power))
            );
        }
        let samples = number(&row["equal_time"]["samples_per_pixel"]);
        let root = samples.sqrt();
        let suits = match row["sampler"].as_str() {
            Some("stratified") => root == root.round(),
            _ => (samples as u64).is_power_of_two(),
        };
        assert!(suits, "{row}");
    }
    assert_eq!(rows[1]["filter"], "tent radius=1");
    assert!(
        ran.stdout.contains("note: the filters differ"),
        "{}",
        ran.stdout
    );
}

#[test]
fn a_file_may_be_the_reference_and_the_seed_decides_the_pictures() {
    let workshop = Workshop::new();
    let size = ["-D", "resx=32", "-D", "resy=32", "-q"];
    workshop.render(
        "converged.exr",
        &[&size[..], &["--spp", "256", "--seed", "9"]].concat(),
    );
    let lists = [
        "--integrators",
        "path,ptracer",
        "--reference",
        "converged.exr",
    ];
    let errors = |seed: &str| -> Vec<Value> {
        let further = ["--time", "1", "--json", "f.json", "--seed", seed];
        let ran = estimators(&workshop, &[&lists[..], &further].concat()).fine();
        let said = "reference: converged.exr by `path`, 256 samples per pixel";
        assert!(ran.stdout.starts_with(said), "{}", ran.stdout);
        let found = findings(&workshop);
        let origin = &found["reference"]["origin"];
        assert_eq!(
            (&origin["kind"], &origin["path"]),
            (&"file".into(), &"converged.exr".into())
        );
        let rows = found["estimators"].as_array().expect("rows");
        rows.iter()
            .map(|row| row["convergence"]["steps"][0]["mse"].clone())
            .collect()
    };
    // How many sizes there are depends on the machine; what is rendered of each does not.
    let first = errors("5");
    assert_eq!(first, errors("5"));
    assert_ne!(first, errors("6"));
    assert_ne!(first[0], first[1]);
}

#[test]
fn a_reference_that_does_not_fit_is_refused() {
    let workshop = Workshop::new();
    workshop.render("small.exr", &["--spp", "2", "-q"]);
    workshop.write("broken.exr", &workshop.read("small.exr")[..300]);
    for (name, words) in [
        ("small.exr", "24 × 20 pixels, the scene's film 32 × 32"),
        ("broken.exr", "broken.exr"),
        ("none.exr", "none.exr"),
    ] {
        let lists = [
            "--integrators",
            "path,direct",
            "--time",
            "9",
            "--reference",
            name,
        ];
        let ran = estimators(&workshop, &lists).refused();
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    }
}

#[test]
fn bad_input_is_diagnosed() {
    let workshop = Workshop::new();
    for (further, words) in [
        (
            &["--integrators", "path,ptracr", "--time", "9"][..],
            "did you mean `ptracer`?",
        ),
        (
            &["--integrators", "path,stokes", "--time", "9"],
            "not built yet",
        ),
        (
            &["--integrators", "path,path", "--time", "9"],
            "`path` is listed twice",
        ),
        (
            &["--integrators", "path", "--time", "9"],
            "`path` alone is no comparison",
        ),
        (&["--time", "9"], "`path` alone is no comparison"),
        (
            &["--integrators", "path,", "--time", "9"],
            "unknown integrator plugin ``",
        ),
        (
            &["--samplers", "sobl,independent", "--time", "9"],
            "did you mean `sobol`?",
        ),
        (
            &["--light-choosers", "power,tre", "--time", "9"],
            "expected one of automatic, uniform, power, tree",
        ),
        (
            &["--light-choosers", "tree,tree", "--time", "9"],
            "`tree` is listed twice",
        ),
        (
            &["--filters", "box,gausian", "--time", "9"],
            "did you mean `gaussian`?",
        ),
        (
            &["--integrators", "path,direct", "--time", "0"],
            "positive number of seconds",
        ),
        (
            &["--integrators", "path,direct", "--time=-1"],
            "positive number of seconds",
        ),
        (
            &["--integrators", "path,direct", "--time", "nan"],
            "positive number of seconds",
        ),
        (
            &["--integrators", "path,direct", "--time", "inf"],
            "positive number of seconds",
        ),
        (
            &["--integrators", "path,direct", "--time", "soon"],
            "--time",
        ),
        (&["--integrators", "path,direct"], "--time"),
        (
            &["--integrators", "path,direct", "--time", "0.001"],
            "are not enough for 2 estimators",
        ),
        (
            &[
                "--integrators",
                "path,direct",
                "--time",
                "9",
                "--reference-share",
                "1",
            ],
            "between 0.01 and 0.9",
        ),
        (
            &[
                "--integrators",
                "path,direct",
                "--time",
                "9",
                "--report",
                "no/r.html",
            ],
            "no/r.html",
        ),
        (
            &[
                "--integrators",
                "path,direct",
                "--time",
                "9",
                "--json",
                "no/f.json",
            ],
            "no/f.json",
        ),
        (
            &[
                "--integrators",
                "path,direct",
                "--time",
                "9",
                "--data",
                "nowhere",
            ],
            "nowhere",
        ),
        (
            &[
                "--integrators",
                "path,direct",
                "--time",
                "9",
                "-D",
                "unused=1",
            ],
            "unused",
        ),
    ] {
        let ran = estimators(&workshop, further).refused();
        assert!(ran.stderr.contains(words), "{further:?}: {}", ran.stderr);
        assert_eq!(ran.stdout, "", "{further:?}");
    }
    assert!(workshop.files().is_empty(), "{:?}", workshop.files());
}

#[test]
fn an_integrator_that_splats_cannot_be_nested() {
    let workshop = Workshop::new();
    let nested = "<integrator type=\"aov\"><string name=\"aovs\" value=\"d:depth\"/>\
        <integrator type=\"path\" name=\"picture\"/></integrator>";
    workshop.write("aov.xml", small_scene(nested));
    let lists = ["estimators", "aov.xml", "--time", "1", "--integrators"];
    let ran = workshop
        .run(&[&lists[..], &["path,ptracer"]].concat())
        .refused();
    assert!(
        ran.stderr.contains("`ptracer` cannot be nested in `aov`"),
        "{}",
        ran.stderr
    );
    let ran = workshop
        .run(&[&lists[..], &["path,direct"]].concat())
        .fine();
    assert!(ran.stdout.contains("aov/direct"), "{}", ran.stdout);
}

/// A black scene is called black, instead of badly measured.
#[test]
fn black_pictures_are_called_black() {
    let workshop = Workshop::new();
    let light = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0 0 0\"/></emitter>";
    let scene = crate::workshop::small_scene("<integrator type=\"path\"/>");
    workshop.write(
        "a.xml",
        scene.replace("<emitter type=\"constant\"/>", light),
    );
    let arguments = [
        "estimators",
        "a.xml",
        "--integrators",
        "path,direct",
        "--time",
        "4",
    ];
    let said = workshop.run(&arguments).fine().stdout;
    let notes: Vec<&str> = said
        .lines()
        .filter(|line| line.starts_with("note: "))
        .collect();
    assert_eq!(notes.len(), 1, "{said}");
    assert!(
        notes[0].starts_with("note: the picture is black: not one sample"),
        "{said}"
    );
}
