//! Files as other programs write them, byte by byte.

use crate::{Error, Format, Raster, Samples, raster_file};
use std::path::Path;

fn decode(bytes: &[u8]) -> Raster {
    raster_file::decode(bytes, Path::new("memory")).expect("a valid picture")
}

/// A file of this text and these bytes.
fn file(text: &str, bytes: &[u8]) -> Vec<u8> {
    [text.as_bytes(), bytes].concat()
}

#[test]
fn portable_maps() {
    let eight = |samples: &[u8]| Samples::U8(samples.to_vec());
    let wide = |samples: &[u16]| Samples::U16(samples.to_vec());
    let files = [
        (
            file("P2\n# grey\n2 1\n255\n7 200\n", &[]),
            1,
            eight(&[7, 200]),
        ),
        (file("P3 1 1 255 1\n2\t3", &[]), 3, eight(&[1, 2, 3])),
        (file("P5 2 1 # two\n255\n", &[7, 200]), 1, eight(&[7, 200])),
        (
            file("P6\n1 2\n255\n", &[1, 2, 3, 4, 5, 6]),
            3,
            eight(&[1, 2, 3, 4, 5, 6]),
        ),
        // Two bytes a sample, the greater first; and scales of their own.
        (
            file("P5\n2 1\n65535\n", &[1, 2, 255, 255]),
            1,
            wide(&[0x0102, 0xffff]),
        ),
        (
            file("P6\n1 1\n65535\n", &[0, 1, 2, 3, 4, 5]),
            3,
            wide(&[1, 0x0203, 0x0405]),
        ),
        (file("P2\n2 1\n100\n50 100", &[]), 1, eight(&[128, 255])),
        (
            file("P3\n1 1\n1023\n0 1023 341", &[]),
            3,
            wide(&[0, 65_535, 21_845]),
        ),
        (file("P1\n2 1\n0 1\n", &[]), 1, eight(&[255, 0])),
        (
            file(
                "P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n",
                &[1, 2, 3, 4],
            ),
            4,
            eight(&[1, 2, 3, 4]),
        ),
    ];
    for (bytes, channels, samples) in files {
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let picture = decode(&bytes);
        assert_eq!(picture.format(), Format::Pnm, "{text}");
        assert_eq!(
            (picture.channels(), picture.samples()),
            (channels, &samples),
            "{text}"
        );
    }
}

#[test]
fn maps_that_declare_more_than_they_have_are_refused() {
    for text in [
        "P6\n100000 100000\n255\n",
        "P5\n4294967295 4294967295\n255\n",
        "P6\n2 2\n255\nabc",
        "P2\n2 2\n255\n1 2 3",
        "P5\n2 2\n0\nabcd",
        "P2\n1 1\n255\nx",
    ] {
        let error = raster_file::decode(text.as_bytes(), Path::new("bad.ppm")).expect_err(text);
        assert!(error.to_string().contains("bad.ppm"), "{error}");
    }
}

/// The head of a TGA file: kind, entries of a map of 24 bits, width, height, bits and flags.
fn tga(kind: u8, map: u8, size: [u8; 2], bits: u8, flags: u8, rest: &[u8]) -> Vec<u8> {
    let map_bits = if map > 0 { 24 } else { 0 };
    let mut head = vec![
        0,
        u8::from(map > 0),
        kind,
        0,
        0,
        map,
        0,
        map_bits,
        0,
        0,
        0,
        0,
    ];
    head.extend([size[0], 0, size[1], 0, bits, flags]);
    file_of(&head, rest)
}

fn file_of(head: &[u8], rest: &[u8]) -> Vec<u8> {
    [head, rest].concat()
}

const TOP: u8 = 0x20;

/// Pixels are stored blue first, rows from the bottom unless a flag says otherwise.
#[test]
fn tga_files() {
    let files = [
        // Two pixels of colour, from the top.
        (
            tga(2, 0, [1, 2], 24, TOP, &[3, 2, 1, 6, 5, 4]),
            3,
            vec![1, 2, 3, 4, 5, 6],
        ),
        // From the bottom.
        (
            tga(2, 0, [1, 2], 24, 0, &[3, 2, 1, 6, 5, 4]),
            3,
            vec![4, 5, 6, 1, 2, 3],
        ),
        // Grey.
        (tga(3, 0, [2, 1], 8, TOP, &[7, 9]), 1, vec![7, 9]),
        // Runs: three alike, then two that differ.
        (
            tga(11, 0, [5, 1], 8, TOP, &[0x82, 7, 0x01, 8, 9]),
            1,
            vec![7, 7, 7, 8, 9],
        ),
        (
            tga(10, 0, [2, 1], 24, TOP, &[0x81, 3, 2, 1]),
            3,
            vec![1, 2, 3, 1, 2, 3],
        ),
        // A palette of two colours.
        (
            tga(1, 2, [2, 1], 8, TOP, &[3, 2, 1, 6, 5, 4, 1, 0]),
            3,
            vec![4, 5, 6, 1, 2, 3],
        ),
        // Five bits a colour.
        (
            tga(2, 0, [1, 1], 16, TOP, &[0x1f, 0x7c]),
            3,
            vec![255, 0, 255],
        ),
        // Eight bits of opacity; and a fourth byte that is none.
        (
            tga(2, 0, [1, 1], 32, TOP | 8, &[3, 2, 1, 99]),
            4,
            vec![1, 2, 3, 99],
        ),
        (tga(2, 0, [1, 1], 32, TOP, &[3, 2, 1, 0]), 3, vec![1, 2, 3]),
    ];
    for (bytes, channels, samples) in files {
        let picture = decode(&bytes);
        assert_eq!(picture.format(), Format::Tga, "{bytes:?}");
        assert_eq!(
            (picture.channels(), picture.samples()),
            (channels, &Samples::U8(samples)),
            "{bytes:?}"
        );
        let short = raster_file::decode(&bytes[..bytes.len() - 1], Path::new("short.tga"));
        assert!(short.is_err(), "{bytes:?}");
    }
    let huge = file_of(
        &tga(2, 0, [1, 1], 32, 0, &[])[..12],
        &[255, 255, 255, 255, 32, 0],
    );
    let error = raster_file::decode(&huge, Path::new("huge.tga")).expect_err("too large");
    assert!(matches!(error, Error::TooLarge { .. }), "{error}");
    // An index without a colour.
    let lost = tga(1, 2, [1, 1], 8, TOP, &[3, 2, 1, 6, 5, 4, 2]);
    assert!(raster_file::decode(&lost, Path::new("lost.tga")).is_err());
}

