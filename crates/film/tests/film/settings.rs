//! Reading films and filters from a scene: defaults, limits, and what is said of mistakes.

use etalon_film::{FileFormat, FilmSettings, Filter, PixelFormat};
use etalon_params::{
    Class, Diagnostics, FileId, Node, Params, Property, Severity, Span, Spanned, Value,
};
use glam::UVec2;
use std::sync::Arc;

const SPAN: Span = Span {
    file: FileId(0),
    start: 0,
    end: 0,
};

fn node(class: Class, plugin: &str, properties: Vec<(&str, Value)>) -> Node {
    Node {
        class,
        plugin: Spanned {
            value: plugin.to_owned(),
            span: SPAN,
        },
        id: None,
        span: SPAN,
        properties: properties
            .into_iter()
            .map(|(name, value)| Property::new(name, SPAN, value, SPAN))
            .collect(),
    }
}

fn filter_node(plugin: &str, properties: Vec<(&str, Value)>) -> Value {
    Value::Object(Arc::new(node(
        Class::ReconstructionFilter,
        plugin,
        properties,
    )))
}

/// The film, and the messages about it.
fn read(properties: Vec<(&str, Value)>) -> (FilmSettings, Vec<(Severity, String)>) {
    let film = node(Class::Film, "hdrfilm", properties);
    let diagnostics = Diagnostics::new();
    let params = Params::new(&film, &diagnostics);
    let settings = FilmSettings::from_params(&params);
    params.finish();
    let messages = diagnostics.into_sorted().into_iter().map(|d| {
        let help = d.help.unwrap_or_default();
        (d.severity, format!("{} {help}", d.message))
    });
    (settings, messages.collect())
}

fn integer(i: i64) -> Value {
    Value::Integer(i)
}

fn word(s: &str) -> Value {
    Value::String(s.to_owned())
}

#[test]
fn defaults_are_mitsubas() {
    let (settings, messages) = read(vec![]);
    assert_eq!(messages, []);
    assert_eq!(settings, FilmSettings::new(768, 576, Filter::default()));
    assert_eq!(settings.filter.to_string(), "gaussian stddev=0.5");
    let filters = [
        ("box", "box"),
        ("tent", "tent radius=1"),
        ("gaussian", "gaussian stddev=0.5"),
        (
            "mitchell",
            "mitchell B=0.3333333333333333 C=0.3333333333333333",
        ),
        ("catmullrom", "catmullrom"),
        ("lanczos", "lanczos lobes=3"),
    ];
    for (plugin, description) in filters {
        let (settings, messages) = read(vec![("", filter_node(plugin, vec![]))]);
        assert_eq!(messages, []);
        assert_eq!(settings.filter.to_string(), description);
    }
}

#[test]
fn everything_can_be_said() {
    let lanczos = filter_node("lanczos", vec![("lobes", integer(2))]);
    let (settings, messages) = read(vec![
        ("width", integer(100)),
        ("height", integer(80)),
        ("crop_offset_x", integer(10)),
        ("crop_offset_y", integer(20)),
        ("crop_width", integer(90)),
        ("crop_height", integer(1)),
        ("pixel_format", word("LUMINANCE_alpha")),
        ("file_format", word("pfm")),
        ("component_format", word("float32")),
        ("sample_border", Value::Boolean(true)),
        ("banner", Value::Boolean(false)),
        ("compensate", Value::Boolean(false)),
        ("rfilter", lanczos),
    ]);
    assert_eq!(messages, []);
    assert_eq!(settings.size, UVec2::new(100, 80));
    assert_eq!(settings.crop_offset, UVec2::new(10, 20));
    assert_eq!(settings.crop_size, UVec2::new(90, 1));
    assert_eq!(settings.pixel_format, PixelFormat::LuminanceAlpha);
    assert_eq!(settings.file_format, FileFormat::Pfm);
    assert_eq!(settings.filter.radius(), 2.0);
}

