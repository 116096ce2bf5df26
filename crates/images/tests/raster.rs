//! PNG, JPEG, BMP, HDR, PFM and EXR pictures: what comes back, and damaged files.

use etalon_images::{Error, Format, Frame, Image, Losses, Raster, Samples};
use etalon_images::{exr, hdr, pfm, png, raster_file};
use image::{DynamicImage, ImageFormat};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::io::Cursor;
use std::path::Path;

fn file(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    image.into().write_to(&mut file, format).expect("encodes");
    file.into_inner()
}

fn decode(bytes: &[u8]) -> Raster {
    raster_file::decode(bytes, Path::new("memory")).expect("a valid picture")
}

/// Bytes that use every value.
fn noise(count: usize) -> Vec<u8> {
    (0..count as u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8)
        .collect()
}

fn words(count: usize) -> Vec<u16> {
    (0..count as u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 9) as u16)
        .collect()
}

#[test]
fn png_keeps_depth_and_channels() {
    let (w, h) = (5, 3);
    macro_rules! check {
        ($pixel:ident, $sample:ident, $source:ident, $channels:literal, $bits:literal) => {{
            let samples = $source(15 * $channels);
            let buffer = image::ImageBuffer::<image::$pixel<_>, _>::from_raw(w, h, samples.clone());
            let bytes = file(buffer.expect("sized"), ImageFormat::Png);
            let picture = decode(&bytes);
            assert_eq!((picture.width(), picture.height()), (5, 3));
            assert_eq!(picture.channels(), $channels);
            assert_eq!(picture.has_alpha(), $channels % 2 == 0);
            assert_eq!(picture.samples(), &Samples::$sample(samples));
            assert!(picture.is_encoded());
            let header = raster_file::decode_header(&bytes, Path::new("memory")).expect("valid");
            assert_eq!(header.format, Format::Png);
            assert_eq!((header.channels, header.bits), ($channels, $bits));
        }};
    }
    check!(Luma, U8, noise, 1, 8);
    check!(LumaA, U8, noise, 2, 8);
    check!(Rgb, U8, noise, 3, 8);
    check!(Rgba, U8, noise, 4, 8);
    check!(Luma, U16, words, 1, 16);
    check!(LumaA, U16, words, 2, 16);
    check!(Rgb, U16, words, 3, 16);
    check!(Rgba, U16, words, 4, 16);
}

#[test]
fn integers_become_floats() {
    let buffer = image::RgbaImage::from_raw(1, 1, vec![255, 118, 0, 51]).expect("sized");
    let picture = decode(&file(buffer, ImageFormat::Png));
    assert_eq!(picture.to_floats(), [1.0, 118.0 / 255.0, 0.0, 0.2]);
    let linear = picture.to_linear();
    assert_eq!((linear[0], linear[2], linear[3]), (1.0, 0.0, 0.2));
    assert!((linear[1] - 0.18).abs() < 2e-3);

    let wide = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(1, 1, vec![30_235_u16]);
    let picture = decode(&file(wide.expect("sized"), ImageFormat::Png));
    assert!((picture.to_linear()[0] - 0.18).abs() < 1e-4);
}

#[test]
fn bmp_comes_back() {
    let buffer = image::RgbImage::from_raw(19, 11, noise(627)).expect("sized");
    let picture = decode(&file(buffer.clone(), ImageFormat::Bmp));
    assert_eq!(picture.format(), Format::Bmp);
    assert_eq!(picture.samples(), &Samples::U8(buffer.into_raw()));
}

#[test]
fn jpeg_comes_back_nearly() {
    let buffer =
        image::RgbImage::from_fn(32, 24, |x, y| image::Rgb([8 * x as u8, 9 * y as u8, 99]));
    let bytes = file(buffer.clone(), ImageFormat::Jpeg);
    let picture = decode(&bytes);
    assert_eq!(picture.format(), Format::Jpeg);
    assert_eq!((picture.width(), picture.channels()), (32, 3));
    let Samples::U8(samples) = picture.samples() else {
        unreachable!("JPEG has 8 bits");
    };
    let error = samples
        .iter()
        .zip(buffer.as_raw())
        .map(|(a, b)| a.abs_diff(*b));
    assert!(error.max().expect("samples") < 30);
}

