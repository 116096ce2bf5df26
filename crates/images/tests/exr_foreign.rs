//! EXR files as other programs write them: every compression, sample type and block layout.

use ::exr::meta::attribute::Chromaticities;
use ::exr::prelude::*;
use etalon_images::{Error, exr as ours, raster_file};
use proptest::prelude::{ProptestConfig, any, prop, proptest};
use proptest::test_runner::RngSeed;
use std::io::Cursor;
use std::path::Path;

const SIZE: (usize, usize) = (41, 37);

fn value(channel: usize, pixel: usize) -> f32 {
    let x = (pixel * 3 + channel) as u32;
    // Smooth and small, so that lossy compressions stay near; multiples of 2⁻⁸, so that 16 bits
    // hold them.
    ((x % 97) as f32 / 256.0) + channel as f32
}

/// A file with the channels `h` (16-bit), `f` (32-bit) and `u` (integer).
fn mixed(compression: Compression, blocks: Blocks) -> Vec<u8> {
    let pixels = SIZE.0 * SIZE.1;
    let channels = AnyChannels::sort(SmallVec::from_vec(vec![
        AnyChannel::new(
            "h",
            FlatSamples::F16((0..pixels).map(|i| f16::from_f32(value(0, i))).collect()),
        ),
        AnyChannel::new(
            "f",
            FlatSamples::F32((0..pixels).map(|i| value(1, i)).collect()),
        ),
        AnyChannel::new("u", FlatSamples::U32((0..pixels as u32).collect())),
    ]));
    let encoding = Encoding {
        compression,
        blocks,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new(SIZE, LayerAttributes::named("main"), encoding, channels);
    let mut file = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut file)
        .expect("writes");
    file.into_inner()
}

fn lossless() -> Vec<(Compression, Blocks)> {
    let tiles = Blocks::Tiles(Vec2(16, 8));
    vec![
        (Compression::Uncompressed, Blocks::ScanLines),
        (Compression::RLE, Blocks::ScanLines),
        (Compression::ZIP1, Blocks::ScanLines),
        (Compression::ZIP16, tiles),
        (Compression::PIZ, Blocks::ScanLines),
        (Compression::PIZ, tiles),
    ]
}

#[test]
fn lossless_compressions_are_exact() {
    for (compression, blocks) in lossless() {
        let bytes = mixed(compression, blocks);
        let (image, _) = ours::decode(&bytes, Path::new("foreign"))
            .expect("reads")
            .flatten();
        let channel = |name| image.channel(name).expect("exists");
        for pixel in 0..SIZE.0 * SIZE.1 {
            assert_eq!(channel("h")[pixel], value(0, pixel), "{compression}");
            assert_eq!(channel("f")[pixel], value(1, pixel), "{compression}");
            assert_eq!(channel("u")[pixel], pixel as f32, "{compression}");
        }
        let header = ours::decode_header(&bytes, Path::new("foreign")).expect("reads");
        let part = &header.parts[0];
        assert_eq!(part.name.as_deref(), Some("main"));
        assert_eq!(part.tiled, blocks != Blocks::ScanLines);
        let types: Vec<_> = part
            .channels
            .iter()
            .map(|c| c.sample_type.to_string())
            .collect();
        assert_eq!(types, ["f32", "f16", "u32"]);
    }
}

#[test]
fn lossy_compressions_are_near() {
    for compression in [
        Compression::PXR24,
        Compression::B44,
        Compression::B44A,
        Compression::DWAA(None),
        Compression::DWAB(Some(45.0)),
    ] {
        let bytes = mixed(compression, Blocks::ScanLines);
        let (image, _) = ours::decode(&bytes, Path::new("foreign"))
            .expect("reads")
            .flatten();
        let channel = |name| image.channel(name).expect("exists");
        for pixel in 0..SIZE.0 * SIZE.1 {
            assert!(
                (channel("h")[pixel] - value(0, pixel)).abs() < 0.05,
                "{compression}"
            );
            assert!(
                (channel("f")[pixel] - value(1, pixel)).abs() < 0.05,
                "{compression}"
            );
            assert_eq!(channel("u")[pixel], pixel as f32, "{compression}");
        }
    }
}

/// Eleven counters stand at the head of a DWA chunk; the decoder allocates what they say.
#[test]
fn dwa_counters_are_bounded() {
    let bytes = mixed(Compression::DWAA(None), Blocks::ScanLines);
    let good = ours::decode(&bytes, Path::new("good.exr"));
    assert!(good.is_ok());
    // The first chunk begins where the first entry of the offset table points; its table is the
    // last thing before it. Two chunks of 32 lines: the table has two entries.
    let start = (0..bytes.len() - 16)
        .find(|&at| {
            let word = |i: usize| {
                u64::from_le_bytes(
                    bytes[at + 8 * i..at + 8 * i + 8]
                        .try_into()
                        .expect("8 bytes"),
                )
            };
            word(0) == at as u64 + 16 && word(1) > word(0) && word(1) < bytes.len() as u64
        })
        .expect("an offset table")
        + 16;
    // Part number is absent in files of one part: y, size, then the counters.
    let counters = start + 8;
    for counter in 1..10 {
        let mut hostile = bytes.clone();
        hostile[counters + 8 * counter..][..8].copy_from_slice(&(1_u64 << 40).to_le_bytes());
        let error = ours::decode(&hostile, Path::new("bad.exr")).expect_err("refused");
        assert!(matches!(error, Error::Invalid { .. }), "{counter}: {error}");
    }
}

