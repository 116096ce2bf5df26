//! `etalon render --replay`: a sample drawn again is the sample that was drawn.

use crate::workshop::{Workshop, cornell_box, small_scene};

/// The four numbers that a replay says were delivered: red, green, blue, alpha.
fn delivered(said: &str) -> [f64; 4] {
    let line = said.lines().find(|line| line.starts_with("radiance "));
    let numbers: Vec<f64> = line
        .expect("radiance is delivered")
        .split(|c: char| !(c.is_ascii_alphanumeric() || ".-".contains(c)))
        .filter_map(|word| word.parse().ok())
        .collect();
    numbers.try_into().expect("four numbers")
}

/// Matter that varies over the surface.
const WALK: &str = "<subsurface type=\"randomwalk\"><float name=\"mean_free_path\" value=\"0.1\"/>
    <texture type=\"checkerboard\" name=\"albedo\"><float name=\"color0\" value=\"0.9\"/><float name=\"color1\" value=\"0.3\"/>
    <transform name=\"to_uv\"><scale value=\"9\"/></transform></texture></subsurface>";

/// A pixel is the mean of its samples, replayed one by one; rounding to single precision lies
/// between. Mutants rejected: the sample's number or the replicate forgotten, another sampler; a walk that is not told where it
/// enters.
#[test]
fn a_pixel_is_the_mean_of_its_samples_replayed() {
    for sampler in ["independent", "stratified", "sobol"] {
        for (integrator, below) in [("path", ""), ("naive", ""), ("path", WALK)] {
            let workshop = Workshop::new();
            let scene = small_scene("").replace("independent", sampler);
            let ball = "name=\"radius\" value=\"0.5\"/>";
            let scene = scene.replace(ball, &format!("{ball}{below}")).replace(
                "<film type=\"hdrfilm\">",
                "<film type=\"hdrfilm\"><rfilter type=\"box\"/><string name=\"pixel_format\" value=\"rgba\"/>",
            );
            workshop.write("a.xml", scene);
            let common = [
                "--integrator",
                integrator,
                "--spp",
                "8",
                "--replicates",
                "2",
                "--seed",
                "9",
            ];
            let arguments = [&["render", "a.xml", "-o", "a.exr"][..], &common].concat();
            workshop.run(&arguments).fine();
            let image = workshop.image("a.exr").image;
            let mut mean = [0.0; 4];
            for (replicate, sample) in (0..2).flat_map(|r| (0..4).map(move |s| (r, s))) {
                let address = format!("11,7,{replicate},{sample}");
                let arguments = [&["render", "a.xml", "--replay", &address][..], &common].concat();
                let said = workshop.run(&arguments).fine().stdout;
                let met = said.contains("surface at") && said.contains("diffuse");
                assert!(met || !below.is_empty(), "{said}");
                for (mean, value) in mean.iter_mut().zip(delivered(&said)) {
                    *mean += value / 8.0;
                }
            }
            let pixel = 7 * image.width() + 11;
            for (name, mean) in ["R", "G", "B", "A"].into_iter().zip(mean) {
                let value = f64::from(image.channel(name).expect("a channel")[pixel]);
                assert!(
                    (value - mean).abs() <= 1e-6 * value.abs(),
                    "{sampler}, {integrator}, {name}: {value} {mean}"
                );
            }
            assert_eq!(workshop.files(), ["a.exr", "a.xml"]);
        }
    }
}

