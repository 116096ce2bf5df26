//! Same seed, same bits: whatever the number of threads, in every channel and tile mean.

use crate::workshop::{Workshop, cornell_box, small_scene};

const AOVS: &str = "d:depth,p:position,uv:uv,n:sh_normal,g:geo_normal,a:albedo,i:prim_index,s:shape_index,du:dp_du,x:duv_dx";

/// Renders with 1, 2 and 16 threads; the files must be equal byte for byte. Says how many
/// channels there are.
#[track_caller]
fn same_bits(workshop: &Workshop, scene: &str, further: &[&str]) -> usize {
    let render = |name: &str, threads: &str| {
        let mut arguments = vec!["render", scene, "-o", name, "--threads", threads, "-q"];
        arguments.extend(further);
        workshop.run(&arguments).fine();
        workshop.read(name)
    };
    let one = render("1.exr", "1");
    assert!(one == render("2.exr", "2"), "1 and 2 threads differ");
    assert!(one == render("16.exr", "16"), "1 and 16 threads differ");
    workshop.image("1.exr").image.channels().len()
}

#[test]
fn of_the_integrators_for_light() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    for integrator in [
        "path", "direct", "ptracer", "bdpt", "pssmlt", "mmlt", "depth",
    ] {
        let size = ["-D", "resx=40", "-D", "resy=36", "--spp", "16"];
        let further = [&size[..], &["--integrator", integrator]].concat();
        assert_eq!(same_bits(&workshop, &scene, &further), 6, "{integrator}");
    }
}

#[test]
fn of_nested_integrators() {
    let workshop = Workshop::new();
    let path = "<integrator type=\"path\" name=\"picture\"/>";
    let aov = format!(
        "<integrator type=\"aov\"><string name=\"aovs\" value=\"{AOVS}\"/>{path}</integrator>"
    );
    workshop.write("aov.xml", small_scene(&aov));
    // The colour, the nested picture with alpha, and 1 + 3 + 2 + 3 + 3 + 3 + 1 + 1 + 3 + 2
    // variables; each with its standard error.
    assert_eq!(same_bits(&workshop, "aov.xml", &[]), 2 * (3 + 4 + 22));
    let moment = format!("<integrator type=\"moment\">{path}</integrator>");
    workshop.write("moment.xml", small_scene(&moment));
    assert_eq!(same_bits(&workshop, "moment.xml", &[]), 2 * (3 + 3 + 3));
}

#[test]
fn of_splats_through_a_wide_filter() {
    let workshop = Workshop::new();
    workshop.write(
        "gaussian.xml",
        small_scene("<integrator type=\"ptracer\"/>"),
    );
    same_bits(&workshop, "gaussian.xml", &["--spp", "64"]);
}

#[test]
fn of_all_samplers() {
    let workshop = Workshop::new();
    for sampler in ["independent", "stratified", "sobol"] {
        let scene = small_scene("").replace("\"independent\"", &format!("\"{sampler}\""));
        workshop.write("scene.xml", scene);
        same_bits(&workshop, "scene.xml", &["--seed", "3"]);
    }
}

#[test]
fn other_seeds_give_other_pictures() {
    let workshop = Workshop::new();
    let picture = |seed: &str| {
        workshop.render("a.exr", &["--spp", "4", "--seed", seed]);
        workshop.image("a.exr").image
    };
    let first = picture("1");
    assert_ne!(first, picture("2"));
    assert_ne!(first, picture("18446744073709551615"));
    assert_eq!(first, picture("1"));
}