const PIXELS: [u8; 8] = [128, 64, 0, 129, 255, 255, 255, 136];

#[test]
fn radiance_files_of_other_programs() {
    for first in [
        "#?AUTOPANO",
        "#?RGBE",
        "#?RADIANCE",
        "#?RADIANCE\n# a comment",
        "#?",
    ] {
        let text = format!("{first}\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n");
        let picture = decode(&file(&text, &PIXELS));
        assert_eq!(picture.format(), Format::Hdr);
        assert_eq!(
            picture.to_linear(),
            [1.0, 0.5, 0.0, 255.0, 255.0, 255.0],
            "{first}"
        );
    }
}

/// X, Y and Z in the place of R, G and B; the matrix as for EXR.
#[test]
fn radiance_files_of_xyz_are_converted() {
    let text = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n";
    let picture = decode(&file(text, &[77, 102, 128, 128]));
    let right = glam::DVec3::new(77.0, 102.0, 128.0) / 256.0;
    let right = crate::chromaticities::xyz_to_rec_709() * right;
    for (found, right) in picture.to_linear().into_iter().zip(right.to_array()) {
        assert!((f64::from(found) - right).abs() < 1e-6, "{found} {right}");
    }
    assert!(right.x < 0.12 && right.y > 0.47);
}

/// The kind and the data of a chunk.
type Chunk<'a> = (&'a [u8; 4], &'a [u8]);

/// A PNG of one pixel with further chunks before it.
fn png(chunks: &[Chunk<'_>]) -> Vec<u8> {
    let plain = crate::png::encode_rgb(&[118, 118, 118], 1, 1).expect("encodes");
    // The signature and the header take 33 bytes.
    let mut bytes = plain[..33].to_vec();
    for (kind, data) in chunks {
        bytes.extend((data.len() as u32).to_be_bytes());
        bytes.extend(*kind);
        bytes.extend(*data);
        // The decoder forgives a wrong check sum of what it can do without.
        bytes.extend([0; 4]);
    }
    bytes.extend(&plain[33..]);
    bytes
}

#[test]
fn a_png_that_is_not_srgb_says_so() {
    let gamma = |hundred_thousandths: u32| hundred_thousandths.to_be_bytes();
    let (linear, usual) = (gamma(100_000), gamma(45_455));
    let (p3, srgb) = ([12, 13, 0, 1], [1, 13, 0, 1]);
    let words = |words: [u32; 8]| words.map(u32::to_be_bytes).concat();
    let rec_709 = words([
        31_270, 32_900, 64_000, 33_000, 30_000, 60_000, 15_000, 6_000,
    ]);
    let rec_2020 = words([
        31_270, 32_900, 70_800, 29_200, 17_000, 79_700, 13_100, 4_600,
    ]);
    let cases: [(&[Chunk<'_>], &str); 13] = [
        (&[], ""),
        (&[(b"iCCP", b"Display P3\0\0")], "profile, \"Display P3\""),
        (&[(b"iCCP", b"sRGB IEC61966-2.1\0\0")], ""),
        (
            &[(b"iCCP", b"ICC profile\0\0"), (b"gAMA", &linear)],
            "gAMA chunk (1",
        ),
        (&[(b"gAMA", &linear)], "gAMA chunk (1, linear samples)"),
        (&[(b"gAMA", &usual)], ""),
        (&[(b"sRGB", &[0]), (b"gAMA", &linear)], ""),
        (&[(b"cICP", &p3)], "cICP chunk (primaries 12"),
        (&[(b"cICP", &srgb), (b"gAMA", &linear)], ""),
        (&[(b"cHRM", &rec_709)], ""),
        (&[(b"gAMA", &usual), (b"cHRM", &rec_2020)], "cHRM chunk"),
        (&[(b"gAMA", &[0, 1])], ""),
        (
            &[(b"tEXt", b"a\0gAMA"), (b"gAMA", &gamma(22_000))],
            "gAMA chunk (0.22)",
        ),
    ];
    for (chunks, expected) in cases {
        let picture = decode(&png(chunks));
        let notes: Vec<&str> = picture.notes(false).collect();
        assert_eq!(
            notes.is_empty(),
            expected.is_empty(),
            "{chunks:?} {notes:?}"
        );
        assert!(
            notes.iter().all(|note| note.contains(expected)),
            "{notes:?}"
        );
        // As Mitsuba does.
        assert!((picture.to_linear()[0] - 0.18).abs() < 2e-3);
        assert_eq!(picture.notes(true).count(), 0);
    }
}
