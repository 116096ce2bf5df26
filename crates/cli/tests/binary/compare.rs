//! `etalon compare`: verdicts and exit codes.

use crate::workshop::{Ran, Workshop};
use etalon_film::RenderedImage;
use etalon_images::{Frame, Image};
use serde_json::Value;

/// Two renders of the same picture, and one without indirect light.
fn three_images() -> Workshop {
    let workshop = Workshop::new();
    let spp = ["--spp", "256", "-q"];
    workshop.render("a.exr", &[&spp[..], &["--seed", "1"]].concat());
    workshop.render("b.exr", &[&spp[..], &["--seed", "2"]].concat());
    workshop.render("direct.exr", &[&spp[..], &["-D", "max_depth=2"]].concat());
    workshop
}

fn compare(workshop: &Workshop, names: [&str; 2], further: &[&str]) -> Ran {
    workshop.run(&[&["compare", names[0], names[1]], further].concat())
}

#[test]
fn equal_pictures_agree_within_a_bound_that_their_noise_allows() {
    let workshop = three_images();
    let wide = ["--bound", "0.3", "--tile-bound", "0.5"];
    let ran = compare(&workshop, ["a.exr", "b.exr"], &wide).fine();
    assert!(ran.stdout.contains("\nagrees ("), "{}", ran.stdout);
    for word in [
        "channel",
        "interval",
        "could see",
        "tiles of 16²",
        "tiles of 64²",
    ] {
        assert!(ran.stdout.contains(word), "{}", ran.stdout);
    }
    // A bound far below the noise cannot be decided; that is no pass.
    let narrow = ["--bound", "1e-6", "--tile-bound", "0.5"];
    let ran = compare(&workshop, ["a.exr", "b.exr"], &narrow);
    assert_eq!(ran.code, Some(3), "{}", ran.stdout);
    assert!(ran.stdout.contains("\ninconclusive ("), "{}", ran.stdout);
}

/// What would decide an open comparison does: so many times the samples, by the half width and the bias found.
#[test]
fn an_open_comparison_says_what_would_decide_it() {
    let workshop = three_images();
    let render = |name: &str, seed: &str, spp: u32| {
        workshop.render(name, &["--spp", &spp.to_string(), "--seed", seed, "-q"]);
    };
    let bound = ["--bound", "0.01", "--tile-bound", "0.9"];
    let mut samples = 16;
    let ran = loop {
        render("c.exr", "5", samples);
        render("d.exr", "6", samples);
        let ran = compare(
            &workshop,
            ["c.exr", "d.exr"],
            &[&bound[..], &["--json"]].concat(),
        );
        if ran.code == Some(3) {
            break ran;
        }
        samples /= 2;
        assert!(samples > 1, "{}", ran.stdout);
    };
    let facts: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    let factor = facts["more_samples"].as_f64().expect("it is open");
    let row = &facts["images"][0];
    let half = 0.5 * (row["interval"][1].as_f64().unwrap() - row["interval"][0].as_f64().unwrap());
    let away = (row["bias"].as_f64().unwrap().abs() - 0.01).abs();
    assert!(factor >= (half / away).powi(2) * 0.999, "{factor}");
    let errors = &facts["pixel_errors"];
    assert!(errors["mse"].as_f64().unwrap() > 0.0 && errors["smape"].as_f64().unwrap() < 1.0);
    let ran = compare(&workshop, ["c.exr", "d.exr"], &bound);
    assert!(
        ran.stdout
            .contains("times the samples of both would decide it"),
        "{}",
        ran.stdout
    );
    assert!(ran.stdout.contains("pixels   MSE "), "{}", ran.stdout);
}

#[test]
fn missing_light_differs() {
    let workshop = three_images();
    let ran = compare(&workshop, ["direct.exr", "a.exr"], &[]);
    assert_eq!(ran.code, Some(1), "{}", ran.stdout);
    assert!(ran.stdout.contains("\ndiffers ("), "{}", ran.stdout);
}

#[test]
fn an_image_is_identical_to_itself() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "2", "-q"]);
    workshop.render("b.exr", &["--spp", "2", "-q", "--threads", "3"]);
    let ran = compare(&workshop, ["a.exr", "b.exr"], &["--report", "r.html"]).fine();
    assert!(ran.stdout.starts_with("identical"), "{}", ran.stdout);
    assert!(workshop.read("r.html").starts_with(b"<!DOCTYPE html>"));
    let ran = compare(&workshop, ["a.exr", "b.exr"], &["--json"]).fine();
    let verdict: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!(
        (&verdict["identical"], &verdict["verdict"]),
        (&true.into(), &"agrees".into())
    );
}

