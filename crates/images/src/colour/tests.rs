//! Which layer is the picture, and what its channels become.

use crate::{Chromaticities, Image};

/// One pixel with these channels.
fn pixel(channels: &[(&str, f32)]) -> Image {
    let one = Image::new(1, 1);
    let with = |image: Image, (name, value): &(&str, f32)| image.with(*name, vec![*value]);
    channels.iter().fold(one, with)
}

fn colour(image: &Image) -> [f32; 3] {
    let colour = image.colour().expect("colour");
    colour.planes.map(|plane| plane[0])
}

/// Channels that are told apart by their values: R, G, B (or X, Y, Z) are `from`, + 1, + 2.
fn layer(prefix: &str, letters: [&str; 3], from: f32) -> Image {
    let names = letters.map(|letter| match prefix {
        "" => letter.to_owned(),
        layer => format!("{layer}.{letter}"),
    });
    let values = [from, from + 1.0, from + 2.0];
    let channels: Vec<_> = names.iter().map(String::as_str).zip(values).collect();
    pixel(&channels)
}

fn both(a: Image, b: Image) -> Image {
    let with = |image: Image, c: crate::Channel| image.with(c.name, c.samples);
    b.into_channels().into_iter().fold(a, with)
}

const RGB: [&str; 3] = ["R", "G", "B"];
const XYZ: [&str; 3] = ["X", "Y", "Z"];

#[test]
fn colour_is_found_by_itself_or_in_a_layer() {
    let bare = pixel(&[("Y", 9.0), ("R", 1.0), ("G", 2.0), ("B", 3.0), ("A", 4.0)]);
    assert_eq!(colour(&bare), [1.0, 2.0, 3.0]);
    assert_eq!(bare.colour().expect("colour").alpha, Some(&[4.0][..]));
    let layered = pixel(&[
        ("depth.Z", 0.0),
        ("a.b.B", 3.0),
        ("a.b.G", 2.0),
        ("a.b.R", 1.0),
        ("a.b.A", 5.0),
    ]);
    assert_eq!(colour(&layered), [1.0, 2.0, 3.0]);
    assert_eq!(layered.colour().expect("colour").alpha, Some(&[5.0][..]));
    let grey = pixel(&[("Y", 7.0)]);
    assert!(grey.colour().expect("colour").grey);
    assert_eq!(colour(&grey), [7.0; 3]);
    for none in [
        pixel(&[("Z", 7.0)]),
        pixel(&[("R", 1.0), ("G", 2.0)]),
        pixel(&[]),
    ] {
        assert_eq!(none.colour(), None);
    }
}

#[test]
fn lower_case_and_words_are_the_same() {
    for names in [
        ["r", "g", "b"],
        ["red", "green", "blue"],
        ["Red", "Green", "Blue"],
    ] {
        for prefix in ["", "Image"] {
            assert_eq!(colour(&layer(prefix, names, 1.0)), [1.0, 2.0, 3.0]);
        }
    }
    // Of two that differ in case only, the one in capitals.
    let twice = both(layer("", ["r", "g", "b"], 1.0), layer("", RGB, 5.0));
    assert_eq!(colour(&twice), [5.0, 6.0, 7.0]);
    assert!(
        pixel(&[("y", 1.0), ("a", 0.5)])
            .colour()
            .expect("colour")
            .alpha
            .is_some()
    );
}

/// The first of each pair is the picture, in whatever order they stand in the file.
#[test]
fn of_several_layers_one_is_the_picture() {
    let pairs = [
        (("", RGB), ("beauty", RGB), true),
        (("beauty", RGB), ("Normal", XYZ), false),
        (("zzz", RGB), ("Normal", XYZ), false),
        (("zzz", RGB), ("aaa", XYZ), false),
        (("zzz", RGB), ("AO", RGB), true),
        (("Combined", RGB), ("AO", RGB), true),
        (("View Layer.Combined", RGB), ("View Layer.AO", RGB), true),
        (("beauty", RGB), ("albedo", RGB), true),
        (("left", RGB), ("right", RGB), true),
        (("beauty", RGB), ("", XYZ), false),
        // What our films in XYZ hold.
        (("", XYZ), ("albedo", RGB), true),
        (("", XYZ), ("standard_error", XYZ), false),
        (("", RGB), ("standard_error", RGB), false),
        (("", RGB), ("albedo", RGB), true),
        (("", RGB), ("World Normals", RGB), false),
        (("beauty_v2", RGB), ("a", RGB), true),
        (("zzz", RGB), ("beauty_diffuse", RGB), true),
    ];
    for (right, other, noted) in pairs {
        for swapped in [false, true] {
            let (a, b) = (layer(right.0, right.1, 1.0), layer(other.0, other.1, 5.0));
            let image = if swapped { both(b, a) } else { both(a, b) };
            let alone = colour(&layer(right.0, right.1, 1.0));
            let found = image.colour().expect("colour");
            assert_eq!(
                found.planes.each_ref().map(|p| p[0]),
                alone,
                "{right:?} {other:?}"
            );
            assert_eq!(found.notes.len(), usize::from(noted), "{right:?} {other:?}");
            if noted {
                assert!(found.notes[0].contains(other.0), "{}", found.notes[0]);
            }
        }
    }
}