#[test]
fn mistakes_are_told() {
    let error = |properties: Vec<(&str, Value)>, part: &str| {
        let (settings, messages) = read(properties);
        let [(Severity::Error, message)] = messages.as_slice() else {
            panic!("not one error for `{part}`: {messages:?}");
        };
        assert!(message.contains(part), "{message}");
        // Whatever is returned can be built without harm.
        let end = settings.crop_offset + settings.crop_size;
        assert!(end.cmple(settings.size).all() && settings.crop_size.cmpgt(UVec2::ZERO).all());
    };
    error(vec![("width", integer(0))], "from 1 to 65536");
    error(vec![("height", integer(-3))], "cannot be -3");
    error(vec![("width", integer(i64::MAX))], "from 1 to 65536");
    error(vec![("width", Value::Float(4.5))], "must be an integer");
    error(vec![("crop_offset_x", integer(3))], "ends at x = 771");
    error(vec![("crop_height", integer(577))], "ends at y = 577");
    error(vec![("pixel_format", word("luminence"))], "`luminance`");
    error(vec![("file_format", word("png"))], "openexr");
    error(
        vec![("high_quality_corners", Value::Boolean(true))],
        "high_quality_corners",
    );
    let filter = |plugin, properties| vec![("", filter_node(plugin, properties))];
    error(filter("gausian", vec![]), "`gaussian`");
    error(
        filter("tent", vec![("radius", Value::Float(0.0))]),
        "above 0",
    );
    error(
        filter("gaussian", vec![("stddev", Value::Float(-1.0))]),
        "cannot be -1",
    );
    error(
        filter("mitchell", vec![("A", Value::Float(0.3))]),
        "parameter `A`",
    );
    error(
        filter("mitchell", vec![("C", Value::Float(f64::NAN))]),
        "`C`",
    );
    error(
        filter("lanczos", vec![("lobes", integer(0))]),
        "from 1 to 64",
    );
    error(
        filter("box", vec![("radius", Value::Float(-1.0))]),
        "above 0",
    );
    let two = vec![
        ("", filter_node("box", vec![])),
        ("b", filter_node("box", vec![])),
    ];
    error(two, "one rfilter only");
}

#[test]
fn other_component_formats_are_noted() {
    let (_, messages) = read(vec![("component_format", word("float16"))]);
    let [(Severity::Note, message)] = messages.as_slice() else {
        panic!("not one note: {messages:?}");
    };
    assert!(message.contains("32-bit"), "{message}");
}

/// What a film in XYZ stores becomes the colour it was, to the last bits, wherever its file is used.
/// With the white of the standard's four digits it would be off by 3 · 10⁻⁴.
#[test]
fn films_in_xyz_give_back_their_colours() {
    let rgb = [0.2, 0.5, 0.9];
    let mut image = etalon_images::Image::new(1, 1);
    for (name, value) in ["X", "Y", "Z"].iter().zip(PixelFormat::Xyz.convert(rgb)) {
        image.push(*name, vec![value]);
    }
    let colour = image.colour().expect("a colour");
    for (found, right) in colour.planes.iter().zip(rgb) {
        assert!((found[0] - right).abs() < 1e-6, "{} {right}", found[0]);
    }
}

/// What Mitsuba 0.6 has beside the formats of today: one for each part of a spectrum, and lists.
#[test]
fn pixel_formats_of_mitsuba_06_are_read_with_a_note() {
    for (given, format, words) in [
        ("spectrum", PixelFormat::Rgb, "`specfilm` keeps bands"),
        ("Luminance, rgb", PixelFormat::Luminance, "the first counts"),
        ("luminanceAlpha", PixelFormat::LuminanceAlpha, ""),
    ] {
        let (settings, messages) = read(vec![("pixel_format", word(given))]);
        assert_eq!(settings.pixel_format, format, "{given}");
        let said = messages.iter().map(|(severity, text)| {
            assert_eq!(*severity, Severity::Note, "{text}");
            text.as_str()
        });
        assert!(said.collect::<String>().contains(words), "{messages:?}");
    }
    let (_, messages) = read(vec![("pixel_format", word("rainbow, rgb"))]);
    assert!(messages.iter().any(|(severity, text)| {
        *severity == Severity::Error && text.contains("cannot be rainbow, rgb")
    }));
}