#[test]
fn subsampled_images_are_refused() {
    let mut bytes = mixed(Compression::ZIP16, Blocks::ScanLines);
    // In the channel list, a name is followed by its type, four flags, and the sampling.
    let at = bytes
        .windows(2)
        .position(|pair| pair == b"f\0")
        .expect("the channel")
        + 2;
    bytes[at + 8..at + 12].copy_from_slice(&2_i32.to_le_bytes());
    let error = ours::decode(&bytes, Path::new("sub.exr")).expect_err("subsampled");
    assert!(matches!(error, Error::Unsupported { .. }), "{error}");
    assert!(error.to_string().contains("subsampled"), "{error}");
}

/// As of OpenEXR 3.5, which writes 13, ZSTD.
#[test]
fn newer_files_are_called_that() {
    let mut bytes = mixed(Compression::ZIP16, Blocks::ScanLines);
    let before = b"compression\0compression\0\x01\0\0\0";
    let at = bytes.windows(before.len()).position(|w| w == before);
    let at = at.expect("the attribute") + before.len();
    for (number, word) in [(13, "13 (ZSTD)"), (99, "99")] {
        bytes[at] = number;
        for error in [
            ours::decode(&bytes, Path::new("new.exr")).map(drop),
            ours::decode_header(&bytes, Path::new("new.exr")).map(drop),
        ] {
            let error = error.expect_err("unknown");
            assert!(matches!(error, Error::Unsupported { .. }), "{error}");
            assert!(error.to_string().contains(word), "{error}");
        }
    }
    let mut bytes = mixed(Compression::ZIP16, Blocks::ScanLines);
    bytes[4] = 3;
    let error = ours::decode(&bytes, Path::new("new.exr")).expect_err("version 3");
    assert!(matches!(error, Error::Unsupported { .. }), "{error}");
}

/// Of several parts that with the colour keeps its channels' names, whatever the others' sizes.
#[test]
fn the_part_with_the_colour_is_the_picture() {
    let part = |name: &str, size: (usize, usize), letters: [&str; 3], from: f32| {
        let plane = |(i, letter): (usize, &str)| {
            AnyChannel::new(
                letter,
                FlatSamples::F32(vec![from + i as f32; size.0 * size.1]),
            )
        };
        let channels: SmallVec<[_; 4]> = letters.into_iter().enumerate().map(plane).collect();
        let attributes = LayerAttributes::named(name);
        Layer::new(
            size,
            attributes,
            Encoding::default(),
            AnyChannels::sort(channels),
        )
    };
    let file = |layers: Vec<Layer<AnyChannels<FlatSamples>>>, primaries: bool| {
        let window = IntegerBounds::from_dimensions((4, 4));
        let mut attributes = ImageAttributes::new(window);
        attributes.chromaticities = primaries.then_some(Chromaticities {
            red: Vec2(0.713, 0.293),
            green: Vec2(0.165, 0.830),
            blue: Vec2(0.128, 0.044),
            white: Vec2(0.32168, 0.33767),
        });
        let mut file = Cursor::new(Vec::new());
        let image = Image::from_layers(attributes, layers);
        image
            .write()
            .non_parallel()
            .to_buffered(&mut file)
            .expect("writes");
        raster_file::decode(file.get_ref(), Path::new("parts.exr")).expect("a picture")
    };
    let (rgb, xyz) = (["R", "G", "B"], ["X", "Y", "Z"]);
    let normal = || part("Normal", (3, 3), xyz, 5.0);
    let picture = file(vec![normal(), part("beauty", (2, 1), rgb, 1.0)], false);
    assert_eq!((picture.width(), picture.height()), (4, 4));
    let found = picture.to_floats();
    assert_eq!(found[..7], [1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 0.0]);
    // That it fills a part of the window.
    assert_eq!(picture.notes(false).count(), 1);

    let ao = part("AO", (1, 1), rgb, 5.0);
    let picture = file(vec![ao, part("Combined", (1, 1), rgb, 1.0)], true);
    let right = [0.282_845, 2.112_026, 2.920_842];
    let found = picture.to_floats();
    assert!(
        found.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-3),
        "{found:?}"
    );
    let notes: Vec<_> = picture.notes(false).collect();
    assert!(
        notes[0].contains("`Combined`") && notes[0].contains("`AO`"),
        "{notes:?}"
    );

    // The only part holds vectors: they are what they are.
    let picture = file(vec![normal()], false);
    assert_eq!(picture.to_floats()[..3], [5.0, 6.0, 7.0]);
    assert_eq!(picture.notes(false).count(), 2);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(0x00e7_a105),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Damage gives an image or an error.
    #[test]
    fn damage_is_survived(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        in_header: bool,
    ) {
        thread_local!(static FILES: Vec<Vec<u8>> = {
            let mut files = lossless();
            files.push((Compression::PXR24, Blocks::ScanLines));
            files.push((Compression::DWAA(None), Blocks::ScanLines));
            files.into_iter().map(|(c, b)| mixed(c, b)).collect()
        });
        FILES.with(|files| {
            for bytes in files {
                let mut bytes = bytes.clone();
                let range = if in_header { 500.min(bytes.len()) } else { bytes.len() };
                for (index, value) in &damage {
                    bytes[index.index(range)] = *value;
                }
                let _ = ours::decode(&bytes, Path::new("damaged"));
            }
        });
    }
}
