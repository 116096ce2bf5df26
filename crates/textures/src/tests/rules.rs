//! Which spectrum a property stands for, against Mitsuba 3.9.1 (`scalar_spectral`).

use super::*;
use etalon_params::{DMat4, DVec3, Params, SpectrumText};
use glam::DVec3 as Rgb;

pub(super) fn rgb(r: f64, g: f64, b: f64) -> Value {
    Value::Rgb(Rgb::new(r, g, b))
}

pub(super) fn object(plugin: &str, properties: Vec<(&str, Value)>) -> Value {
    Value::Object(node(plugin, properties))
}

/// The texture in a parameter, or the messages why there is none.
pub(super) fn parameter(
    value: Option<Value>,
    default: Option<f64>,
    role: SpectrumKind,
) -> Result<One, Vec<String>> {
    let properties = value.map(|value| ("radiance", value));
    let owner = node("owner", properties.into_iter().collect());
    let mut set = TextureTable::new();
    let diagnostics = Diagnostics::new();
    let mut reader = TextureReader {
        set: &mut set,
        assets: &Files::default(),
        diagnostics: &diagnostics,
    };
    let params = Params::new(&owner, &diagnostics);
    let id = reader.parameter(&params, "radiance", default, role);
    params.finish();
    let messages: Vec<_> = diagnostics
        .into_sorted()
        .into_iter()
        .filter(|d| d.severity == etalon_params::Severity::Error)
        .map(|d| d.message)
        .collect();
    if messages.is_empty() {
        Ok(One { set, id })
    } else {
        Err(messages)
    }
}

pub(super) fn eval(value: Value, role: SpectrumKind) -> Vec4 {
    let texture = parameter(Some(value), None, role).unwrap_or_else(|m| panic!("{m:?}"));
    texture.spectrum(0.25, 0.25)
}

const D65: [f32; 4] = [0.835_929_9, 1.170_97, 1.010_127, 0.808_372_6];

/// Tolerance for values that contain D65: Mitsuba rounds the factor that makes it white, which
/// leaves it 9·10⁻⁵ darker.
const NEAR: f32 = 1.2e-4;

#[test]
fn numbers_are_constant_and_as_light_d65() {
    for value in [Value::Float(2.0), Value::Integer(2)] {
        // No more than all light can be reflected.
        assert!(close(
            eval(value.clone(), SpectrumKind::Reflectance),
            [1.0; 4],
            0.0
        ));
        assert!(close(
            eval(value.clone(), SpectrumKind::Unbounded),
            [2.0; 4],
            0.0
        ));
        assert!(close(
            eval(value, SpectrumKind::Emission),
            D65.map(|x| 2.0 * x),
            2.0 * NEAR
        ));
    }
    let default =
        parameter(None, Some(1.0), SpectrumKind::Emission).unwrap_or_else(|m| panic!("{m:?}"));
    assert!(close(default.spectrum(0.0, 0.0), D65, NEAR));
}

/// The spectra of colours come from a table of the same family as Mitsuba's, not the same one:
/// 0.02 relative to the brightest component.
#[test]
fn colours_follow_their_role() {
    let colour = || rgb(0.2, 0.5, 0.8);
    let reflectance = [0.859_670_7, 0.700_576_7, 0.440_470_4, 0.213_276_3];
    assert!(close(
        eval(colour(), SpectrumKind::Reflectance),
        reflectance,
        0.02
    ));
    let bright = || rgb(0.2, 0.5, 2.0);
    let light = [2.540_741, 1.456_653, 0.455_284_8, 0.185_323_7];
    assert!(close(eval(bright(), SpectrumKind::Emission), light, 0.05));
    assert!(close(
        eval(bright(), SpectrumKind::Reflectance),
        eval(rgb(0.2, 0.5, 1.0), SpectrumKind::Reflectance).to_array(),
        0.0
    ));
    // What may be above 1 is not held to it: the light without D65.
    let unbounded = || {
        object(
            "srgb",
            vec![("color", bright()), ("unbounded", Value::Boolean(true))],
        )
    };
    for value in [bright(), unbounded()] {
        let found = eval(value, SpectrumKind::Unbounded);
        assert!(close(found * Vec4::from(D65), light, 0.05), "{found}");
    }
    let d65 = object("d65", vec![("color", bright())]);
    assert!(close(eval(d65, SpectrumKind::Emission), light, 0.05));
}

