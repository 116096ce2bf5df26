//! ꟻLIP against the authors' own tool: `flip-evaluator` 1.7 from PyPI (single precision), called
//! as `flip_evaluator.evaluate(reference, test, …, applyMagma=False)` on the images made here.

// Reference values keep the digits the tool printed.
#![allow(clippy::excessive_precision)]

use etalon_statistics::flip::{self, Options, ToneMapper};
use etalon_statistics::{Picture, PictureError};

/// A reference with a smooth blob, a fine texture and, for high dynamic range, bright tiles; and a
/// test image with noise, a colour cast in one quarter and a firefly.
fn images(width: usize, height: usize, bright: bool) -> (Vec<f32>, Vec<f32>) {
    let (mut reference, mut test) = (Vec::new(), Vec::new());
    for y in 0..height {
        for x in 0..width {
            for c in 0..3 {
                let (fx, fy) = (x as f64, y as f64);
                let (dx, dy) = (fx - 0.4 * width as f64, fy - 0.3 * height as f64);
                let channel = 1.0 + c as f64;
                let smooth = channel / (1.0 + (dx * dx + dy * dy) / (20.0 * channel));
                let texture = ((x * 7 + y * 13 + c * 29) % 32) as f64 / 32.0;
                let mut r = 0.02 + 0.15 * smooth + 0.1 * texture;
                if bright {
                    let tile = if (x / 6 + y / 5) % 4 == 0 { 61.0 } else { 1.0 };
                    r = r * tile + 8.0 * smooth * smooth;
                }
                let noise = ((x * x * 3 + y * y * 5 + x * y + c * 11) % 23) as f64 / 23.0 - 0.4;
                let mut t = r * (1.0 + 0.5 * noise);
                if x > width / 2 && y > height / 2 {
                    t *= [0.8, 1.1, 1.3][c];
                }
                if (x, y) == (width / 4, height / 2) {
                    t = t * 6.0 + 0.3;
                }
                if !bright {
                    (r, t) = (r.min(1.0), t.min(1.0));
                }
                reference.push(r as f32);
                test.push(t as f32);
            }
        }
    }
    (reference, test)
}

/// The mean error and that of four pixels.
type Expected = (f64, [f32; 4]);

#[track_caller]
fn check(map: &flip::Flip, width: usize, height: usize, (mean, pixels): Expected) {
    assert!((map.mean() / mean - 1.0).abs() < 1e-5, "{}", map.mean());
    let places = [
        (0, 0),
        (width / 4, height / 2),
        (width / 2, height / 3),
        (width - 1, height - 1),
    ];
    for ((x, y), expected) in places.into_iter().zip(pixels) {
        let actual = map.map()[y * width + x];
        assert!((actual - expected).abs() < 2e-5, "{actual} {expected}");
    }
}

#[test]
fn low_dynamic_range() {
    let coarse = Options {
        pixels_per_degree: 30.0,
        ..Options::default()
    };
    let rows: [(usize, usize, Options, Expected); 4] = [
        (
            48,
            32,
            Options::default(),
            (
                0.084_121_085_7,
                [0.067_340_165, 0.677_401_48, 0.128_937_44, 0.138_903_51],
            ),
        ),
        (
            48,
            32,
            coarse,
            (
                0.099_386_304_6,
                [0.078_270_16, 0.975_001_45, 0.188_093_11, 0.163_918_02],
            ),
        ),
        (
            33,
            21,
            Options::default(),
            (
                0.112_630_278,
                [0.084_353_156, 0.645_496_55, 0.132_878_23, 0.136_027_19],
            ),
        ),
        (
            33,
            21,
            coarse,
            (
                0.133_886_62,
                [0.101_248_51, 0.974_813_52, 0.204_317_12, 0.114_343_05],
            ),
        ),
    ];
    for (width, height, options, expected) in rows {
        let (reference, test) = images(width, height, false);
        let picture = |values| Picture::new(values, width, height).expect("well-formed");
        let map = flip::ldr(&picture(&test), &picture(&reference), &options).expect("same size");
        check(&map, width, height, expected);
        assert!(map.exposures().is_empty());
    }
}

