//! `etalon convert`: pictures to look at, and other formats.

use crate::workshop::Workshop;
use etalon_images::raster;

fn one_image() -> Workshop {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "8", "-q"]);
    workshop
}

/// The linear values of a picture, three per pixel.
fn values(workshop: &Workshop, name: &str) -> Vec<f32> {
    let picture = raster::read(&workshop.path(name)).expect("readable");
    assert_eq!(
        (picture.width(), picture.height(), picture.channels()),
        (24, 20, 3)
    );
    picture.to_linear().to_vec()
}

#[test]
fn to_every_format() {
    let workshop = one_image();
    for name in ["a.png", "a.hdr", "a.pfm"] {
        workshop.run(&["convert", "a.exr", name]).fine();
    }
    assert!(workshop.read("a.png").starts_with(b"\x89PNG"));
    let image = workshop.image("a.exr").image;
    let planes = image.colour().expect("colours");
    let [png, hdr, pfm] = ["a.png", "a.hdr", "a.pfm"].map(|name| values(&workshop, name));
    for pixel in 0..24 * 20 {
        let largest = planes.iter().map(|p| p[pixel]).fold(0.0, f32::max);
        for (channel, plane) in planes.iter().enumerate() {
            let (index, value) = (3 * pixel + channel, plane[pixel]);
            assert_eq!(pfm[index], value);
            // RGBE has no negative numbers, and shares one exponent between the channels: steps of
            // 1/128 of the largest at worst.
            assert!((hdr[index] - value.max(0.0)).abs() <= largest * 0.501 / 128.0);
            // 8 bits of sRGB, of what is at most white: at most half a step of 1/255 at the
            // curve's greatest slope, 1.055 · 2.4.
            assert!((png[index] - value.clamp(0.0, 1.0)).abs() <= 0.5 / 255.0 * 2.54);
        }
    }
    workshop.run(&["convert", "a.pfm", "again.png"]).fine();
    assert_eq!(workshop.read("a.png"), workshop.read("again.png"));
}

#[test]
fn exposure_counts_in_stops() {
    let workshop = one_image();
    workshop.run(&["convert", "a.exr", "a.pfm"]).fine();
    let exposure = ["convert", "a.exr", "b.pfm", "--exposure", "-2"];
    workshop.run(&exposure).fine();
    let [a, b] = ["a.pfm", "b.pfm"].map(|name| values(&workshop, name));
    assert!(a.iter().zip(&b).all(|(a, b)| a / 4.0 == *b));
    workshop
        .run(&["convert", "a.exr", "c.png", "--exposure", "nan"])
        .refused();
}

#[test]
fn other_channels_can_be_shown() {
    let workshop = one_image();
    let noise = [
        "convert",
        "a.exr",
        "noise.pfm",
        "--channels",
        "standard_error",
    ];
    workshop.run(&noise).fine();
    let image = workshop.image("a.exr");
    let green: Vec<f32> = values(&workshop, "noise.pfm")
        .iter()
        .skip(1)
        .step_by(3)
        .copied()
        .collect();
    assert_eq!(image.standard_error("G").expect("G"), green);
    let ran = workshop
        .run(&["convert", "a.exr", "x.png", "--channels", "normals"])
        .refused();
    assert!(ran.stderr.contains("`normals.R`") && ran.stderr.contains("standard_error.R"));
}

#[test]
fn what_cannot_be_read_or_written_is_refused() {
    let workshop = one_image();
    for (input, output) in [
        ("a.exr", "a.gif"),
        ("a.exr", "nowhere/a.png"),
        ("none.exr", "a.png"),
        ("a.txt", "a.png"),
        ("a.exr", "a"),
    ] {
        let ran = workshop.run(&["convert", input, output]).refused();
        assert!(ran.stderr.starts_with("error: "), "{}", ran.stderr);
    }
    assert_eq!(workshop.files(), ["a.exr"]);
}
