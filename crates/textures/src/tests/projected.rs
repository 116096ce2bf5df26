//! Textures by coordinates that follow from the place, and ramps of colours.

use super::rules::object;
use super::*;
use etalon_math::float64::{cos, sin};
use etalon_params::DMat4;
use etalon_spectrum::Spectrum;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The formula of u or of v, put on things.
fn projected(mapping: &str, formula: &str, to_world: DMat4) -> One {
    let inner = object("expression", vec![("value", text(formula))]);
    let properties = vec![
        ("mapping", text(mapping)),
        ("to_world", Value::Transform(to_world)),
        ("", inner),
    ];
    One::new(
        &Files::default(),
        &node("projected", properties),
        SpectrumKind::Unbounded,
    )
}

fn number_at(texture: &One, position: DVec3) -> f32 {
    let at = TexturePoint {
        position: position.as_vec3(),
        // Must not be looked at.
        ..TexturePoint::at_uv(Vec2::splat(0.77))
    };
    texture.set.number(texture.id, &OneShape, &at)
}

/// Points are made from their coordinates, and carried where `to_world` puts them.
///
/// Mutants rejected: the angle from −π to π, u and v exchanged, `to_world` not inverted.
#[test]
fn coordinates_are_those_that_points_were_made_from() {
    let to_world = DMat4::from_translation(DVec3::new(0.3, -1.0, 2.0))
        * DMat4::from_rotation_x(0.7)
        * DMat4::from_scale(DVec3::splat(1.5));
    let mut pairs = Vec::new();
    for i in 0..20 {
        let (u, v) = (
            (f64::from(i) + 0.5) / 20.0,
            (f64::from(7 * i % 20) + 0.5) / 20.0,
        );
        let (phi, theta) = (TAU * u, PI * v);
        let radius = 0.5 + 0.1 * f64::from(i);
        let ring = DVec3::new(cos(phi), sin(phi), 0.0);
        pairs.push(("planar", DVec3::new(u, v, radius), [u, v]));
        pairs.push(("cylindrical", radius * ring + v * DVec3::Z, [u, v]));
        let ball = sin(theta) * ring + cos(theta) * DVec3::Z;
        pairs.push(("spherical", radius * ball, [u, v]));
    }
    for mapping in ["planar", "cylindrical", "spherical"] {
        let [u, v] = ["u", "v"].map(|formula| projected(mapping, formula, to_world));
        let own = pairs.iter().filter(|(name, ..)| *name == mapping);
        for (_, place, [expected_u, expected_v]) in own {
            let position = to_world.transform_point3(*place);
            let found = [number_at(&u, position), number_at(&v, position)].map(f64::from);
            let off = (found[0] - expected_u)
                .abs()
                .max((found[1] - expected_v).abs());
            assert!(off < 1e-6, "{mapping} {place} {found:?}");
        }
    }
}

/// A bump on a plane is seen through the mapping: ∂u/∂x times how x moves.
#[test]
fn slopes_follow_the_place() {
    let texture = projected("planar", "u", DMat4::from_scale(DVec3::splat(2.0)));
    let at = TexturePoint {
        position: Vec3::new(0.4, 0.2, 0.0),
        ..TexturePoint::at_uv(Vec2::ZERO)
    };
    let moved = [Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 0.0)];
    let slope = texture.set.gradient(texture.id, &OneShape, &at, moved);
    assert!((slope - Vec2::new(1.5, 0.0)).length() < 1e-3, "{slope}");
}

fn ramp(properties: Vec<(&'static str, Value)>) -> One {
    let mut all = vec![("input", object("expression", vec![("value", text("u"))]))];
    all.extend(properties);
    One::new(
        &Files::default(),
        &node("ramp", all),
        SpectrumKind::Reflectance,
    )
}

/// Spectra are interpolated, and two colours at one place are a step.
#[test]
fn ramps_interpolate_the_spectra_of_their_colours() {
    let texture = ramp(vec![
        (
            "colors",
            text("0.8 0.1 0.1, 0.1 0.8 0.1, 0.2 0.2 0.2, 0.9 0.9 0.9"),
        ),
        ("positions", text("0.25, 0.5, 0.5, 1")),
    ]);
    let spectrum = |rgb| {
        Spectrum::reflectance(rgb)
            .expect("within [0, 1]")
            .eval(LAMBDA)
    };
    let (red, green) = (spectrum([0.8, 0.1, 0.1]), spectrum([0.1, 0.8, 0.1]));
    for (u, expected) in [
        (-3.0, red),
        (0.1, red),
        (0.25, red),
        (0.375, 0.5 * (red + green)),
        (0.5, Vec4::splat(0.2)),
        (0.75, Vec4::splat(0.55)),
        (1.0, Vec4::splat(0.9)),
        (7.0, Vec4::splat(0.9)),
    ] {
        let found = texture.spectrum(u, 0.3);
        assert!(
            close(found, expected.to_array(), 2e-5),
            "{u} {found} {expected}"
        );
    }
    assert!((texture.colour(0.375, 0.0) - Vec3::new(0.45, 0.45, 0.1)).length() < 1e-6);
    // Without positions they lie evenly from 0 to 1.
    let even = ramp(vec![("colors", text("0 0 0, 0.5 0.5 0.5, 1 1 1"))]);
    assert!((even.number(0.25, 0.0) - 0.25).abs() < 1e-6);
    assert!((even.number(0.75, 0.0) - 0.75).abs() < 1e-6);
}

#[test]
fn mistakes_of_ramps_and_of_what_is_projected() {
    let input = || ("input", Value::Float(0.5));
    for (plugin, properties, expected) in [
        (
            "ramp",
            vec![("colors", text("1 1 1"))],
            "needs the parameter `input`",
        ),
        (
            "ramp",
            vec![input(), ("colors", text("1 1"))],
            "three numbers for each colour",
        ),
        (
            "ramp",
            vec![
                input(),
                ("colors", text("1 1 1")),
                ("positions", text("0, 1")),
            ],
            "one finite number for each of the 1 `colors`",
        ),
        (
            "ramp",
            vec![
                input(),
                ("colors", text("0 0 0 1 1 1")),
                ("positions", text("1, 0")),
            ],
            "`positions` must ascend",
        ),
        ("projected", vec![], "one nested texture, not 0"),
    ] {
        let (_, _, messages) = read(
            &Files::default(),
            &node(plugin, properties),
            SpectrumKind::Reflectance,
        );
        assert!(
            matches!(&messages[..], [message] if message.contains(expected)),
            "{expected}: {messages:?}"
        );
    }
}
