//! Channels of whole numbers beside the floats of an EXR file.

use etalon_images::exr::{self, IntegerPlane};
use etalon_images::{Error, Frame, Image};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::io::Cursor;
use std::path::Path;

fn image(width: usize, height: usize) -> Image {
    let mut image = Image::new(width, height);
    let ramp = (0..width * height).map(|i| i as f32 / 7.0).collect();
    image.push("R", ramp);
    image
}

fn plane(name: &str, samples: Vec<u32>) -> IntegerPlane {
    IntegerPlane {
        name: name.to_owned(),
        samples,
    }
}

fn encode(image: &Image, planes: &[IntegerPlane]) -> std::io::Result<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    exr::encode_with_integers(&mut file, image, planes, Frame::whole(image), "{}")?;
    Ok(file.into_inner())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 48,
        rng_seed: RngSeed::Fixed(0x00e7_a104),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Words keep all their bits, those among them that would be signalling NaNs as floats.
    #[test]
    fn words_come_back(
        width in 1usize..40,
        height in 1usize..40,
        words in prop::collection::vec(any::<u32>(), 1600),
        flat: bool,
    ) {
        let image = image(width, height);
        let pixels = width * height;
        let samples = |from: usize| {
            let samples = words[from..].iter().chain(&words).take(pixels);
            samples.map(|word| if flat { 0x7f80_0001 } else { *word }).collect::<Vec<u32>>()
        };
        let planes = [plane("a.0", samples(0)), plane("a.1", samples(5)), plane("z", samples(9))];
        let bytes = encode(&image, &planes).expect("a valid image");
        let path = Path::new("x.exr");
        let (document, mut apart) = exr::decode_with_integers(&bytes, path, "a.").expect("reads");
        apart.sort_by(|a, b| a.name.cmp(&b.name));
        prop_assert_eq!(&apart, &planes[..2]);
        let read = &document.parts[0].image;
        prop_assert_eq!(read.channel("R"), image.channel("R"));
        // Without being asked for, they become floats like those of any other file.
        let nearest: Vec<f32> = samples(9).iter().map(|word| *word as f32).collect();
        prop_assert_eq!(read.channel("z"), Some(&nearest[..]));
        let plain = exr::decode(&bytes, path).expect("reads");
        prop_assert_eq!(plain.parts[0].image.channels().len(), 4);
    }
}

#[test]
fn without_integers_nothing_changes() {
    let image = image(5, 4);
    let mut plain = Cursor::new(Vec::new());
    let part = exr::Part {
        name: None,
        image: image.clone(),
        offset: [0, 0],
    };
    exr::encode(&mut plain, &[part], [5, 4], "{}").expect("a valid image");
    assert!(encode(&image, &[]).expect("a valid image") == plain.into_inner());
}

#[test]
fn planes_that_do_not_fit_are_refused() {
    let image = image(5, 4);
    for planes in [
        [plane("a", vec![0; 19]), plane("b", vec![0; 20])],
        [plane("a", vec![0; 20]), plane("a", vec![0; 20])],
        [plane("R", vec![0; 20]), plane("b", vec![0; 20])],
        [plane("", vec![0; 20]), plane("b", vec![0; 20])],
    ] {
        let error = encode(&image, &planes).expect_err("it does not fit");
        assert_eq!(error.kind(), std::io::ErrorKind::InvalidData, "{error}");
    }
}

#[test]
fn truncated_files_are_refused() {
    let bytes = encode(&image(9, 40), &[plane("a", (0..360).collect())]).expect("a valid image");
    for length in (0..bytes.len()).step_by(7) {
        let read = exr::decode_with_integers(&bytes[..length], Path::new("x.exr"), "a");
        let refused = matches!(read, Err(Error::Invalid { .. } | Error::Unsupported { .. }));
        assert!(refused, "{length} of {} bytes", bytes.len());
    }
}
