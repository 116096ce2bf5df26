//! `etalon render`: what the file holds, and what the options change.

use crate::workshop::{Workshop, cornell_box};

#[test]
fn the_file_holds_means_standard_errors_and_metadata() {
    let workshop = Workshop::new();
    let ran = workshop.render("a.exr", &["--spp", "16", "--seed", "7"]);
    assert_eq!(workshop.files(), ["a.exr"]);
    let image = workshop.image("a.exr");
    let names: Vec<&str> = image
        .image
        .channels()
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    let errors = ["R", "G", "B"].map(|c| format!("standard_error.{c}"));
    for name in ["R", "G", "B"]
        .into_iter()
        .chain(errors.iter().map(String::as_str))
    {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    assert_eq!(names.len(), 6);
    assert_eq!((image.image.width(), image.image.height()), (24, 20));
    let plane = |name| image.image.channel(name).expect("a channel");
    assert!(plane("R").iter().any(|v| *v > 0.01));
    assert!(plane("standard_error.G").iter().any(|v| *v > 0.0));
    assert!(
        image
            .image
            .channels()
            .iter()
            .all(|c| c.samples.iter().all(|v| v.is_finite()))
    );

    let metadata = image.metadata.as_ref().expect("metadata");
    assert_eq!(metadata.scene, cornell_box());
    assert_eq!(metadata.scene_hash.len(), 16);
    assert_eq!(metadata.integrator, "path");
    assert_eq!(
        (metadata.spp, metadata.replicates, metadata.seed),
        (16, 8, 7)
    );
    assert_eq!(metadata.version, env!("CARGO_PKG_VERSION"));
    assert_eq!(
        metadata.floating_point,
        etalon_film::floating_point_fingerprint()
    );
    assert_eq!(metadata.faults.total(), 0);
    for side in [Some(16), Some(64), None] {
        let tiles = metadata.tiles(side).expect("tile means");
        assert_eq!((tiles.replicates(), tiles.channels()), (8, 3));
    }

    let last = ran.stderr.lines().last().expect("a final line");
    for word in [
        "a.exr: ",
        " s, ",
        " M samples/s, ",
        " M rays/s, ",
        "standard error",
    ] {
        assert!(last.contains(word), "{word:?} in {last:?}");
    }
    assert!(!ran.stderr.contains('\u{1b}'), "no bar where nobody looks");
}

#[test]
fn seconds_are_recorded_unless_the_file_shall_be_reproducible() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let arguments = [
        "render", &scene, "-o", "a.exr", "-D", "resx=8", "-D", "resy=8", "-q",
    ];
    let seconds = || workshop.image("a.exr").metadata.expect("metadata").seconds;
    let status = workshop
        .command()
        .args(arguments)
        .env_remove("SOURCE_DATE_EPOCH")
        .status();
    assert!(status.expect("it runs").success());
    assert!(seconds().is_some_and(|s| s > 0.0));
    workshop.run(&arguments).fine();
    assert_eq!(seconds(), None);
}

#[test]
fn samples_are_rounded_up_and_that_is_said() {
    let workshop = Workshop::new();
    let spp = |further: &[&str]| {
        let ran = workshop.render("a.exr", further);
        let metadata = workshop.image("a.exr").metadata.expect("metadata");
        (ran.stderr, metadata.spp, metadata.replicates)
    };
    let (said, spp20, replicates) = spp(&["--spp", "20"]);
    assert_eq!((spp20, replicates), (24, 8));
    let note = "note: 24 samples per pixel instead of 20: 8 replicates of 3\n";
    assert!(said.contains(note), "{said}");
    let (said, spp16, _) = spp(&["--spp", "16"]);
    assert_eq!(spp16, 16);
    assert!(!said.contains("instead of"), "{said}");
    let (_, spp4, replicates) = spp(&["--spp", "4"]);
    assert_eq!((spp4, replicates), (4, 4));
    let (_, spp12, replicates) = spp(&["--spp", "12", "--replicates", "3"]);
    assert_eq!((spp12, replicates), (12, 3));
}

#[test]
fn one_replicate_has_no_standard_error() {
    let workshop = Workshop::new();
    let ran = workshop.render("a.exr", &["--spp", "8", "--replicates", "1"]);
    assert!(ran.stderr.contains("no standard error (one replicate)"));
    let image = workshop.image("a.exr");
    assert_eq!(image.image.channels().len(), 3);
    assert_eq!(image.metadata.expect("metadata").replicates, 1);
    workshop.render("b.exr", &["--spp", "8", "--seed", "1"]);
    let compared = workshop.run(&["compare", "b.exr", "a.exr"]);
    assert_eq!(compared.code, Some(3), "{}", compared.stderr);
    assert!(compared.stdout.contains("single replicate"));
}

#[test]
fn quiet_says_nothing() {
    let workshop = Workshop::new();
    let ran = workshop.render("a.exr", &["--spp", "20", "--quiet"]);
    assert_eq!((ran.stdout.as_str(), ran.stderr.as_str()), ("", ""));
}

#[test]
fn scene_parameters_are_given_on_the_command_line() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "1", "-D", "max_depth=1"]);
    let dark = workshop.image("a.exr").image;
    workshop.render("b.exr", &["--spp", "1", "-D", "max_depth=4"]);
    let lit = workshop.image("b.exr").image;
    let sum = |image: &etalon_images::Image| image.channel("G").expect("G").iter().sum::<f32>();
    assert!(sum(&dark) < sum(&lit));
    let scene = cornell_box();
    let ran = workshop
        .run(&["render", &scene, "-o", "c.exr", "-D", "resz=4"])
        .refused();
    assert!(ran.stderr.contains("resz"), "{}", ran.stderr);
    let ran = workshop
        .run(&["render", &scene, "-o", "c.exr", "-D", "resx"])
        .refused();
    assert!(ran.stderr.contains("key=value"), "{}", ran.stderr);
    assert_eq!(workshop.files(), ["a.exr", "b.exr"]);
}

#[test]
fn simpler_formats_hold_the_colours() {
    let workshop = Workshop::new();
    for name in ["a.hdr", "a.pfm", "a.exr"] {
        workshop.render(name, &["--spp", "2"]);
    }
    assert!(workshop.read("a.hdr").starts_with(b"#?RADIANCE"));
    assert!(workshop.read("a.pfm").starts_with(b"PF\n24 20\n"));
    let exr = workshop.image("a.exr").image;
    let pfm = etalon_images::raster_file::read(&workshop.path("a.pfm")).expect("readable");
    let red: Vec<f32> = pfm.to_linear().iter().step_by(3).copied().collect();
    assert_eq!(exr.channel("R").expect("R"), red);
}

#[test]
fn a_scene_without_light_is_black() {
    let workshop = Workshop::new();
    let scene = crate::workshop::small_scene("").replace("<emitter type=\"constant\"/>", "");
    workshop.write("dark.xml", scene);
    workshop.run(&["render", "dark.xml", "-o", "a.exr"]).fine();
    let ptracer = [
        "render",
        "dark.xml",
        "-o",
        "b.exr",
        "--integrator",
        "ptracer",
    ];
    workshop.run(&ptracer).fine();
    for name in ["a.exr", "b.exr"] {
        let image = workshop.image(name).image;
        for channel in image.channels() {
            assert!(
                channel.samples.iter().all(|v| *v == 0.0),
                "{}",
                channel.name
            );
        }
    }
}
