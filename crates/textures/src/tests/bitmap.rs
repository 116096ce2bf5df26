//! Images against `texture.eval` and `texture.eval_1` of Mitsuba 3.9.1 (`scalar_spectral`).

use super::*;
use etalon_params::DMat4;
use etalon_spectrum::Spectrum;
use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// 3 × 2 texels of one channel.
const GREY: [f32; 6] = [0.1, 0.5, 0.9, 0.3, 0.7, 0.2];

/// 2 × 2 texels of three channels.
const RED: [f32; 4] = [0.1, 0.8, 0.3, 0.0];
const GREEN: [f32; 4] = [0.5, 0.2, 0.3, 1.0];
const BLUE: [f32; 4] = [0.9, 0.1, 0.3, 0.4];

fn files() -> Files {
    let mut files = Files::default();
    files.add("grey.exr", 3, &[("Y", &GREY)]);
    files.add("colour.exr", 2, &[("R", &RED), ("G", &GREEN), ("B", &BLUE)]);
    let half = [0.5; 4];
    files.add(
        "alpha.exr",
        2,
        &[("R", &RED), ("G", &GREEN), ("B", &BLUE), ("A", &half)],
    );
    let triple = |values: [f32; 4]| values.map(|x| 3.0 * x);
    let (r, g, b) = (triple(RED), triple(GREEN), triple(BLUE));
    files.add("bright.exr", 2, &[("R", &r), ("G", &g), ("B", &b)]);
    files.add("nan.exr", 2, &[("Y", &[0.0, 1.0, f32::NAN, 0.0])]);
    files
}