/// A JPEG that ends too early is a picture as far as it goes, with a word; without the first of
/// its pixels it is none.
#[test]
fn a_short_jpeg_is_read_as_far_as_it_goes() {
    let buffer = image::RgbImage::from_fn(64, 64, |_, y| image::Rgb([200, 3 * y as u8, 10]));
    let bytes = file(buffer, ImageFormat::Jpeg);
    let whole = decode(&bytes);
    assert_eq!(whole.notes(false).count(), 0);
    let mut pictures = 0;
    for length in 0..bytes.len() - 1 {
        let Ok(short) = raster_file::decode(&bytes[..length], Path::new("short")) else {
            assert_eq!(pictures, 0, "a longer file is worse");
            continue;
        };
        pictures += 1;
        let notes: Vec<_> = short.notes(false).collect();
        assert!(notes[0].contains("ends too early"), "{notes:?}");
        if length == bytes.len() - 60 {
            // The upper half is there.
            assert_eq!(
                short.to_floats()[..64 * 3 * 8],
                whole.to_floats()[..64 * 3 * 8]
            );
            assert_ne!(short.to_floats(), whole.to_floats());
        }
    }
    assert!(pictures > 60, "{pictures}");
}

fn float_image(width: usize, height: usize, scale: f32) -> Image {
    let plane = |seed: usize| {
        (0..width * height)
            .map(|i| {
                let x = ((i + seed) as u32).wrapping_mul(2_654_435_761) >> 8;
                // Runs of equal pixels too.
                if i / 16 % 3 == 0 {
                    scale
                } else {
                    x as f32 / 16_777_216.0 * scale
                }
            })
            .collect::<Vec<f32>>()
    };
    Image::new(width, height)
        .with("R", plane(0))
        .with("G", plane(1))
        .with("B", plane(2))
}

#[test]
fn hdr_is_rounded_to_its_steps() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.hdr");
    // Widths with and without run-length encoding.
    for (width, height, scale) in [(3, 4, 1.0), (8, 2, 1e-6), (300, 7, 3e5)] {
        let image = float_image(width, height, scale);
        let losses = hdr::write(&path, &image).expect("writes");
        assert!(losses.is_empty());
        let picture = raster_file::read(&path).expect("reads");
        assert_eq!(picture.format(), Format::Hdr);
        assert!(!picture.is_encoded());
        assert_eq!((picture.width(), picture.height()), (width, height));
        let colour = image.colour().expect("colour").planes;
        for (pixel, rgb) in picture.to_linear().chunks(3).enumerate() {
            let truth = colour.each_ref().map(|plane| plane[pixel]);
            let brightest = truth.into_iter().fold(0.0, f32::max);
            for (a, b) in rgb.iter().zip(truth) {
                // Half a step, of which there are 128 to 256 up to the brightest channel.
                assert!((a - b).abs() <= brightest / 256.0 * 1.001, "{a} {b}");
            }
        }
    }
}

/// Many programs, Mitsuba among them, write this signature.
#[test]
fn hdr_by_other_programs() {
    let mut bytes = b"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
    bytes.extend([128, 64, 0, 129, 255, 255, 255, 136]);
    let picture = decode(&bytes);
    assert_eq!(picture.to_linear(), [1.0, 0.5, 0.0, 255.0, 255.0, 255.0]);
}