#[test]
fn high_dynamic_range() {
    let mapped = |tone_mapper| Options {
        tone_mapper,
        ..Options::default()
    };
    let given = Options {
        pixels_per_degree: 30.0,
        exposures: Some((-3.0, 2.5)),
        ..Options::default()
    };
    // Options, mean and pixels, first and last exposure and their number; at 48 × 32, then 33 × 21.
    type Row = (Options, Expected, (f64, f64, usize));
    let even: [Row; 4] = [
        (
            mapped(ToneMapper::Aces),
            (
                0.139_351_085,
                [0.146_308_54, 0.311_858_09, 0.106_359_46, 0.293_760_03],
            ),
            (-4.609_328_746_795_654, 0.622_831_165_790_557_9, 6),
        ),
        (
            mapped(ToneMapper::Hable),
            (
                0.121_075_891,
                [0.152_996_55, 0.264_032_54, 0.089_699_73, 0.243_338_82],
            ),
            (-4.047_501_087_188_721, 1.184_659_123_420_715_3, 6),
        ),
        (
            mapped(ToneMapper::Reinhard),
            (
                0.158_321_351,
                [0.181_571_92, 0.248_496_1, 0.112_474_51, 0.317_683_67],
            ),
            (-3.190_125_465_393_066_4, 2.042_034_626_007_08, 6),
        ),
        (
            given,
            (
                0.206_510_007,
                [0.177_260_82, 0.679_336_79, 0.125_204_62, 0.404_022_4],
            ),
            (-3.0, 2.5, 6),
        ),
    ];
    let odd: [Row; 4] = [
        (
            mapped(ToneMapper::Aces),
            (
                0.140_151_992,
                [0.150_698_99, 0.292_195_59, 0.088_582_121, 0.276_716_53],
            ),
            (-4.066_093_444_824_219, -0.900_023_996_829_986_6, 4),
        ),
        (
            mapped(ToneMapper::Hable),
            (
                0.128_190_294,
                [0.158_290_89, 0.306_694_72, 0.078_362_808, 0.247_941_29],
            ),
            (-3.504_265_785_217_285, -0.338_195_919_990_539_55, 4),
        ),
        (
            mapped(ToneMapper::Reinhard),
            (
                0.159_405_112,
                [0.185_532_3, 0.244_345_53, 0.190_818_5, 0.353_046_51],
            ),
            (-2.646_890_163_421_631, 0.519_179_582_595_825_2, 4),
        ),
        (
            given,
            (
                0.196_557_76,
                [0.178_183_05, 0.578_919_89, 0.159_520_51, 0.393_709_84],
            ),
            (-3.0, 2.5, 6),
        ),
    ];
    for (width, height, rows) in [(48, 32, even), (33, 21, odd)] {
        let (reference, test) = images(width, height, true);
        let picture = |values| Picture::new(values, width, height).expect("well-formed");
        for (options, expected, (start, stop, count)) in rows {
            let map =
                flip::hdr(&picture(&test), &picture(&reference), &options).expect("same size");
            let exposures = map.exposures();
            assert_eq!(exposures.len(), count);
            assert!((exposures[0] - start).abs() < 2e-6, "{exposures:?}");
            assert!((exposures[count - 1] - stop).abs() < 2e-6, "{exposures:?}");
            check(&map, width, height, expected);
        }
    }
}

#[test]
fn extremes() {
    // Nothing differs from itself; green and blue differ most: ΔE_c = 1, without features.
    let grey = vec![0.3_f32; 3 * 64];
    let [green, blue] = [[0.0_f32, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|c| c.repeat(64));
    let picture = |values| Picture::new(values, 8, 8).expect("well-formed");
    let options = Options::default();
    let same = flip::hdr(&picture(&grey), &picture(&grey), &options).expect("same size");
    assert_eq!(same.mean(), 0.0);
    let most = flip::ldr(&picture(&green), &picture(&blue), &options).expect("same size");
    assert!((most.mean() - 1.0).abs() < 1e-6, "{}", most.mean());

    let black = vec![0.0_f32; 3 * 64];
    assert_eq!(
        flip::hdr(&picture(&grey), &picture(&black), &options),
        Err(PictureError::NoExposure)
    );
    let given = Options {
        exposures: Some((-1.0, 1.0)),
        ..options
    };
    assert!(flip::hdr(&picture(&grey), &picture(&black), &given).is_ok());
    for bad in [
        Options {
            exposures: Some((1.0, -1.0)),
            ..options
        },
        Options {
            pixels_per_degree: 0.0,
            ..options
        },
        Options {
            pixels_per_degree: f64::NAN,
            ..options
        },
    ] {
        assert!(matches!(
            flip::hdr(&picture(&grey), &picture(&grey), &bad),
            Err(PictureError::BadOption { .. })
        ));
    }
    let huge = vec![f32::MAX; 3 * 64];
    let map = flip::hdr(&picture(&huge), &picture(&grey), &options).expect("same size");
    assert!(map.map().iter().all(|e| (0.0..=1.0).contains(e)));
    let small = Picture::new(&grey[..12], 2, 2).expect("well-formed");
    assert!(matches!(
        flip::ldr(&small, &picture(&grey), &options),
        Err(PictureError::DifferentSizes { .. })
    ));
}
