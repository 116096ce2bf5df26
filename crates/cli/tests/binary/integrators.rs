//! `--integrator`: another estimator for the same scene.

use crate::workshop::{Workshop, cornell_box, small_scene};

#[test]
fn max_depth_is_kept() {
    let workshop = Workshop::new();
    // The scene takes its integrator from a parameter, so it can say both.
    for depth in ["2", "5"] {
        let depth = format!("max_depth={depth}");
        let further = ["--spp", "4", "-D", &depth, "-D", "integrator=ptracer"];
        workshop.render("said.exr", &further);
        let further = ["--spp", "4", "-D", &depth, "--integrator", "ptracer"];
        workshop.render("replaced.exr", &further);
        let [said, replaced] = ["said.exr", "replaced.exr"].map(|name| workshop.image(name));
        assert_eq!(said.image, replaced.image, "{depth}");
        assert_eq!(replaced.metadata.expect("metadata").integrator, "ptracer");
    }
    let depth = |depth| {
        workshop.render(
            "a.exr",
            &["--spp", "4", "-D", depth, "--integrator", "ptracer"],
        );
        workshop.image("a.exr").image
    };
    assert_ne!(depth("max_depth=2"), depth("max_depth=5"));
}

#[test]
fn direct_light_has_two_segments_at_most() {
    let workshop = Workshop::new();
    let mean = |integrator: &str, depth: u32| {
        let depth = format!("max_depth={depth}");
        let further = ["--spp", "256", "-D", &depth, "--integrator", integrator];
        workshop.render("a.exr", &further);
        let image = workshop.image("a.exr").image;
        let red = image.channel("R").expect("R");
        red.iter().sum::<f32>() / red.len() as f32
    };
    for depth in [0, 1, 2] {
        let [direct, path] = ["direct", "path"].map(|name| mean(name, depth));
        assert!(
            (direct - path).abs() <= 0.05 * path,
            "{depth}: {direct}, {path}"
        );
    }
    assert_eq!(mean("direct", 2), mean("direct", 7));
}

#[test]
fn the_innermost_is_replaced() {
    let workshop = Workshop::new();
    let nested = "<integrator type=\"aov\"><string name=\"aovs\" value=\"d:depth\"/>\
        <integrator type=\"path\" name=\"picture\"><integer name=\"max_depth\" value=\"3\"/></integrator>\
        </integrator>";
    workshop.write("aov.xml", small_scene(nested));
    let arguments = ["render", "aov.xml", "-o", "a.exr", "--integrator", "direct"];
    workshop.run(&arguments).fine();
    let image = workshop.image("a.exr");
    assert!(image.image.channel("d.T").is_some());
    assert!(image.image.channel("picture.R").is_some());
    assert_eq!(image.metadata.expect("metadata").integrator, "aov/direct");
}

#[test]
fn what_is_of_that_type_already_keeps_its_parameters() {
    let workshop = Workshop::new();
    let naive =
        "<integrator type=\"naive\"><string name=\"directions\" value=\"uniform\"/></integrator>";
    workshop.write("uniform.xml", small_scene(naive));
    let render = |further: &[&str]| {
        let arguments = [
            &["render", "uniform.xml", "-o", "a.exr", "--spp", "4"],
            further,
        ]
        .concat();
        workshop.run(&arguments).fine();
        workshop.image("a.exr").image
    };
    let said = render(&[]);
    assert_eq!(said, render(&["--integrator", "naive"]));
    workshop.write("uniform.xml", small_scene("<integrator type=\"naive\"/>"));
    assert_ne!(said, render(&[]));
}

#[test]
fn another_may_replace_one_that_does_not_exist() {
    let workshop = Workshop::new();
    let stokes = "<integrator type=\"stokes\"><integer name=\"max_depth\" value=\"3\"/>\
        <float name=\"whatever\" value=\"1\"/></integrator>";
    workshop.write("scene.xml", small_scene(stokes));
    workshop
        .run(&["render", "scene.xml", "-o", "a.exr"])
        .refused();
    let arguments = ["render", "scene.xml", "-o", "a.exr", "--integrator", "path"];
    workshop.run(&arguments).fine();
}

#[test]
fn unknown_names_are_refused() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    for (name, words) in [
        ("pathh", "did you mean `path`?"),
        ("forwards", "did you mean `forward`?"),
        ("nave", "did you mean `naive`?"),
        ("stokes", "not built yet"),
    ] {
        let arguments = ["render", &scene, "-o", "a.exr", "--integrator", name];
        let ran = workshop.run(&arguments).refused();
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    }
    assert!(workshop.files().is_empty());
}

#[test]
fn a_scene_without_integrator_gets_one() {
    let workshop = Workshop::new();
    workshop.write("scene.xml", small_scene(""));
    for (further, name) in [(&[][..], "path"), (&["--integrator", "depth"][..], "depth")] {
        let arguments = [&["render", "scene.xml", "-o", "a.exr"], further].concat();
        workshop.run(&arguments).fine();
        let metadata = workshop.image("a.exr").metadata;
        assert_eq!(metadata.expect("metadata").integrator, name);
    }
}