#[test]
fn hdr_counts_what_it_cannot_hold() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.hdr");
    let plane = vec![
        -1.0,
        f32::NAN,
        f32::INFINITY,
        f32::MAX,
        1e-42,
        0.9999,
        0.0,
        1.0,
    ];
    let image = Image::new(8, 1).with("Y", plane);
    let losses = hdr::write(&path, &image).expect("writes");
    assert_eq!(
        losses,
        Losses {
            negative: 3,
            too_bright: 3,
            not_finite: 6
        }
    );
    let greatest = 255.0 * 2_f32.powi(119);
    let back = raster_file::read(&path).expect("reads").to_linear();
    let grey: Vec<f32> = back.chunks(3).map(|rgb| rgb[0]).collect();
    assert_eq!(grey, [0.0, 0.0, greatest, greatest, 0.0, 1.0, 0.0, 1.0]);
}

#[test]
fn pfm_comes_back_bit_by_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.pfm");
    let image = float_image(5, 3, -2.5);
    pfm::write(&path, &image).expect("writes");
    let picture = raster_file::read(&path).expect("reads");
    let colour = image.colour().expect("colour").planes;
    let pixel = |i: usize| colour.each_ref().map(|plane| plane[i]);
    let expected: Vec<f32> = (0..15).flat_map(pixel).collect();
    assert_eq!(picture.samples(), &Samples::F32(expected));

    // Big-endian, grey, with a scale; rows from the bottom.
    let mut bytes = b"Pf\n1 2\n2.0\n".to_vec();
    bytes.extend(1.5_f32.to_be_bytes());
    bytes.extend(4.0_f32.to_be_bytes());
    assert_eq!(decode(&bytes).samples(), &Samples::F32(vec![8.0, 3.0]));
    for bad in [
        &bytes[..bytes.len() - 1],
        b"Pf\n1 2\n0\n12345678",
        b"Pf\n-1 2\n1\n",
        b"Pf\n1",
        b"PF 1000000000 1000000000 1 ",
    ] {
        let error = raster_file::decode(bad, Path::new("bad.pfm")).expect_err("damaged");
        assert!(matches!(error, Error::Invalid { .. }), "{error}");
    }
}

#[test]
fn exr_becomes_a_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.exr");
    let write = |image: &Image| {
        exr::write(&path, image, Frame::whole(image), "").expect("writes");
        raster_file::read(&path)
    };
    let picture = write(&float_image(4, 4, 1.0).with("A", vec![0.5; 16])).expect("colour");
    assert_eq!((picture.channels(), picture.has_alpha()), (4, true));
    let grey = write(&Image::new(2, 1).with("Y", vec![1.0, 2.0])).expect("grey");
    assert_eq!(grey.samples(), &Samples::F32(vec![1.0, 2.0]));
    let single = write(&Image::new(2, 1).with("density", vec![1.0, 2.0])).expect("single");
    assert_eq!(single.channels(), 1);
    let other = Image::new(1, 1).with("U", vec![0.0]).with("V", vec![0.0]);
    let error = write(&other).expect_err("no colour");
    assert!(error.to_string().contains("U, V"), "{error}");
}

#[test]
fn png_for_people() {
    let image = Image::new(2, 2)
        .with("R", vec![0.18, 0.5, -1.0, f32::NAN])
        .with("G", vec![0.0, 4.0, 0.0, 0.0])
        .with("B", vec![1.0, 0.0, 0.0, 0.0]);
    let (bytes, losses) = png::develop(&image, 0.0).expect("colour");
    assert_eq!(bytes, [118, 0, 255, 188, 255, 0, 0, 0, 0, 255, 0, 255]);
    assert_eq!(
        losses,
        Losses {
            negative: 1,
            too_bright: 1,
            not_finite: 1
        }
    );
    // One stop up: 0.18 becomes 0.36, which is 162.
    let (brighter, _) = png::develop(&image, 1.0).expect("colour");
    assert_eq!(brighter[0], 162);

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.png");
    png::write(&path, &image, 0.0).expect("writes");
    assert_eq!(
        raster_file::read(&path).expect("reads").samples(),
        &Samples::U8(bytes)
    );
    let written = std::fs::read(&path).expect("a file");
    assert_eq!(png::in_memory(&image, 0.0), Some(written));

    // Alpha: colour is divided by it.
    let half = Image::new(1, 1).with("Y", vec![0.09]).with("A", vec![0.5]);
    png::write(&path, &half, 0.0).expect("writes");
    let picture = raster_file::read(&path).expect("reads");
    assert_eq!(picture.samples(), &Samples::U8(vec![118, 118, 118, 128]));
    assert!(png::encode_rgb(&[0; 5], 1, 1).is_err());
    assert!(png::encode_channels(&[0; 5], [1, 1], 5).is_err());
    for channels in 1..=4 {
        let pixels: Vec<u8> = (0..2 * channels as u8).collect();
        let file = png::encode_channels(&pixels, [2, 1], channels).expect("encodes");
        let read = decode(&file);
        assert_eq!(read.channels(), channels);
        assert_eq!(read.samples(), &Samples::U8(pixels));
    }
    assert_eq!(
        decode(&png::encode_rgb(&[1, 2, 3], 1, 1).expect("encodes")).width(),
        1
    );
    assert!(png::develop(&Image::new(1, 1).with("Z", vec![0.0]), 0.0).is_none());
}

