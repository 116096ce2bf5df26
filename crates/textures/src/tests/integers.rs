//! Samples that stay integers are looked up with the bits of those that are decoded when the file is read.

use super::LAMBDA;
use crate::coded::Coded;
use crate::decode::ImageChannel;
use crate::picture::{FilePixels, Picture, Stored};
use crate::pixels::{Image, Pixels, Texels, Values};
use crate::{Bitmap, Filter, UvTransform, Wrap};
use etalon_images::{halves, raster_file};
use etalon_transport::SpectrumKind;
use glam::{UVec2, Vec2};
use std::path::Path;
use std::sync::Arc;

/// A file of the format PAM with `channels` samples for each pixel, each a number of its own that runs through all that
/// 8 or 16 bits hold.
fn file(channels: usize, greatest: u16) -> Vec<u8> {
    let count = (usize::from(greatest) + 1) * channels;
    let kind = ["GRAYSCALE", "GRAYSCALE_ALPHA", "RGB", "RGB_ALPHA"][channels - 1];
    let (width, height) = (256, count / channels / 256);
    let mut bytes = format!(
        "P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH {channels}\nMAXVAL {greatest}\nTUPLTYPE {kind}\nENDHDR\n"
    )
    .into_bytes();
    for pixel in 0..count / channels {
        for channel in 0..channels {
            // Odd factors permute all numbers; some pixels are grey.
            let factor = if pixel % 5 == 0 { 1 } else { 1 + 6 * channel };
            let sample = (pixel * factor + 9 * (factor - 1)) as u16 & greatest;
            match greatest {
                255 => bytes.push(sample as u8),
                _ => bytes.extend(sample.to_be_bytes()),
            }
        }
    }
    bytes
}

/// The image as floats, decoded all at once.
fn floats(bytes: &[u8], raw: bool, alpha: bool) -> Picture {
    let raster = raster_file::decode(bytes, Path::new("x")).expect("a picture");
    let samples = if raw {
        raster.to_floats()
    } else {
        raster.to_linear()
    };
    let size = UVec2::new(raster.width() as u32, raster.height() as u32);
    let pixels = samples.chunks_exact(raster.channels());
    let values = match (alpha, raster.channels()) {
        (true, n) => Values::One(pixels.map(|p| p[n - 1]).collect()),
        (false, 1 | 2) => Values::One(pixels.map(|p| p[0]).collect()),
        _ => Values::Three(pixels.map(|p| [p[0], p[1], p[2]]).collect()),
    };
    let role = SpectrumKind::Reflectance;
    Image::new(Pixels { size, values }, raw, role, false).into()
}

/// Mutants rejected: encoded numbers taken for plain ones, as alpha is; a channel of the neighbour; a colour's rank off by one.
#[test]
fn integers_are_looked_up_as_floats_are() {
    for (channels, greatest) in [1, 2, 3, 4]
        .into_iter()
        .flat_map(|n| [(n, 255), (n, 65535)])
    {
        let bytes = file(channels, greatest);
        for (raw, alpha) in [(false, false), (true, false), (false, true)] {
            if alpha && channels % 2 == 1 {
                continue;
            }
            let channel = alpha.then_some(ImageChannel::Alpha);
            let (size, pixels, _) =
                FilePixels::decode(&mut std::io::Cursor::new(&bytes), raw, channel, "x")
                    .expect("pixels");
            let stored = Picture::new(size, pixels, raw, SpectrumKind::Reflectance);
            let floats = floats(&bytes, raw, alpha);
            assert_eq!(stored.mean.to_bits(), floats.mean.to_bits());
            if greatest == 255 {
                assert!(!matches!(stored.stored, Stored::Floats(_)));
                assert!(stored.bytes() < floats.bytes() || channels > 2 && !raw && !alpha);
            }
            let of = |image: Picture, filter| Bitmap {
                image: Arc::new(image),
                filter,
                wrap: Wrap::Repeat,
                to_uv: UvTransform::IDENTITY,
            };
            for filter in [Filter::Nearest, Filter::Bilinear] {
                let [a, b] = [&stored, &floats].map(|image| of(image.clone(), filter));
                for i in 0..size.x * size.y {
                    let texel = UVec2::new(i % size.x, i / size.x).as_vec2();
                    let within = if filter == Filter::Nearest { 0.5 } else { 0.2 };
                    let uv = (texel + within) / size.as_vec2();
                    let all = |image: &Bitmap, uv: Vec2| {
                        let spectrum = image.spectrum(uv, LAMBDA).to_array();
                        // Of a colour these take long, and are made of its spectrum.
                        let few = i % 97 == 0 || raw || alpha || channels < 3;
                        let number = if few { image.number(uv) } else { 0.0 };
                        let [x, y, z] = if few {
                            image.colour(uv).to_array()
                        } else {
                            [0.0; 3]
                        };
                        let [s, t, u, v] = spectrum;
                        [s, t, u, v, number, x, y, z].map(f32::to_bits)
                    };
                    assert_eq!(all(&a, uv), all(&b, uv), "{channels} {greatest} {raw} {uv}");
                }
            }
        }
    }
}