/// White in XYZ is white; the numbers are those that Mitsuba 3 gives, whose matrix differs in the
/// fourth digit. Grey of Y would be (0.4, 0.4, 0.4).
#[test]
fn xyz_becomes_rgb() {
    let image = pixel(&[("X", 0.3), ("Y", 0.4), ("Z", 0.5), ("A", 0.5)]);
    let right = [0.108_016, 0.480_398, 0.463_733];
    for (found, right) in colour(&image).into_iter().zip(right) {
        assert!((found - right).abs() < 1e-4, "{found} {right}");
    }
    let found = image.colour().expect("colour");
    assert!(!found.grey && found.alpha.is_some() && found.notes.is_empty());
    // Normals are no colours, whatever their channels are called.
    let normals = layer("Normal", XYZ, 1.0);
    assert_eq!(colour(&normals), [1.0, 2.0, 3.0]);
    assert_eq!(normals.colour().expect("vectors").notes.len(), 1);
}

/// The numbers are Mitsuba 3's, with the luminance of Rec. 709 and of ACEScg.
#[test]
fn luminance_and_chroma_become_rgb() {
    let image = pixel(&[("Y", 0.4), ("RY", 0.3), ("BY", -0.2)]);
    let near = |image: &Image, right: [f32; 3]| {
        for (found, right) in colour(image).into_iter().zip(right) {
            assert!((found - right).abs() < 2e-6, "{found} {right}");
        }
    };
    near(&image, [0.52, 0.372_396_3, 0.32]);
    let image = image.with_chromaticities(Some(ACESCG));
    near(&image, [0.658_424_6, 0.334_951_4, 0.283_221_1]);
    // Of black nothing is known but that it is black.
    near(&pixel(&[("Y", 0.0), ("RY", 0.3), ("BY", -0.2)]), [0.0; 3]);
}

const ACESCG: Chromaticities = Chromaticities {
    red: [0.713, 0.293],
    green: [0.165, 0.830],
    blue: [0.128, 0.044],
    white: [0.32168, 0.33767],
};

#[test]
fn other_primaries_become_rec_709() {
    let image = pixel(&[("R", 0.5), ("G", 0.25), ("B", 0.75)]);
    let with = |c| colour(&image.clone().with_chromaticities(Some(c)));
    // To the bit.
    assert_eq!(with(Chromaticities::REC_709), [0.5, 0.25, 0.75]);
    let right = [0.654_535_4, 0.211_391_2, 0.755_506_1];
    for (found, right) in with(ACESCG).into_iter().zip(right) {
        assert!((found - right).abs() < 2e-6, "{found} {right}");
    }
    // Nonsense is ignored, aloud; XYZ and luminances have primaries of their own, or none.
    let flat = Chromaticities {
        red: [0.3, 0.6],
        ..Chromaticities::REC_709
    };
    let image = image.with_chromaticities(Some(flat));
    assert_eq!(colour(&image), [0.5, 0.25, 0.75]);
    assert!(image.colour().expect("colour").notes[0].contains("(0.3, 0.6)"));
    for image in [
        pixel(&[("X", 0.3), ("Y", 0.4), ("Z", 0.5)]),
        pixel(&[("Y", 0.4)]),
    ] {
        let plain = colour(&image);
        assert_eq!(colour(&image.with_chromaticities(Some(ACESCG))), plain);
    }
}

#[test]
fn who_needs_a_colour_hears_what_there_is() {
    let path = std::path::Path::new("in.exr");
    let image = pixel(&[("Z", 1.0), ("uv.U", 0.0)]);
    let message = image.needed_colour(path);
    let message = message.expect_err("no colour").to_string();
    for word in ["in.exr", "Z, uv.U", "R, G and B"] {
        assert!(message.contains(word), "{message}");
    }
}