#[test]
fn a_shared_seed_is_pointed_out() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "8", "-q"]);
    workshop.render("b.exr", &["--spp", "16", "-q"]);
    let ran = compare(&workshop, ["a.exr", "b.exr"], &[]);
    assert!(
        ran.stderr
            .starts_with("note: both images were rendered with seed 0")
    );
}

#[test]
fn json_says_the_same() {
    let workshop = three_images();
    let ran = compare(&workshop, ["direct.exr", "a.exr"], &["--json"]);
    assert_eq!(ran.code, Some(1));
    let verdict: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!(verdict["verdict"], "differs");
    let images = verdict["images"].as_array().expect("rows");
    let channels: Vec<&Value> = images.iter().map(|row| &row["channel"]).collect();
    assert_eq!(channels, ["R", "G", "B"]);
    for row in images {
        assert!(row["bias"].as_f64().expect("a number") < -0.05, "{row}");
        assert_eq!(row["interval"].as_array().map(Vec::len), Some(2));
    }
    assert_eq!(verdict["tiles"].as_array().map(Vec::len), Some(6));
}

#[test]
fn the_report_is_one_file_that_fetches_nothing() {
    let workshop = three_images();
    let ran = compare(&workshop, ["direct.exr", "a.exr"], &["--report", "r.html"]);
    assert_eq!(ran.code, Some(1));
    let html = String::from_utf8(workshop.read("r.html")).expect("UTF-8");
    assert!(html.starts_with("<!DOCTYPE html>"));
    for foreign in [
        "http:",
        "https:",
        "<script src",
        "<link",
        "src=\"/",
        "url(",
        "fetch(",
        "import",
    ] {
        assert!(
            !html.replace("!important", "").contains(foreign),
            "{foreign}"
        );
    }
    // Both pictures, their relative difference, and that in standard errors; p-maps for three
    // channels.
    assert_eq!(html.matches("<script type=\"text/plain\"").count(), 4);
    assert_eq!(html.matches("href=\"data:image/png;base64,").count(), 3);
    assert!(html.contains("role=\"slider\""));
    assert!(html.contains("<span class=\"differs\">"));
    assert!(html.contains("direct.exr"));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let workshop = three_images();
    let refused = |second: &str, words: &str| {
        let ran = compare(&workshop, ["a.exr", second], &[]).refused();
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    };
    refused("none.exr", "none.exr");
    workshop.write("broken.exr", &workshop.read("b.exr")[..500]);
    refused("broken.exr", "broken.exr");
    workshop.render("large.exr", &["-D", "resx=25", "--spp", "2", "-q"]);
    refused(
        "large.exr",
        "differ in size: 24 × 20 (a.exr) and 25 × 20 (large.exr)",
    );
    for option in ["--bound=0", "--bound=nan", "--tile-bound=-1", "--alpha=1"] {
        compare(&workshop, ["a.exr", "b.exr"], &[option]).refused();
    }
}

#[test]
fn what_is_no_number_never_passes() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "16", "-q"]);
    let with = |name: &str, change: &dyn Fn(&mut RenderedImage)| {
        let mut picture = workshop.image("a.exr");
        change(&mut picture);
        let written = picture.write_exr(&workshop.path(name));
        written.expect("written");
    };
    let repainted = |picture: &mut RenderedImage, paint: &dyn Fn(usize, f32) -> f32| {
        let channels = std::mem::replace(&mut picture.image, Image::new(24, 20));
        for channel in channels.into_channels() {
            let samples = channel.samples.iter().enumerate();
            let painted = samples.map(|(i, v)| paint(i, *v)).collect();
            picture.image.push(channel.name, painted);
        }
    };
    // Pixels that are not those of the statistics, which verdicts are made of.
    with("doubled.exr", &|picture| {
        repainted(picture, &|_, v| 2.0 * v)
    });
    with("hole.exr", &|picture| {
        repainted(picture, &|i, v| if i == 50 { f32::NAN } else { v });
    });
    // A file of another program, which has none; even against itself.
    with("foreign.exr", &|picture| {
        repainted(picture, &|i, v| if i == 50 { f32::NAN } else { v });
        picture.metadata = None;
    });
    for (names, words) in [
        (
            ["a.exr", "doubled.exr"],
            "doubled.exr: its metadata cannot be used",
        ),
        (
            ["hole.exr", "a.exr"],
            "hole.exr: its metadata cannot be used",
        ),
        (
            ["a.exr", "foreign.exr"],
            "foreign.exr: pixel (2, 2) of channel `B` is NaN",
        ),
        (["foreign.exr", "foreign.exr"], "is NaN"),
    ] {
        let ran = compare(&workshop, names, &[]).refused();
        assert!(ran.stderr.contains(words), "{}", ran.stderr);
    }
    // What was left out while rendering.
    with("faulty.exr", &|picture| {
        picture.metadata.as_mut().expect("metadata").faults.nan = 9;
        // Else it would be identical.
        let errors = std::mem::replace(&mut picture.image, Image::new(24, 20));
        let means = errors.into_channels().into_iter();
        for channel in means.filter(|channel| channel.name.len() == 1) {
            picture.image.push(channel.name, channel.samples);
        }
    });
    let ran = compare(&workshop, ["a.exr", "faulty.exr"], &[]);
    assert_eq!(ran.code, Some(3), "{}", ran.stdout);
    assert!(ran.stdout.contains("left out 9"), "{}", ran.stdout);
}

