//! `etalon denoise`, and `render --features` before it.

use crate::workshop::{Workshop, cornell_box};
use etalon_film::RenderedImage;

/// A picture of the Cornell box, 96 pixels wide, with these options.
fn boxed(workshop: &Workshop, output: &str, further: &[&str]) {
    let scene = cornell_box();
    let chosen = ["render", &scene, "-o", output, "--size", "96x96", "-q"];
    workshop.run(&[&chosen[..], further].concat()).fine();
}

/// The mean over pixels and colours, and that of each tile of 16² pixels, of a square relative to the reference's.
fn relative(reference: &RenderedImage, square: impl Fn(&str, usize) -> f64) -> (f64, Vec<f64>) {
    let mut tiles = vec![0.0; 36];
    for name in ["R", "G", "B"] {
        let known = reference.image.channel(name).expect("a colour");
        for (i, known) in known.iter().enumerate() {
            let known = f64::from(*known);
            let tile = i / 96 / 16 * 6 + i % 96 / 16;
            tiles[tile] += square(name, i) / (known * known + 0.01) / 768.0;
        }
    }
    (tiles.iter().sum::<f64>() / 36.0, tiles)
}

/// The same, of an image's error against the reference.
fn error(image: &RenderedImage, reference: &RenderedImage) -> (f64, Vec<f64>) {
    relative(reference, |name, i| {
        let value = |image: &RenderedImage| image.image.channel(name).expect("a colour")[i];
        f64::from(value(image) - value(reference)).powi(2)
    })
}

#[test]
fn errors_fall_and_are_what_is_said_of_them() {
    let workshop = Workshop::new();
    boxed(
        &workshop,
        "reference.exr",
        &["--spp", "1024", "--seed", "99"],
    );
    boxed(&workshop, "noisy.exr", &["--spp", "32", "--features"]);
    let ran = workshop
        .run(&["denoise", "noisy.exr", "-o", "quiet.exr"])
        .fine();
    assert!(ran.stderr.contains("quiet.exr: mean relative error about"));
    let [reference, noisy, quiet] =
        ["reference.exr", "noisy.exr", "quiet.exr"].map(|name| workshop.image(name));
    let (before, tiles_before) = error(&noisy, &reference);
    let (after, tiles_after) = error(&quiet, &reference);
    // The smaller the picture, the more of it are edges: at 64 x 64 pixels a third of the error is left. Mutants rejected: the
    // picture as it came; a window's mean, which is worse in some tiles.
    assert!(after < 0.25 * before, "{after} {before}");
    for (after, before) in tiles_after.iter().zip(tiles_before) {
        assert!(*after < 1.05 * before, "{after} {before}");
    }
    let stated = |name: &str, i: usize| {
        let error = quiet.standard_error(name).expect("an estimate")[i];
        f64::from(error).powi(2)
    };
    let (stated, _) = relative(&reference, stated);
    let ratio = (stated / after).sqrt();
    assert!((0.5..2.0).contains(&ratio), "{ratio}");
}

#[test]
fn features_leave_the_picture_as_it_is() {
    let workshop = Workshop::new();
    workshop.render(
        "plain.exr",
        &["--spp", "8", "--independent-replicates", "-q"],
    );
    workshop.render("features.exr", &["--spp", "8", "--features", "-q"]);
    let [plain, features] = ["plain.exr", "features.exr"].map(|name| workshop.image(name));
    for name in ["R", "G", "B"] {
        assert_eq!(plain.image.channel(name), features.image.channel(name));
        assert_eq!(plain.standard_error(name), features.standard_error(name));
    }
    for name in [
        "half.G",
        "albedo.R",
        "normal.Z",
        "depth.T",
        "standard_error.depth.T",
    ] {
        assert!(features.image.channel(name).is_some(), "{name}");
    }
    // The first half is what a render of half as many replicates is. Mutant rejected: every other replicate.
    let half = ["--spp", "8", "--features", "-q", "--part", "1/2"];
    workshop
        .run(&[&["render", "scene.xml", "-o", "part.exr"][..], &half].concat())
        .refused();
    let half = [
        "--spp",
        "8",
        "--independent-replicates",
        "-q",
        "--part",
        "1/2",
    ];
    workshop.render("part.exr", &half);
    let part = workshop.image("part.exr");
    assert_eq!(part.image.channel("G"), features.image.channel("half.G"));
    let ran = workshop.run(&["info", "features.exr"]).fine();
    assert!(ran.stdout.contains("features     of 16 samples per pixel"));
}

