//! EXR files: round trips, reproducible bytes, and damaged files.

use etalon_images::exr::{self, Part};
use etalon_images::{Error, Frame, Image};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::io::Cursor;
use std::path::Path;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(0x00e7_a103),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn ramp(pixels: usize, seed: u32) -> Vec<f32> {
    (0..pixels as u32)
        .map(|i| (i.wrapping_mul(2_654_435_761).wrapping_add(seed) >> 8) as f32 / 16_777_216.0)
        .collect()
}

fn image(width: usize, height: usize) -> Image {
    let mut image = Image::new(width, height);
    for (index, name) in ["R", "G", "B", "standard_error.R", "S0.400,0nm", "größe"]
        .iter()
        .enumerate()
    {
        image.push(*name, ramp(width * height, index as u32));
    }
    image
}

fn encode(image: &Image, text: &str) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let part = Part {
        name: None,
        image: image.clone(),
        offset: [0, 0],
    };
    exr::encode(&mut file, &[part], [image.width(), image.height()], text).expect("a valid image");
    file.into_inner()
}

fn sorted(image: &Image) -> Vec<(String, Vec<u32>)> {
    let mut channels: Vec<_> = image
        .channels()
        .iter()
        .map(|channel| {
            let bits = channel.samples.iter().map(|x| x.to_bits()).collect();
            (channel.name.clone(), bits)
        })
        .collect();
    channels.sort();
    channels
}

#[test]
fn a_crop_comes_back_bit_by_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("crop.exr");
    let mut whole = image(7, 19);
    let odd = whole.channel_mut("R").expect("exists");
    odd[..6].copy_from_slice(&[
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -0.0,
        f32::MIN_POSITIVE / 8.0,
        f32::MAX,
    ]);
    let frame = Frame {
        offset: [3, 40],
        size: [100, 60],
    };
    let text = "{\"replicates\": 8, \"scene\": \"Wüste\"}";
    exr::write(&path, &whole, frame, text).expect("writes");

    let document = exr::read(&path).expect("reads");
    assert_eq!(document.text, text);
    assert_eq!(document.size, [100, 60]);
    let (back, place) = document.flatten();
    assert_eq!(place, frame);
    assert_eq!(sorted(&back), sorted(&whole));

    let header = exr::read_header(&path).expect("reads");
    assert_eq!((header.size, header.text.as_str()), ([100, 60], text));
    let part = &header.parts[0];
    assert_eq!((part.width, part.height, part.offset), (7, 19, [3, 40]));
    assert!(part.attributes.is_empty());
    let names: Vec<_> = part.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        names,
        ["B", "G", "R", "S0.400,0nm", "größe", "standard_error.R"]
    );
    // Nothing is left beside the file.
    assert_eq!(std::fs::read_dir(folder.path()).expect("lists").count(), 1);
}

#[test]
fn the_same_content_has_the_same_bytes() {
    // Small enough for one thread, and large enough for several.
    for (width, height) in [(16, 16), (300, 257)] {
        let image = image(width, height);
        let first = encode(&image, "{\"a\":1}");
        for _ in 0..10 {
            assert!(encode(&image, "{\"a\":1}") == first);
        }
        assert!(encode(&image, "{\"a\":2}") != first);
    }
}

#[test]
fn several_parts_come_back_and_flatten() {
    let part = |name: &str, width, offset| Part {
        name: Some(name.to_owned()),
        image: Image::new(width, 5)
            .with("R", ramp(width * 5, 1))
            .of_part(name),
        offset,
    };
    let parts = [
        part("beauty", 4, [1, 2]),
        part("albedo", 4, [1, 2]),
        part("tiles", 2, [0, 0]),
    ];
    let mut file = Cursor::new(Vec::new());
    exr::encode(&mut file, &parts, [9, 9], "text").expect("valid parts");
    let document = exr::decode(file.get_ref(), Path::new("memory")).expect("reads");
    assert_eq!(document.parts, parts);
    assert_eq!(document.text, "text");
    let (flat, frame) = document.flatten();
    assert_eq!(frame.offset, [1, 2]);
    assert!(flat.channel("R").is_some() && flat.channel("albedo.R").is_some());
    assert_eq!(flat.channels().len(), 2);
}