#[test]
fn spectra_are_what_is_written_where_they_are_unbounded() {
    for role in [SpectrumKind::Emission, SpectrumKind::Unbounded] {
        let uniform = Value::Spectrum(SpectrumText::Uniform(2.0));
        assert!(close(eval(uniform, role), [2.0; 4], 0.0));
        let pairs = vec![(400.0, 1.0), (500.0, 2.0), (650.0, 4.0)];
        let samples = Value::Spectrum(SpectrumText::Samples(pairs));
        assert!(close(eval(samples, role), [1.0, 1.8, 2.8, 4.0], 1e-5));
        let irregular = object(
            "irregular",
            vec![
                ("wavelengths", text("400 500 650")),
                ("values", text("1, 2,4")),
            ],
        );
        assert!(close(eval(irregular, role), [1.0, 1.8, 2.8, 4.0], 1e-5));
        let regular = object(
            "regular",
            vec![
                ("wavelength_min", Value::Float(400.0)),
                ("wavelength_max", Value::Float(700.0)),
                ("values", text("1, 2")),
            ],
        );
        let expected = [1.0, 1.266_667, 1.533_333, 1.833_333];
        assert!(close(eval(regular, role), expected, 1e-5));
        let ranged = object(
            "uniform",
            vec![
                ("value", Value::Float(2.0)),
                ("wavelength_min", Value::Float(450.0)),
                ("wavelength_max", Value::Float(600.0)),
            ],
        );
        assert!(close(eval(ranged, role), [2.0; 4], 0.0));
        let body = |more: Vec<(&'static str, Value)>| {
            let mut properties = vec![("temperature", Value::Float(5000.0))];
            properties.extend(more);
            eval(object("blackbody", properties), role)
        };
        let emitted = [8_743.565, 11_674.82, 12_762.18, 12_415.3];
        assert!(close(body(vec![]), emitted, 2.0), "{}", body(vec![]));
        let some = body(vec![
            ("wavelength_min", Value::Float(450.0)),
            ("wavelength_max", Value::Float(600.0)),
        ]);
        assert!(close(some, [0.0, emitted[1], emitted[2], 0.0], 2.0));
        let white = object("d65", vec![("scale", Value::Float(3.0))]);
        assert!(close(eval(white, role), D65.map(|x| 3.0 * x), 3.0 * NEAR));
    }
}

/// Nested values are reflectances, whatever the outermost property is for.
#[test]
fn nested_values_are_not_multiplied_by_d65() {
    let board = || object("checkerboard", vec![("color0", Value::Float(1.0))]);
    assert!(close(eval(board(), SpectrumKind::Emission), [1.0; 4], 0.0));
    let lit = object(
        "d65",
        vec![("anything", board()), ("scale", Value::Float(2.0))],
    );
    assert!(close(
        eval(lit, SpectrumKind::Emission),
        D65.map(|x| 2.0 * x),
        2.0 * NEAR
    ));
}

#[test]
fn checkerboard_matches_mitsuba() {
    let plain = One::new(
        &Files::default(),
        &node("checkerboard", vec![]),
        SpectrumKind::Reflectance,
    );
    for (u, v, spectrum, number) in [
        (0.25, 0.25, 0.4, 0.2),
        (0.75, 0.25, 0.2, 0.4),
        (0.25, 0.75, 0.2, 0.4),
        (0.75, 0.75, 0.4, 0.2),
        (0.5, 0.25, 0.4, 0.2),
        (0.0, 0.0, 0.4, 0.2),
        (1.0, 0.25, 0.4, 0.2),
        (-0.25, 0.25, 0.2, 0.4),
    ] {
        assert!(close(plain.spectrum(u, v), [spectrum; 4], 0.0), "{u} {v}");
        assert_eq!(plain.number(u, v), number);
    }
    assert!((plain.set.mean(plain.id) - 0.3).abs() < 1e-6);
    let scale = DMat4::from_scale(DVec3::new(2.0, 3.0, 1.0));
    let to_uv = Value::Transform(scale * DMat4::from_translation(DVec3::new(0.1, 0.2, 0.0)));
    let moved = node("checkerboard", vec![("to_uv", to_uv)]);
    let moved = One::new(&Files::default(), &moved, SpectrumKind::Reflectance);
    for (u, v, expected) in [(0.1, 0.1, 0.2), (0.2, 0.1, 0.4), (0.3, 0.2, 0.2)] {
        assert!(close(moved.spectrum(u, v), [expected; 4], 0.0), "{u} {v}");
    }
}

#[test]
fn numbers_of_spectra() {
    let number = |plugin: &str, properties| {
        One::new(
            &Files::default(),
            &node(plugin, properties),
            SpectrumKind::Reflectance,
        )
        .number(0.1, 0.1)
    };
    assert_eq!(number("uniform", vec![("value", Value::Float(0.5))]), 0.5);
    assert_eq!(
        number("rawconstant", vec![("value", Value::Float(0.3))]),
        0.3
    );
    // The mean over the wavelengths, as in Mitsuba.
    let colour = number("srgb", vec![("color", rgb(0.2, 0.5, 0.8))]);
    assert!((colour - 0.418_522).abs() < 0.02, "{colour}");
    let three = Value::Vector(DVec3::new(0.2, 0.5, 0.8));
    let raw = One::new(
        &Files::default(),
        &node("rawconstant", vec![("value", three)]),
        SpectrumKind::Reflectance,
    );
    assert_eq!(raw.colour(0.0, 0.0), Vec3::new(0.2, 0.5, 0.8));
}