/// What a reader looks for is there, for every kind of estimator.
#[test]
fn every_estimator_can_be_replayed() {
    let scene = cornell_box();
    for (integrator, words) in [
        ("path", &["light 0 sampled", "arrives", "f/p", "p/p₀"][..]),
        ("direct", &["light 0 sampled", "scatters along"]),
        ("bdpt", &["walk 2: ", "light 0 emits", "splat at raster"]),
        ("ptracer", &["light 0 emits", "the camera"]),
        ("naive", &["scatters along"]),
        ("ao", &["radiance ("]),
        ("depth", &["radiance ("]),
        ("distribution", &["light 0 sampled", "radiance ("]),
        ("vcm", &["walk 2: ", "toward (", "radiance ("]),
        ("sppm", &["toward (", "radiance ("]),
        ("photonmap", &["toward (", "radiance ("]),
        ("guided", &["is known to it only", "radiance ("]),
        ("pssmlt", &["radiance ("]),
        ("mmlt", &["radiance ("]),
    ] {
        let arguments = [
            "render",
            &scene,
            "--replay",
            "100,200,0,3",
            "--integrator",
            integrator,
        ];
        let said = Workshop::new().run(&arguments).fine().stdout;
        for word in ["wavelengths [", "camera ray at raster (100."]
            .iter()
            .chain(words)
        {
            assert!(said.contains(word), "{integrator}: no `{word}` in\n{said}");
        }
    }
}

/// A sample without a share of the chains delivers nothing, and one with a share tells path by path: walks are counted from
/// each camera ray.
#[test]
fn chains_are_told_path_by_path() {
    for integrator in ["pssmlt", "mmlt"] {
        let workshop = Workshop::new();
        let xml = format!(
            "<integrator type=\"{integrator}\"><integer name=\"max_depth\" value=\"6\"/></integrator>"
        );
        workshop.write("a.xml", small_scene(&xml));
        let replay = |address: &str| {
            let ran = workshop.run(&["render", "a.xml", "--replay", address]);
            ran.fine().stdout
        };
        let said = replay("0,0,0,0");
        let paths = said.matches("camera ray at raster").count();
        assert!(paths > 100 && said.contains("splat at raster"), "{said}");
        assert!(!said.contains("walk 3: "), "{said}");
        assert!(!replay("0,0,0,1").contains("splat"));
    }
}

#[test]
fn samples_that_are_not_there() {
    let workshop = Workshop::new();
    workshop.write("a.xml", small_scene(""));
    for (address, words) in [
        (
            "22,0,0,0",
            "columns 0 to 19 and rows 0 to 11, and samples up to 2 pixels around them",
        ),
        ("0,-3,0,0", "no pixel (0, -3)"),
        ("0,0,8,0", "no replicate 8: with these options there are 8"),
        ("0,0,0,2", "no sample 2: with these options there are 2"),
        ("0,0,0", "expected four numbers"),
        ("0,0,0,-1", "expected four numbers"),
    ] {
        let ran = workshop
            .run(&["render", "a.xml", "--replay", address])
            .refused();
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    }
    // Those around the film count for pixels in it.
    let around = workshop.run(&["render", "a.xml", "--replay", "-2,13,0,0"]);
    let said = around.fine().stdout;
    assert!(
        said.contains("pixel (-2, 13)") && said.contains("camera ray at raster (-1."),
        "{said}"
    );
    // Either a picture or a replay.
    let both = ["render", "a.xml", "-o", "a.exr", "--replay", "0,0,0,0"];
    workshop.run(&both).refused();
    assert_eq!(workshop.files(), ["a.xml"]);
}

/// What a replay would ignore is refused.
#[test]
fn a_replay_measures_keeps_and_splits_nothing() {
    let workshop = Workshop::new();
    workshop.write("a.xml", small_scene(""));
    for more in [
        &["--stats", "a.json"][..],
        &["--resume"],
        &["--strategies", "folder"],
        &["--part", "1/2"],
        &["--error", "0.1"],
        &["--time", "1"],
        &["-o", "a.exr"],
    ] {
        let arguments = [&["render", "a.xml", "--replay", "0,0,0,0"][..], more].concat();
        let ran = workshop.run(&arguments).refused();
        let words = "cannot be used with";
        assert!(ran.stderr.contains(words), "{more:?}: {}", ran.stderr);
    }
    assert_eq!(workshop.files(), ["a.xml"]);
}
