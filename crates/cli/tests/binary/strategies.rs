//! `etalon render --strategies`: the techniques of `bdpt` are parts of a whole.

use crate::workshop::{Workshop, cornell_box};

#[test]
fn weighted_techniques_add_up_to_the_whole() {
    let workshop = Workshop::new();
    let further = [
        "--integrator",
        "bdpt",
        "--spp",
        "4",
        "-D",
        "max_depth=3",
        "--strategies",
        "parts",
    ];
    workshop.render("whole.exr", &further);
    let whole = workshop.image("whole.exr").image;
    let names = [
        "s0-t2", "s0-t3", "s1-t2", "s2-t1", "s0-t4", "s1-t3", "s2-t2", "s3-t1",
    ];
    let mut sum = vec![0.0_f64; whole.width() * whole.height()];
    for name in names {
        let part = workshop.image(&format!("parts/{name}.exr")).image;
        let plane = part.channel("G").expect("green");
        for (sum, value) in sum.iter_mut().zip(plane) {
            *sum += f64::from(*value);
        }
        // Alone, each finds light.
        let alone = workshop.image(&format!("parts/{name}-unweighted.exr"));
        let plane = alone.image.channel("G").expect("green");
        assert!(plane.iter().any(|value| *value > 0.0), "{name}");
    }
    // The same samples, so that only rounding is between them. Mutant rejected: a technique left
    // out.
    for (sum, value) in sum.iter().zip(whole.channel("G").expect("green")) {
        let value = f64::from(*value);
        assert!(
            (sum - value).abs() <= 1e-4 * value.abs() + 1e-6,
            "{sum} {value}"
        );
    }
    let page = String::from_utf8(workshop.read("parts/strategies.html")).expect("text");
    assert!(page.contains("Exposure of all pictures") && page.contains("data-picture"));
    assert!(!workshop.path("parts/s1-t1.exr").exists());
}

#[test]
fn techniques_are_those_of_bdpt_with_a_limit() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let refused = |further: &[&str], words: &str| {
        let first = ["render", &scene, "-o", "a.exr", "--strategies", "parts"];
        let arguments: Vec<&str> = first.iter().chain(further).copied().collect();
        let ran = workshop.run(&arguments).refused();
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
        assert!(workshop.files().is_empty());
    };
    refused(&[], "--integrator bdpt");
    refused(&["--integrator", "bdpt", "-D", "max_depth=-1"], "max_depth");
}

#[test]
fn a_technique_that_is_none_is_refused() {
    let workshop = Workshop::new();
    for (parameters, words) in [
        ("<integer name=\"s\" value=\"1\"/>", "both `s` and `t`"),
        (
            "<integer name=\"s\" value=\"1\"/><integer name=\"t\" value=\"1\"/>",
            "no such technique",
        ),
        (
            "<integer name=\"s\" value=\"-1\"/><integer name=\"t\" value=\"2\"/>",
            "number of vertices",
        ),
    ] {
        let integrator = format!("<integrator type=\"bdpt\">{parameters}</integrator>");
        workshop.write("scene.xml", crate::workshop::small_scene(&integrator));
        let ran = workshop
            .run(&["render", "scene.xml", "-o", "a.exr"])
            .refused();
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    }
}
