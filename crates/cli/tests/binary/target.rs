//! `render --error` and `render --time`.

use crate::workshop::{Workshop, cornell_box, small_scene};
use serde_json::Value;

fn stats(workshop: &Workshop, name: &str) -> Value {
    serde_json::from_slice(&workshop.read(name)).expect("JSON")
}

#[test]
fn an_error_is_reached_with_samples_that_one_could_have_asked_for() {
    let workshop = Workshop::new();
    for (error, integrator) in [("0.2", "path"), ("0.2", "guided"), ("0.4", "ptracer")] {
        let further = [
            "--error",
            error,
            "--integrator",
            integrator,
            "--stats",
            "s.json",
        ];
        workshop.render("a.exr", &further);
        let stats = stats(&workshop, "s.json");
        let number = |name: &str| stats[name].as_f64().expect("a number");
        let reached = number("relative_standard_error");
        let aim: f64 = error.parse().expect("a number");
        assert!(reached <= aim, "{integrator}: {reached} of {aim}");
        // Not far more than is needed: a factor of four in samples covers the bound and the rounding.
        assert!(reached > 0.5 * aim, "{integrator}: {reached} of {aim}");
        assert_eq!(number("pilot_spp"), 64.0);
        assert!(number("pilot_seconds") > 0.0);
        // The pilot leaves no trace: asked for by number, the same samples are drawn.
        let spp = number("spp").to_string();
        let replicates = number("replicates").to_string();
        let by_number = [
            "--spp",
            &spp,
            "--replicates",
            &replicates,
            "--integrator",
            integrator,
        ];
        workshop.render("b.exr", &by_number);
        let (a, b) = (workshop.image("a.exr"), workshop.image("b.exr"));
        assert_eq!(a.image, b.image);
    }
}

#[test]
fn what_is_aimed_at_is_said() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let size = ["-D", "resx=24", "-D", "resy=20"];
    let arguments = [
        "render", &scene, "-o", "a.exr", "--error", "0.2", "--pilot", "32",
    ];
    let arguments: Vec<&str> = arguments.into_iter().chain(size).collect();
    let ran = workshop.run(&arguments).fine();
    assert!(
        ran.stderr.contains("after a pilot of 32 samples"),
        "{}",
        ran.stderr
    );
    assert!(ran.stderr.contains("of 20 % aimed at"), "{}", ran.stderr);
}

#[test]
fn a_time_fixes_the_number_of_samples() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--time", "1", "--stats", "s.json"]);
    let stats = stats(&workshop, "s.json");
    assert!(stats["spp"].as_f64().expect("spp") >= 8.0, "{stats}");
    let whole = |name: &str| stats[name].as_f64().expect("seconds");
    // Somewhere near, on whatever machine, whoever else is at work there.
    let seconds = whole("render_seconds") + whole("pilot_seconds");
    assert!((0.05..20.0).contains(&seconds), "{seconds} s");
}

#[test]
fn targets_that_make_no_sense_are_refused() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let cases: [(&[&str], &str); 8] = [
        (&["--error", "0"], "0.01 for 1 %"),
        (&["--error", "nan"], "0.01 for 1 %"),
        (&["--error", "2"], "0.01 for 1 %"),
        (&["--time=-1"], "number of seconds"),
        (&["--time", "0"], "number of seconds"),
        (&["--error", "0.1", "--spp", "4"], "cannot be used with"),
        (&["--error", "0.1", "--time", "4"], "cannot be used with"),
        (&["--time", "4", "--part", "1/2"], "cannot be used with"),
    ];
    for (further, expected) in cases {
        let arguments = ["render", &scene, "-o", "a.exr"];
        let arguments: Vec<&str> = arguments.iter().chain(further).copied().collect();
        let ran = workshop.run(&arguments).refused();
        assert!(ran.stderr.contains(expected), "{further:?}: {}", ran.stderr);
    }
    // In the dark no error is relative to anything.
    let dark = small_scene(
        "<integrator type=\"path\"><integer name=\"max_depth\" value=\"0\"/></integrator>",
    );
    workshop.write("dark.xml", dark);
    let ran = workshop
        .run(&["render", "dark.xml", "-o", "a.exr", "--error", "0.1"])
        .refused();
    assert!(ran.stderr.contains("found no light"), "{}", ran.stderr);
    let lit = small_scene("");
    workshop.write("lit.xml", lit);
    let arguments = ["render", "lit.xml", "-o", "a.exr", "--error", "0.000001"];
    let ran = workshop.run(&arguments).refused();
    assert!(
        ran.stderr.contains("aim at a larger error"),
        "{}",
        ran.stderr
    );
    assert_eq!(workshop.files().len(), 2);
}