#[test]
fn an_object_is_read_once_per_role() {
    let board = node("checkerboard", vec![]);
    let mut set = TextureTable::new();
    let diagnostics = Diagnostics::new();
    let mut reader = TextureReader {
        set: &mut set,
        assets: &Files::default(),
        diagnostics: &diagnostics,
    };
    let first = reader.node(&board, SpectrumKind::Reflectance);
    assert_eq!(reader.node(&board, SpectrumKind::Reflectance), first);
    assert_ne!(reader.node(&board, SpectrumKind::Emission), first);
}

/// Each number that a reflectance is made of is held to 1; what is not above stays to the bit.
#[test]
fn reflectances_are_held_to_one() {
    let samples = |pairs: Vec<(f64, f64)>| {
        let table = Value::Spectrum(SpectrumText::Samples(pairs));
        eval(table, SpectrumKind::Reflectance)
    };
    // At 450, 540, 600 and 650 nm: on a flat top, and on slopes that lead to it.
    let wide = vec![(400.0, 0.2), (500.0, 2.0), (600.0, 4.0), (700.0, 0.5)];
    let held = vec![(400.0, 0.2), (500.0, 1.0), (600.0, 1.0), (700.0, 0.5)];
    assert_eq!(samples(wide), samples(held));
    let uneven = vec![(400.0, 0.2), (500.0, 2.0), (550.0, 0.25), (700.0, 0.75)];
    let held = vec![(400.0, 0.2), (500.0, 1.0), (550.0, 0.25), (700.0, 0.75)];
    assert_eq!(samples(uneven), samples(held));
    // D65 reaches 1.17 at 480 nm; what is below 1 stays.
    let lamp = eval(object("d65", vec![]), SpectrumKind::Reflectance);
    assert!(close(lamp, D65.map(|x| x.min(1.0)), 1e-3), "{lamp}");
    let nested = object(
        "checkerboard",
        vec![("color0", Value::Float(5.0)), ("color1", Value::Float(5.0))],
    );
    assert_eq!(eval(nested, SpectrumKind::Reflectance), Vec4::ONE);
    let nested = object(
        "checkerboard",
        vec![("color0", Value::Float(5.0)), ("color1", Value::Float(5.0))],
    );
    assert_eq!(eval(nested, SpectrumKind::Emission), Vec4::splat(5.0));
}

#[test]
fn mistakes_are_refused() {
    let role = SpectrumKind::Reflectance;
    let number = Value::Float;
    for (value, role, expected) in [
        (rgb(-0.2, 0.5, 0.1), role, "-0.2"),
        (
            object("srgb", vec![("color", rgb(0.2, 0.5, 2.0))]),
            role,
            "2",
        ),
        (rgb(-0.2, 0.5, 0.1), SpectrumKind::Emission, "-0.2"),
        (number(f64::NAN), role, "NaN"),
        (number(-1.0), SpectrumKind::Emission, "-1 is negative"),
        (text("red"), role, "must be a number, a colour"),
        (
            Value::Spectrum(SpectrumText::Samples(vec![(400.0, 1.0), (700.0, -1.0)])),
            SpectrumKind::Emission,
            "falls to",
        ),
        (
            object("plaid", vec![]),
            role,
            "unknown texture plugin `plaid`",
        ),
        (
            object("volume", vec![]),
            role,
            "needs the parameter `volume`",
        ),
        (
            object("srgb", vec![("color", number(0.5))]),
            role,
            "must be an rgb colour",
        ),
        (
            object("regular", vec![("values", text("1 2"))]),
            role,
            "wavelength_min",
        ),
        (
            object(
                "irregular",
                vec![("wavelengths", text("400 x")), ("values", text("1 2"))],
            ),
            role,
            "`x` in `wavelengths`",
        ),
        (
            object(
                "irregular",
                vec![("wavelengths", text("0.4 0.7")), ("values", text("1 2"))],
            ),
            role,
            "not in micrometres",
        ),
        (
            object(
                "regular",
                vec![
                    ("wavelength_min", number(0.4)),
                    ("wavelength_max", number(0.7)),
                    ("values", text("1 2")),
                ],
            ),
            role,
            "the wavelengths go from 0.4 to 0.7 nm",
        ),
        (
            object("mesh_attribute", vec![("name", text("colour"))]),
            role,
            "`colour`",
        ),
        (
            object(
                "d65",
                vec![("color", rgb(1.0, 1.0, 1.0)), ("t", object("d65", vec![]))],
            ),
            SpectrumKind::Emission,
            "either `color` or one nested texture",
        ),
    ] {
        let messages = parameter(Some(value), None, role).err().unwrap_or_default();
        assert!(
            messages.iter().any(|message| message.contains(expected)),
            "{expected}: {messages:?}"
        );
    }
    let missing = parameter(None, None, role).err().unwrap_or_default();
    assert!(matches!(&missing[..], [message] if message.contains("needs the parameter")));
}
