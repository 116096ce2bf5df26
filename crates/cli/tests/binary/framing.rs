//! What everybody looks for first: a smaller picture, a part of it, another camera, a brighter PNG.

use crate::workshop::Workshop;
use etalon_images::{Image, raster_file};

/// Two cameras over a lit floor, a film of 48 × 32, of which the second has a name.
fn two_cameras() -> Workshop {
    let workshop = Workshop::new();
    let sensor = |name: &str, origin: &str| {
        format!(
            "<sensor type=\"perspective\"{name}><transform name=\"to_world\">\
             <lookat origin=\"{origin}\" target=\"0, 0, 0.4\" up=\"0, 0, 1\"/></transform>\
             <film type=\"hdrfilm\"><integer name=\"width\" value=\"48\"/><integer name=\"height\" value=\"32\"/></film>\
             <sampler type=\"independent\"><integer name=\"sample_count\" value=\"16\"/></sampler></sensor>"
        )
    };
    workshop.write(
        "scene.xml",
        format!(
            "<scene version=\"3.0.0\"><integrator type=\"path\"/>{}{}\
             <shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/></transform></shape>\
             <shape type=\"sphere\"><point name=\"center\" x=\"0.7\" y=\"0\" z=\"0.5\"/><float name=\"radius\" value=\"0.5\"/></shape>\
             <emitter type=\"constant\"/></scene>",
            sensor("", "0, -5, 2"),
            sensor(" id=\"side\"", "5, 0.5, 1")
        ),
    );
    workshop
}

fn rendered(workshop: &Workshop, name: &str, options: &[&str]) -> Image {
    let mut words = vec!["render", "scene.xml", "-q", "-o", name];
    words.extend(options);
    workshop.run(&words).fine();
    workshop.image(name).image
}

/// Every channel of a part has the bits of the whole picture's pixels there, whichever reconstruction filter spreads samples over its edge.
#[test]
fn a_part_has_the_bits_of_the_whole() {
    let workshop = two_cameras();
    let whole = rendered(&workshop, "whole.exr", &["--scale", "50%"]);
    assert_eq!((whole.width(), whole.height()), (24, 16));
    let part = rendered(
        &workshop,
        "part.exr",
        &["--size", "24x16", "--crop", "7,3,10,5"],
    );
    assert_eq!((part.width(), part.height()), (10, 5));
    for channel in part.channels() {
        let plane = whole.channel(&channel.name).expect("the same channels");
        let within = part.channel(&channel.name).expect("it is there");
        for (index, value) in within.iter().enumerate() {
            let of_whole = plane[(3 + index / 10) * 24 + 7 + index % 10];
            assert_eq!(
                value.to_bits(),
                of_whole.to_bits(),
                "{} {index}",
                channel.name
            );
        }
    }
}

/// A film twice as large shows the same: the means of blocks of four pixels are the small film's, within its noise.
#[test]
fn another_size_shows_the_same() {
    let workshop = two_cameras();
    let small = rendered(&workshop, "small.exr", &["--scale", "0.5", "--spp", "256"]);
    let large = rendered(&workshop, "large.exr", &["--spp", "64"]);
    let (a, b) = (
        small.channel("G").expect("G"),
        large.channel("G").expect("G"),
    );
    let mut sum = 0.0;
    for (index, value) in a.iter().enumerate() {
        let corner = (index / 24) * 2 * 48 + (index % 24) * 2;
        let block: f32 = [0, 1, 48, 49].iter().map(|k| b[corner + k]).sum();
        sum += (value - block / 4.0).abs() / a.len() as f32;
    }
    assert!(sum < 0.02, "{sum}");
}

#[test]
fn sensors_are_chosen_by_number_and_name() {
    let workshop = two_cameras();
    let first = rendered(&workshop, "first.exr", &[]);
    assert_eq!(rendered(&workshop, "zero.exr", &["--sensor", "0"]), first);
    let side = rendered(&workshop, "side.exr", &["--sensor", "side"]);
    assert_ne!(side, first);
    assert_eq!(rendered(&workshop, "one.exr", &["--sensor", "1"]), side);
    for (wrong, said) in [
        ("2", "no sensor number 2"),
        ("top", "no sensor called `top`"),
    ] {
        let ran = workshop.run(&["render", "scene.xml", "-o", "x.exr", "--sensor", wrong]);
        let ran = ran.refused();
        assert!(
            ran.stderr.contains(said) && ran.stderr.contains("0, 1 (`side`)"),
            "{}",
            ran.stderr
        );
    }
    // What is said of the second sensor says how to choose it; nothing is said when one is chosen.
    let said = |options: &[&str]| {
        let mut words = vec!["render", "scene.xml", "-o", "x.exr"];
        words.extend(options);
        workshop.run(&words).fine().stderr
    };
    assert!(said(&[]).contains("`--sensor` chooses another"));
    assert!(!said(&["--sensor", "1"]).contains("sensor"));
}

#[test]
fn pictures_are_brightened_and_rolled_off() {
    let workshop = two_cameras();
    let picture = |options: &[&str]| {
        let mut words = vec!["render", "scene.xml", "-q", "-o", "a.png", "--scale", "50%"];
        words.extend(options);
        workshop.run(&words).fine();
        raster_file::read(&workshop.path("a.png"))
            .expect("readable")
            .to_linear()
            .to_vec()
    };
    let plain = picture(&[]);
    let dark = picture(&["--exposure", "-1"]);
    let filmic = picture(&["--exposure", "3", "--view", "filmic"]);
    for ((plain, dark), filmic) in plain.iter().zip(&dark).zip(&filmic) {
        // Half a step of 8 bits at the curve's greatest slope, twice.
        assert!(
            *plain > 0.999 || (plain / 2.0 - dark).abs() < 0.01,
            "{plain} {dark}"
        );
        assert!(*filmic < 0.95, "{filmic}");
    }
    let linear = workshop.image("a.exr").image;
    workshop
        .run(&[
            "convert",
            "a.exr",
            "b.png",
            "--exposure",
            "3",
            "--view",
            "filmic",
        ])
        .fine();
    assert_eq!(workshop.read("a.png"), workshop.read("b.png"));
    assert!(linear.channel("G").expect("G").iter().all(|x| *x < 1.5));
}

/// What cannot be is refused before anything is rendered, with what would be accepted.
#[test]
fn wrong_values_are_refused() {
    let workshop = two_cameras();
    let cases: [(&[&str], &str); 11] = [
        (&["--size", "640"], "such as 640x480"),
        (&["--size", "0x3"], "such as 640x480"),
        (&["--size", "99999x3"], "each side must be from 1 to 65536"),
        (&["--size", "6x4", "--scale", "2"], "cannot be used with"),
        (&["--scale", "-5%"], "such as 25% or 0.25"),
        (&["--crop", "1,2,3"], "four whole numbers"),
        (&["--crop", "40,0,9,9"], "not within a film of 48 x 32"),
        (&["--crop", "0,0,0,1"], "four whole numbers"),
        (&["--exposure", "1"], "name one that ends in .png"),
        (&["--view", "aces"], "expected one of srgb, filmic"),
        (&["--exposure", "inf"], "finite number of stops"),
    ];
    for (options, said) in cases {
        let mut words = vec!["render", "scene.xml", "-o", "x.exr"];
        words.extend(options);
        let ran = workshop.run(&words).refused();
        assert!(ran.stderr.contains(said), "{options:?}: {}", ran.stderr);
        assert!(!workshop.path("x.exr").exists());
    }
}