#[test]
fn other_files_are_refused() {
    for bytes in [&b""[..], b"GIF89a", b"P", b"P8 ", b"#?R", &[0; 18]] {
        let error = raster_file::decode(bytes, Path::new("what.png")).expect_err("not a picture");
        assert!(error.to_string().contains("what.png"), "{error}");
        assert!(matches!(error, Error::Unsupported { .. }));
    }
    // A PNG header that declares 2³⁰ × 2³⁰ pixels.
    let mut png = file(image::RgbImage::new(1, 1), ImageFormat::Png);
    png[16..24].copy_from_slice(&[0x40, 0, 0, 0, 0x40, 0, 0, 0]);
    assert!(raster_file::decode(&png, Path::new("huge.png")).is_err());
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n\x02\x02";
    assert!(raster_file::decode(hdr, Path::new("huge.hdr")).is_err());
}

/// One valid file of each format.
fn samples() -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a");
    let image = float_image(19, 11, 1.0);
    let rgb = image::RgbImage::from_raw(19, 11, noise(627)).expect("sized");
    let mut files = vec![
        file(rgb.clone(), ImageFormat::Png),
        file(rgb.clone(), ImageFormat::Bmp),
        file(rgb.clone(), ImageFormat::Tga),
        file(rgb.clone(), ImageFormat::Pnm),
        file(rgb, ImageFormat::Jpeg),
    ];
    hdr::write(&path, &image).expect("writes");
    files.push(std::fs::read(&path).expect("reads"));
    pfm::write(&path, &image).expect("writes");
    files.push(std::fs::read(&path).expect("reads"));
    exr::write(&path, &image, Frame::whole(&image), "").expect("writes");
    files.push(std::fs::read(&path).expect("reads"));
    files
}

#[test]
fn truncations_are_errors() {
    for bytes in samples() {
        let format = Format::of(&bytes).expect("known");
        for length in 0..bytes.len() {
            // The last bytes of a PNG are a chunk without content.
            let outcome = raster_file::decode(&bytes[..length], Path::new("short"));
            let complete = format == Format::Png && length + 12 >= bytes.len()
                // Read as far as it goes.
                || format == Format::Jpeg;
            assert!(
                complete || outcome.is_err(),
                "{format}: {length} of {}",
                bytes.len()
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        rng_seed: RngSeed::Fixed(0x00e7_a104),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Damage gives a picture or an error, never a panic.
    #[test]
    fn damage_never_panics(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        in_header: bool,
    ) {
        thread_local!(static FILES: Vec<Vec<u8>> = samples());
        FILES.with(|files| {
            for bytes in files {
                let mut bytes = bytes.clone();
                let range = if in_header { 80.min(bytes.len()) } else { bytes.len() };
                for (index, value) in &damage {
                    bytes[index.index(range)] = *value;
                }
                let _ = raster_file::decode(&bytes, Path::new("damaged"));
                let _ = raster_file::decode_header(&bytes, Path::new("damaged"));
            }
        });
    }
}