#[test]
fn denoised_pictures_are_marked_and_decide_nothing() {
    let workshop = Workshop::new();
    workshop.render("plain.exr", &["--spp", "8", "-q"]);
    workshop.render("features.exr", &["--spp", "8", "--features", "-q"]);
    workshop
        .run(&["denoise", "features.exr", "-o", "quiet.exr", "-q"])
        .fine();
    let ran = workshop.run(&["info", "quiet.exr"]).fine();
    assert!(
        ran.stdout.contains("denoised     first-order regression"),
        "{}",
        ran.stdout
    );
    let ran = workshop.run(&["compare", "quiet.exr", "plain.exr"]);
    assert_eq!(ran.code, Some(3));
    assert!(ran.stdout.contains("was denoised"), "{}", ran.stdout);
    assert!(ran.stdout.contains("relMSE"), "{}", ran.stdout);
    let refused = |arguments: &[&str], reason: &str| {
        let ran = workshop.run(arguments).refused();
        assert!(ran.stderr.contains(reason), "{arguments:?}: {}", ran.stderr);
    };
    refused(
        &["merge", "quiet.exr", "plain.exr", "-o", "new.exr"],
        "it was denoised",
    );
    refused(
        &["replicates", "plain.exr", "quiet.exr", "-o", "new.exr"],
        "was denoised",
    );
    let small = crate::workshop::small_scene("<integrator type='path'/>");
    workshop.write("scene.xml", small);
    let race = [
        "estimators",
        "scene.xml",
        "--integrators",
        "path,direct",
        "--time",
        "1",
    ];
    let against = ["--reference", "quiet.exr"];
    refused(&[&race[..], &against].concat(), "was denoised");
    refused(
        &["denoise", "quiet.exr", "-o", "new.exr"],
        "denoised already",
    );
    refused(
        &["denoise", "plain.exr", "-o", "new.exr"],
        "it has no features: render it with `--features`",
    );
    refused(
        &["denoise", "features.exr", "-o", "new.png"],
        "must end in .exr",
    );
    refused(
        &["denoise", "features.exr", "-o", "features.exr"],
        "it is read from",
    );
    let odd = [
        "render",
        "scene.xml",
        "-o",
        "new.exr",
        "--features",
        "--replicates",
        "3",
    ];
    refused(&odd, "an even number of replicates");
    let named = "<integrator type='aov'><string name='aovs' value='albedo:albedo'/><integrator type='path'/></integrator>";
    workshop.write("aov.xml", crate::workshop::small_scene(named));
    refused(
        &[
            "render",
            "aov.xml",
            "-o",
            "new.exr",
            "--features",
            "--spp",
            "8",
        ],
        "makes a channel `albedo.R`",
    );
    assert!(!workshop.files().contains(&"new.exr".to_owned()));
}

#[test]
fn a_network_filters_where_there_is_one() {
    let workshop = Workshop::new();
    workshop.render("features.exr", &["--spp", "8", "--features", "-q"]);
    let denoise = ["denoise", "features.exr", "-o", "quiet.exr"];
    let nowhere = ["--oidn=nowhere.so"];
    let ran = workshop.run(&[&denoise[..], &nowhere].concat()).refused();
    let reason = "Open Image Denoise 2 cannot be loaded";
    assert!(ran.stderr.contains(reason), "{}", ran.stderr);
    let place = std::env::var("ETALON_OIDN").map(|place| format!("--oidn={place}"));
    let place = place.unwrap_or_else(|_| "--oidn".to_owned());
    let ran = workshop.run(&[&denoise[..], &[&place]].concat());
    if ran.stderr.contains(reason) {
        eprintln!("SKIPPED: {}", ran.stderr);
        return;
    }
    let ran = ran.fine();
    assert!(
        ran.stderr.contains("mean relative error about"),
        "{}",
        ran.stderr
    );
    let method = workshop.run(&["info", "quiet.exr"]).fine().stdout;
    assert!(
        method.contains("denoised     Open Image Denoise 2."),
        "{method}"
    );
}