#[test]
fn what_cannot_be_written_leaves_the_old_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("old.exr");
    std::fs::write(&path, b"old").expect("writes");
    let frame = Frame {
        offset: [0, 0],
        size: [1, 1],
    };
    for bad in [
        Image::new(1, 1),
        Image::new(0, 0).with("R", vec![]),
        Image::new(1, 1).with("", vec![0.0]),
        Image::new(1, 1).with("x".repeat(256), vec![0.0]),
    ] {
        let error = exr::write(&path, &bad, frame, "").expect_err("not an image");
        assert!(matches!(error, Error::Invalid { .. }), "{error}");
        assert_eq!(error.path(), path);
    }
    assert_eq!(std::fs::read(&path).expect("reads"), b"old");
    assert_eq!(std::fs::read_dir(folder.path()).expect("lists").count(), 1);

    let nowhere = folder.path().join("missing").join("new.exr");
    let good = Image::new(1, 1).with("R", vec![0.0]);
    assert!(matches!(
        exr::write(&nowhere, &good, frame, ""),
        Err(Error::Write { .. })
    ));
    assert!(matches!(exr::read(&nowhere), Err(Error::Read { .. })));
}

/// A window of 2³⁰ × 2³⁰ pixels in a file of some hundred bytes must be refused before anything
/// is allocated for it.
#[test]
fn a_small_file_cannot_ask_for_much() {
    let bytes = encode(&Image::new(2, 2).with("R", ramp(4, 0)), "");
    let at = find(&bytes, b"dataWindow\0box2i\0") + 17 + 4;
    for (width, height) in [
        (1 << 29, 1 << 29),
        (1 << 29, 1),
        (1, 1 << 29),
        (70_000, 70_000),
    ] {
        let mut hostile = bytes.clone();
        hostile[at + 8..at + 12].copy_from_slice(&i32::to_le_bytes(width - 1));
        hostile[at + 12..at + 16].copy_from_slice(&i32::to_le_bytes(height - 1));
        let error = exr::decode(&hostile, Path::new("hostile.exr")).expect_err("refused");
        assert!(
            matches!(error, Error::TooLarge { .. } | Error::Invalid { .. }),
            "{error}"
        );
    }
}

fn find(bytes: &[u8], pattern: &[u8]) -> usize {
    bytes
        .windows(pattern.len())
        .position(|window| window == pattern)
        .expect("the pattern is there")
}

#[test]
fn every_truncation_is_an_error() {
    let bytes = encode(&image(9, 40), "{}");
    for length in 0..bytes.len() {
        let outcome = exr::decode(&bytes[..length], Path::new("short.exr"));
        assert!(outcome.is_err(), "{length} of {} bytes", bytes.len());
    }
    assert!(exr::decode(&bytes, Path::new("whole.exr")).is_ok());
}

proptest! {
    #![proptest_config(config(600))]

    /// Damage gives an image or an error, never a panic.
    #[test]
    fn damage_never_panics(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        in_header: bool,
    ) {
        let mut bytes = encode(&image(9, 40), "{}");
        let range = if in_header { 600.min(bytes.len()) } else { bytes.len() };
        for (index, value) in damage {
            bytes[index.index(range)] = value;
        }
        let _ = exr::decode(&bytes, Path::new("damaged.exr"));
        let _ = exr::decode_header(&bytes, Path::new("damaged.exr"));
    }

    #[test]
    fn any_size_comes_back(width in 1_usize..40, height in 1_usize..40, seed: u32) {
        let image = Image::new(width, height)
            .with("Z", ramp(width * height, seed))
            .with("A", ramp(width * height, !seed));
        let document = exr::decode(&encode(&image, ""), Path::new("memory")).expect("valid");
        prop_assert_eq!(sorted(&document.flatten().0), sorted(&image));
    }
}
