//! Images beyond whose border there is nothing, with other exponents, and inverted.

use super::*;
use etalon_math::float64::pow;
use etalon_spectrum::Spectrum;

/// 2 × 1 texels of eight bits: (51, 102, 204) and white.
fn picture(more: Vec<(&'static str, Value)>) -> One {
    let mut files = Files::default();
    let rgb = [51, 102, 204, 255, 255, 255];
    let png = etalon_images::png::encode_rgb(&rgb, 2, 1).expect("two pixels");
    files.0.insert("two.png".into(), Arc::new(png));
    let mut properties = vec![
        ("filename", text("two.png")),
        ("filter_type", text("nearest")),
    ];
    properties.extend(more);
    One::new(
        &files,
        &node("bitmap", properties),
        SpectrumKind::Reflectance,
    )
}

fn has_colour(texture: &One, rgb: [f64; 3]) {
    let expected = Spectrum::reflectance(rgb)
        .expect("within [0, 1]")
        .eval(LAMBDA);
    let found = texture.spectrum(0.25, 0.5);
    assert!(
        close(found, expected.to_array(), 1e-5),
        "{found} {expected}"
    );
}

#[test]
fn exponents_take_the_place_of_srgb() {
    let share = [51.0_f64, 102.0, 204.0].map(|byte| byte / 255.0);
    let exponent = |x: f64| vec![("exponent", Value::Float(x))];
    has_colour(&picture(exponent(2.2)), share.map(|x| pow(x, 2.2)));
    has_colour(&picture(exponent(1.0)), share);
}

#[test]
fn inverted_colours() {
    let linear = [51, 102, 204].map(|byte: u8| {
        let x = f64::from(byte) / 255.0;
        pow((x + 0.055) / 1.055, 2.4)
    });
    let inverted = picture(vec![("invert", Value::Boolean(true))]);
    has_colour(&inverted, linear.map(|x| 1.0 - x));
    assert!(
        inverted.number(0.75, 0.5).abs() < 1e-5,
        "white becomes black"
    );
    let both = picture(vec![
        ("invert", Value::Boolean(true)),
        ("exponent", Value::Float(2.0)),
    ]);
    has_colour(&both, [0.96, 0.84, 0.36]);
}

/// One texel of the value ½: a tent of half a texel's slope beyond its middle, and nothing from a texel on.
///
/// Mutants rejected: `zero` as `clamp`; weights that are made to sum to one.
#[test]
fn nothing_is_beyond_the_border() {
    let mut files = Files::default();
    files.add("one.exr", 1, &[("Y", &[0.5])]);
    let texture = |filter: &str| {
        let properties = vec![
            ("filename", text("one.exr")),
            ("wrap_mode", text("zero")),
            ("filter_type", text(filter)),
        ];
        One::new(
            &files,
            &node("bitmap", properties),
            SpectrumKind::Reflectance,
        )
    };
    let smooth = texture("bilinear");
    for (u, v, expected) in [
        (0.5, 0.5, 0.5),
        (1.0, 0.5, 0.25),
        (0.25, 0.75, 0.5 * 0.75 * 0.75),
        (1.5, 0.5, 0.0),
        (0.5, -2.0, 0.0),
    ] {
        let found = smooth.number(u, v);
        assert!((found - expected).abs() < 1e-6, "{u} {v} {found}");
        assert!(close(smooth.spectrum(u, v), [expected; 4], 1e-6));
    }
    assert!(!smooth.set.is_constant(smooth.id));
    let slope = |u, v| {
        let at = TexturePoint::at_uv(Vec2::new(u, v));
        smooth
            .set
            .gradient(smooth.id, &OneShape, &at, [Vec3::ZERO; 2])
    };
    assert!((slope(1.0, 0.75) - Vec2::new(-0.375, -0.25)).length() < 1e-6);
    assert_eq!(slope(3.0, 0.5), Vec2::ZERO);
    let steps = texture("nearest");
    assert_eq!(
        [steps.number(0.99, 0.5), steps.number(1.01, 0.5)],
        [0.5, 0.0]
    );
}