#[test]
fn what_carries_no_replicates_is_inconclusive() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "16", "-q"]);
    workshop.render("one.exr", &["--spp", "16", "--replicates", "1", "-q"]);
    let mut image = Image::new(24, 20);
    for name in ["R", "G", "B"] {
        image.push(name, vec![1.0; 480]);
    }
    let foreign = RenderedImage {
        image,
        frame: Frame {
            offset: [0, 0],
            size: [24, 20],
        },
        metadata: None,
    };
    let written = foreign.write_exr(&workshop.path("foreign.exr"));
    written.expect("written");
    let mut bare = workshop.image("a.exr");
    let channels = bare.image.clone();
    bare.image = Image::new(24, 20);
    for channel in channels.into_channels() {
        let brighter = channel.samples.iter().map(|v| v * 1.001).collect();
        bare.image.push(channel.name, brighter);
    }
    let metadata = bare.metadata.as_mut().expect("metadata");
    metadata.tile_means.clear();
    bare.write_exr(&workshop.path("bare.exr")).expect("written");
    for (name, words) in [
        ("foreign.exr", "foreign.exr was not written by Etalon"),
        ("one.exr", "one.exr has a single replicate"),
        ("bare.exr", "bare.exr carries no tile means"),
    ] {
        // Whichever comes first.
        for names in [["a.exr", name], [name, "a.exr"]] {
            let ran = compare(&workshop, names, &[]);
            assert_eq!(ran.code, Some(3), "{name}: {}{}", ran.stdout, ran.stderr);
            let said = format!("inconclusive: {words}");
            assert!(ran.stdout.starts_with(&said), "{}", ran.stdout);
        }
        let ran = compare(
            &workshop,
            ["a.exr", name],
            &["--json", "--report", "r.html"],
        );
        assert_eq!(ran.code, Some(3));
        let verdict: Value = serde_json::from_str(&ran.stdout).expect("JSON");
        assert_eq!(verdict["verdict"], "undecided");
        let reason = verdict["reason"].as_str().expect("a reason");
        assert!(reason.starts_with(words), "{reason}");
        let html = String::from_utf8(workshop.read("r.html")).expect("UTF-8");
        assert!(html.contains("inconclusive"), "{name}");
    }
    // Two replicates are few: an interval, but so wide that nothing is decided.
    workshop.render(
        "two.exr",
        &["--spp", "16", "--replicates", "2", "--seed", "4", "-q"],
    );
    let ran = compare(&workshop, ["a.exr", "two.exr"], &[]);
    assert_eq!(ran.code, Some(3), "{}", ran.stdout);
}

/// Samples that all find nothing have no spread, which is no knowledge of the mean: what is rare looks the same.
/// Mutant: the zero spread is believed, and the pictures differ.
#[test]
fn a_black_picture_is_inconclusive() {
    let workshop = Workshop::new();
    let lit = crate::workshop::small_scene("<integrator type=\"path\"/>");
    workshop.write("lit.xml", &lit);
    let light = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0 0 0\"/></emitter>";
    workshop.write(
        "dark.xml",
        lit.replace("<emitter type=\"constant\"/>", light),
    );
    for name in ["lit", "dark"] {
        let (scene, image) = (format!("{name}.xml"), format!("{name}.exr"));
        workshop.run(&["render", &scene, "-o", &image, "-q"]).fine();
    }
    for names in [["lit.exr", "dark.exr"], ["dark.exr", "lit.exr"]] {
        let ran = compare(&workshop, names, &[]);
        assert_eq!(ran.code, Some(3), "{}", ran.stdout);
        let words = "inconclusive: dark.exr is black: not one of its 16 samples per pixel";
        assert!(ran.stdout.starts_with(words), "{}", ran.stdout);
        let ran = compare(&workshop, names, &["--json"]);
        assert_eq!(ran.code, Some(3));
        assert!(
            ran.stdout.contains("\"verdict\": \"undecided\""),
            "{}",
            ran.stdout
        );
    }
}