/// A large picture of nothing but different colours keeps the memory of its file; a few colours keep their spectra. Mutants
/// rejected: a palette for either; channels in another order.
#[test]
fn pictures_of_too_many_colours_are_looked_up_in_their_samples() {
    let size = UVec2::new(1280, 1200);
    let count = (size.x * size.y) as usize;
    for (greatest, few) in [(255_u16, false), (65535, false), (255, true)] {
        let mut bytes = format!("P6 {} {} {greatest}\n", size.x, size.y).into_bytes();
        let sample = |i: usize, channel: usize| {
            let i = if few { i % 1000 } else { i } as u32;
            // An odd factor permutes the numbers of 24 bits, which are the colours.
            (i.wrapping_mul(0x9e_3779) >> (8 * channel)) & 255
        };
        for i in 0..count {
            for channel in 0..3 {
                match greatest {
                    255 => bytes.push(sample(i, channel) as u8),
                    _ => bytes.extend([sample(i, channel) as u8, sample(i, 2 - channel) as u8]),
                }
            }
        }
        let (_, pixels, _) =
            FilePixels::decode(&mut std::io::Cursor::new(&bytes), false, None, "x")
                .expect("pixels");
        let stored = Picture::new(size, pixels, false, SpectrumKind::Reflectance);
        let recalled = matches!(
            stored.stored,
            Stored::RecalledBytes(_) | Stored::RecalledWords(_)
        );
        assert_eq!(recalled, !few);
        assert!(stored.bytes() < bytes.len() * 102 / 100);
        let floats = floats(&bytes, false, false);
        let coefficients = |picture: &Picture, i: usize| {
            crate::picture::ask!(&picture.stored,
                _numbers => unreachable!("an image of colours"),
                _raw => unreachable!("an image of colours"),
                colours => crate::coded::At::<[f32; 3]>::at(colours, i),
                _bright => unreachable!("an image of colours")
            )
        };
        for i in (0..count).step_by(997) {
            assert_eq!(coefficients(&stored, i), coefficients(&floats, i), "{i}");
        }
    }
}

/// Halves are looked up as the floats that they are. Mutant rejected: halves taken for integers, or decoded as sRGB.
#[test]
fn halves_are_looked_up_as_floats_are() {
    let size = UVec2::new(4, 3);
    let bits: Vec<u16> = (0..36)
        .map(|i| 0x2c00 + 110 * (i as u16 * 7 % 36))
        .collect();
    let values: Vec<f32> = bits
        .iter()
        .map(|&b| halves::values()[usize::from(b)])
        .collect();
    assert!(values.iter().all(|x| (0.05..=1.0).contains(x)));
    for (channels, raw) in [(1, false), (3, false), (3, true)] {
        let size = size * UVec2::new(1, 3 / channels as u32);
        let coded = Coded {
            samples: bits.clone(),
            values: halves::values(),
            channels,
        };
        let of = |pixels| Picture::new(size, pixels, raw, SpectrumKind::Reflectance);
        let stored = of(FilePixels::Halves(coded));
        let floats = of(FilePixels::Floats(match channels {
            1 => Values::One(values.clone()),
            _ => Values::Three(values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()),
        }));
        let [stored, floats] = [stored, floats].map(|image| Bitmap {
            image: Arc::new(image),
            filter: Filter::Bilinear,
            wrap: Wrap::Repeat,
            to_uv: UvTransform::IDENTITY,
        });
        assert_eq!(stored.image.mean, floats.image.mean);
        for i in 0..50 {
            let uv = Vec2::new(0.37 * i as f32, 0.21 * i as f32);
            assert_eq!(stored.spectrum(uv, LAMBDA), floats.spectrum(uv, LAMBDA));
            assert_eq!(stored.number(uv), floats.number(uv));
        }
    }
}