fn bitmap(file: &str, more: Vec<(&'static str, Value)>) -> One {
    let mut properties = vec![("filename", text(file))];
    properties.extend(more);
    One::new(
        &files(),
        &node("bitmap", properties),
        SpectrumKind::Reflectance,
    )
}

/// Mitsuba 0.6's `channel`.
#[test]
fn one_channel_of_an_image_is_a_number() {
    for (name, expected) in [("r", RED[0]), ("g", GREEN[0]), ("b", BLUE[0]), ("a", 0.5)] {
        let texture = bitmap("alpha.exr", vec![("channel", text(name))]);
        assert!(
            (texture.number(0.25, 0.25) - expected).abs() < 1e-6,
            "{name}"
        );
    }
    let node = node(
        "bitmap",
        vec![("filename", text("grey.exr")), ("channel", text("a"))],
    );
    let (.., said) = read(&files(), &node, SpectrumKind::Reflectance);
    assert_eq!(said, ["`grey.exr` has no channel `a`"]);
}

#[test]
fn wrapping_and_filtering_match_mitsuba() {
    let places = [
        (0.0, 0.0),
        (0.1, 0.2),
        (0.5, 0.25),
        (0.95, 0.9),
        (1.3, -0.4),
        (-0.05, 1.7),
        (0.34, 0.51),
        (2.2, 3.3),
    ];
    for (wrap, filter, expected) in [
        (
            "repeat",
            "bilinear",
            [0.375, 0.262, 0.5, 0.3505, 0.4, 0.2735, 0.412, 0.16],
        ),
        (
            "repeat",
            "nearest",
            [0.1, 0.1, 0.5, 0.2, 0.3, 0.2, 0.7, 0.1],
        ),
        (
            "mirror",
            "bilinear",
            [0.1, 0.1, 0.5, 0.2, 0.638, 0.12, 0.412, 0.32],
        ),
        (
            "mirror",
            "nearest",
            [0.1, 0.1, 0.5, 0.2, 0.9, 0.1, 0.7, 0.3],
        ),
        (
            "clamp",
            "bilinear",
            [0.1, 0.1, 0.5, 0.2, 0.9, 0.3, 0.412, 0.2],
        ),
        ("clamp", "nearest", [0.1, 0.1, 0.5, 0.2, 0.9, 0.3, 0.7, 0.2]),
    ] {
        let texture = bitmap(
            "grey.exr",
            vec![("wrap_mode", text(wrap)), ("filter_type", text(filter))],
        );
        for ((u, v), expected) in places.into_iter().zip(expected) {
            let found = texture.number(u, v);
            assert!(
                (found - expected).abs() < 2e-6,
                "{wrap} {filter} {u} {v}: {found}"
            );
            assert!(close(texture.spectrum(u, v), [expected; 4], 2e-6));
        }
    }
}

#[test]
fn to_uv_matches_mitsuba() {
    let scale = DMat4::from_scale(DVec3::new(2.0, 3.0, 1.0));
    let moved = scale * DMat4::from_translation(DVec3::new(0.1, 0.2, 0.0));
    let texture = bitmap("grey.exr", vec![("to_uv", Value::Transform(moved))]);
    assert!((texture.number(0.1, 0.2) - 0.4).abs() < 1e-6);
    let turned = DMat4::from_rotation_z(30.0_f64.to_radians());
    let texture = bitmap("grey.exr", vec![("to_uv", Value::Transform(turned))]);
    assert!((texture.number(0.3, 0.2) - 0.143_032_31).abs() < 1e-6);
}

/// The spectra of four texels are averaged, not their coefficients; alpha does not matter.
/// Mitsuba's spectra come from another table of the same family, hence the tolerance 0.02.
#[test]
fn colours_match_mitsuba() {
    let mitsuba = [
        (
            (0.25, 0.25),
            [0.934_221_4, 0.784_617_6, 0.408_346_5, 0.153_841_3],
        ),
        (
            (0.5, 0.25),
            [0.549_006_2, 0.452_006_5, 0.334_854_9, 0.521_360_3],
        ),
        (
            (0.5, 0.5),
            [0.352_084_6, 0.522_199_8, 0.472_054_3, 0.338_157_5],
        ),
        (
            (0.75, 0.75),
            [0.010_326, 0.884_786_2, 0.918_507_6, 0.009_909_3],
        ),
    ];
    for file in ["colour.exr", "alpha.exr"] {
        let texture = bitmap(file, vec![]);
        for ((u, v), expected) in mitsuba {
            let found = texture.spectrum(u, v);
            assert!(
                close(found, expected, 0.02),
                "{u} {v}: {found} {expected:?}"
            );
        }
        let spectrum = |i: usize| {
            let rgb = [RED[i], GREEN[i], BLUE[i]].map(f64::from);
            Spectrum::reflectance(rgb)
                .expect("within [0, 1]")
                .eval(LAMBDA)
        };
        let mean = (spectrum(0) + spectrum(1) + spectrum(2) + spectrum(3)) / 4.0;
        assert!(close(texture.spectrum(0.5, 0.5), mean.to_array(), 1e-6));
    }
}

#[test]
fn raw_channels_and_their_luminance_match_mitsuba() {
    let texture = bitmap("colour.exr", vec![("raw", Value::Boolean(true))]);
    let found = texture.colour(0.5, 0.25);
    assert!((found - Vec3::new(0.45, 0.35, 0.5)).abs().max_element() < 1e-6);
    // Mitsuba writes the luminance's weights with six digits.
    assert!((texture.number(0.5, 0.25) - 0.382_092_5).abs() < 2e-5);
    assert!((texture.set.mean(texture.id) - 0.452_053_13).abs() < 2e-5);
}

/// Where a colour image is asked for numbers, its colour is recovered from its spectrum.
#[test]
fn numbers_of_colour_images_are_luminances() {
    let (raw, colour) = (
        bitmap("colour.exr", vec![("raw", Value::Boolean(true))]),
        bitmap("colour.exr", vec![]),
    );
    for (u, v) in [(0.25, 0.25), (0.5, 0.5), (0.6, 0.3)] {
        assert!((raw.number(u, v) - colour.number(u, v)).abs() < 5e-3);
        let difference = raw.colour(u, v) - colour.colour(u, v);
        assert!(difference.abs().max_element() < 5e-3, "{difference}");
    }
}

#[test]
fn colours_beyond_one_are_kept_for_light_and_moved_for_reflectance() {
    let description = node("bitmap", vec![("filename", text("bright.exr"))]);
    let (set, id, messages) = read(&files(), &description, SpectrumKind::Reflectance);
    assert!(
        matches!(&messages[..], [m] if m.contains("3 of the 4 texels")),
        "{messages:?}"
    );
    let at = TexturePoint::at_uv(Vec2::new(0.25, 0.25));
    let found = set.spectrum(id, &OneShape, &at, LAMBDA);
    let nearest = Spectrum::reflectance([f64::from(0.3_f32), 1.0, 1.0]).expect("within [0, 1]");
    assert!(
        close(found, nearest.eval(LAMBDA).to_array(), 1e-3),
        "{found}"
    );

    let light = One::new(&files(), &description, SpectrumKind::Emission);
    let rgb = [0, 1, 2].map(|c| 3.0 * f64::from([RED, GREEN, BLUE][c][0]));
    let expected = Spectrum::unbounded(rgb).expect("not negative").eval(LAMBDA);
    assert!(close(light.spectrum(0.25, 0.25), expected.to_array(), 1e-5));
}

/// Beside black a bright texel keeps its share: w · 10⁵, not w² · 10⁵, as where a colour and its
/// brightness are interpolated each for itself.
#[test]
fn light_is_interpolated_as_light() {
    let mut files = files();
    let sun = [1e5, 0.0, 0.0, 0.0];
    files.add("sun.exr", 2, &[("R", &sun), ("G", &sun), ("B", &sun)]);
    let description = node("bitmap", vec![("filename", text("sun.exr"))]);
    let light = One::new(&files, &description, SpectrumKind::Emission);
    let whole = light.spectrum(0.25, 0.25);
    for (u, v, share) in [(0.5, 0.25, 0.5), (0.5, 0.5, 0.25), (0.375, 0.25, 0.75)] {
        let found = light.spectrum(u, v) / whole;
        assert!(
            (found - share).abs().max_element() < 1e-4,
            "{found} {share}"
        );
    }
}

#[test]
fn mistakes_are_refused() {
    for (properties, expected) in [
        (vec![("filename", text("none.exr"))], "no file `none.exr`"),
        (vec![("filename", text("nan.exr"))], "column 0 of row 1"),
        (vec![], "needs the parameter `filename`"),
        (
            vec![("filename", text("grey.exr")), ("wrap_mode", text("tile"))],
            "not a value of `wrap_mode`",
        ),
        (
            vec![
                ("filename", text("grey.exr")),
                ("flip", Value::Boolean(true)),
            ],
            "no parameter `flip`",
        ),
    ] {
        let (_, _, messages) = read(
            &files(),
            &node("bitmap", properties),
            SpectrumKind::Reflectance,
        );
        assert!(
            matches!(&messages[..], [message] if message.contains(expected)),
            "{expected}: {messages:?}"
        );
    }
}

/// 8-bit files are sRGB unless `raw`, 16-bit ones too; the literals are Mitsuba's.
#[test]
fn integer_files_are_decoded_as_in_mitsuba() {
    let mut files = Files::default();
    let rgb = [0, 0, 0, 128, 128, 128, 200, 200, 200, 255, 255, 255];
    let png = etalon_images::png::encode_rgb(&rgb, 2, 2).expect("four pixels");
    files.0.insert("grey.png".into(), Arc::new(png));
    let read = |raw| {
        let properties = vec![("filename", text("grey.png")), ("raw", Value::Boolean(raw))];
        One::new(
            &files,
            &node("bitmap", properties),
            SpectrumKind::Reflectance,
        )
    };
    assert!((read(true).number(0.75, 0.25) - 0.501_960_8).abs() < 1e-6);
    let linear = read(false);
    assert!(close(linear.spectrum(0.75, 0.25), [0.215_860_43; 4], 1e-3));
    assert!(close(linear.spectrum(0.25, 0.75), [0.577_580_75; 4], 1e-3));
}

/// Colours in XYZ are converted, `raw` or not, as in Mitsuba, whose numbers these are. Of two layers
/// a note says which one it is.
#[test]
fn colours_are_rec_709_whatever_the_file_holds() {
    let mut files = Files::default();
    files.add("xyz.exr", 1, &[("X", &[0.3]), ("Y", &[0.4]), ("Z", &[0.5])]);
    for raw in [false, true] {
        let properties = vec![("filename", text("xyz.exr")), ("raw", Value::Boolean(raw))];
        let texture = One::new(
            &files,
            &node("bitmap", properties),
            SpectrumKind::Reflectance,
        );
        let colour = texture.colour(0.5, 0.5);
        let right = Vec3::new(0.108_016, 0.480_398, 0.463_733);
        assert!((colour - right).abs().max_element() < 3e-3, "{colour}");
    }
    let one = [0.25_f32];
    let names = [
        "AO.R",
        "AO.G",
        "AO.B",
        "Combined.R",
        "Combined.G",
        "Combined.B",
    ];
    let channels: Vec<(&str, &[f32])> = names.iter().map(|name| (*name, &one[..])).collect();
    files.add("two.exr", 1, &channels);
    let properties = vec![("filename", text("two.exr"))];
    let (.., messages) = read(
        &files,
        &node("bitmap", properties),
        SpectrumKind::Reflectance,
    );
    assert!(
        matches!(&messages[..], [m] if m.contains("`two.exr`") && m.contains("`Combined`")),
        "{messages:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::with_cases(300)
    })]

    /// An interpolated value lies between those of the texels, is continuous, and repeats with
    /// the image (2 × 2 texels, so that whole turns are exact).
    #[test]
    fn interpolation_is_bounded_continuous_and_periodic(
        u in -2.0f32..2.0, v in -2.0f32..2.0, turn in -3i32..3, mode in 0usize..3,
    ) {
        let wrap = ["repeat", "mirror", "clamp"][mode];
        let texture = bitmap("colour.exr", vec![
            ("raw", Value::Boolean(true)),
            ("wrap_mode", text(wrap)),
        ]);
        let here = texture.colour(u, v);
        prop_assert!(here.min_element() >= -1e-6 && here.max_element() <= 1.0 + 1e-6);
        let near = texture.colour(u + 1e-4, v - 1e-4);
        // At most 2 texels × the range 1 per unit of u or v.
        prop_assert!((near - here).abs().max_element() < 5e-4);
        let period = match mode {
            0 => 1.0,
            1 => 2.0,
            _ => return Ok(()),
        };
        let far = texture.colour(u + period * turn as f32, v);
        prop_assert!((far - here).abs().max_element() < 1e-5);
    }
}
