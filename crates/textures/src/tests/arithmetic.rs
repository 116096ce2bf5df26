//! Textures computed from others.

use super::*;
use etalon_math::float64::{exp, pow};

fn one(plugin: &str, properties: Vec<(&'static str, Value)>, role: SpectrumKind) -> One {
    One::new(&Files::default(), &node(plugin, properties), role)
}

fn at(one: &One, uv: Vec2) -> [f32; 2] {
    let at = TexturePoint::at_uv(uv);
    let spectrum = one.set.spectrum(one.id, &OneShape, &at, LAMBDA);
    [one.set.number(one.id, &OneShape, &at), spectrum.x]
}

/// Spectra 0.8 and 0.4, numbers the other way round, see `checkerboard`.
fn squares() -> Value {
    let colours = vec![("color0", Value::Float(0.8)), ("color1", Value::Float(0.4))];
    Value::Object(node("checkerboard", colours))
}

#[test]
fn values_are_those_of_the_formulas() {
    let role = SpectrumKind::Reflectance;
    let pair = |b: f64| vec![("a", squares()), ("b", Value::Float(b))];
    let near = |found: [f32; 2], expected: [f32; 2]| {
        let off = (found[0] - expected[0])
            .abs()
            .max((found[1] - expected[1]).abs());
        assert!(off < 1e-6, "{found:?} {expected:?}");
    };
    let corner = Vec2::splat(0.1);
    near(at(&one("multiply", pair(0.5), role), corner), [0.2, 0.4]);
    near(at(&one("add", pair(0.1), role), corner), [0.5, 0.9]);
    // Held to 1.
    near(at(&one("add", pair(0.5), role), corner), [0.9, 1.0]);
    near(
        at(&one("add", pair(0.5), SpectrumKind::Unbounded), corner),
        [0.9, 1.3],
    );
    near(at(&one("mix", pair(0.0), role), corner), [0.2, 0.4]);
    let mut weighed = pair(0.0);
    weighed.push(("weight", Value::Float(0.25)));
    let mixed = one("mix", weighed, role);
    near(at(&mixed, corner), [0.3, 0.6]);
    near(at(&mixed, Vec2::new(0.6, 0.1)), [0.6, 0.3]);
    assert!(
        (mixed.set.mean(mixed.id) - 0.45).abs() < 1e-6
            && !mixed.set.get(mixed.id).is_constant(&mixed.set)
    );
    let scaled = vec![("texture", squares()), ("scale", Value::Float(1.5))];
    near(at(&one("scale", scaled, role), corner), [0.6, 1.0]);
}

/// A conductor of η = 1 and this k has the reflectance again, by Fresnel's formula.
#[test]
fn extinctions_give_their_reflectance() {
    for reflectance in [0.0, 0.04, 0.5, 0.95] {
        let properties = vec![("reflectance", Value::Float(reflectance))];
        let one = One::new(
            &Files::default(),
            &node("extinction", properties),
            SpectrumKind::Index,
        );
        let square = f64::from(one.spectrum(0.0, 0.0).x).powi(2);
        let found = square / (4.0 + square);
        assert!((found - reflectance).abs() < 1e-6, "{found}");
        assert_eq!(one.number(0.0, 0.0), one.spectrum(0.0, 0.0).w);
    }
}

/// By Planck's law written out with hc/k = 14.387769 mm K; of 5000 K the most is at 579.55 nm. What is cold emits nothing.
#[test]
fn bodies_glow_by_their_temperature() {
    let at = |temperature: &str| {
        let input = super::rules::object("expression", vec![("value", text(temperature))]);
        One::new(
            &Files::default(),
            &node(
                "incandescence",
                vec![("temperature", input), ("scale", Value::Float(2.0))],
            ),
            SpectrumKind::Emission,
        )
    };
    let body = at("2000 + 6000*u");
    for (u, temperature) in [(0.0, 2000.0), (0.5, 5000.0), (1.0, 8000.0)] {
        let law = |nm: f64| 1.0 / (pow(nm, 5.0) * (exp(1.438_776_9e7 / (nm * temperature)) - 1.0));
        let most = law(2.897_771_955e6 / temperature);
        let expected = LAMBDA
            .to_array()
            .map(|nm| (2.0 * law(nm.into()) / most) as f32);
        let found = body.spectrum(u, 0.0);
        let off = (found / Vec4::from_array(expected) - 1.0).abs();
        assert!(
            off.max_element() < 1e-4,
            "{temperature} {found} {expected:?}"
        );
    }
    assert_eq!(at("100").spectrum(0.0, 0.0), Vec4::ZERO);
}
