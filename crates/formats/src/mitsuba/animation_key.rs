//! `<animation name="…" interpolation="…">`: a parameter's values at times of the scene.
//!
//! Its children are properties with a `time` instead of a name, all with one tag. A transform moves while the shutter
//! is open; any other parameter has its value in the middle of the interval, so that plugins never see it change.

use super::animation::Animation;
use super::attribute::{Attributes, tag_span};
use super::reader::{File, Reader};
use super::tags::Tag;
use super::{operation, value};
use etalon_math::{Interpolation, Motion, MotionError, MotionKey};
use etalon_params::{DMat4, DVec3, Diagnostic, Span, SpectrumText, Value};
use roxmltree::Node;
use std::sync::Arc;

/// A value at a moment, as written.
#[derive(Clone, Debug)]
struct AnimationKey {
    time: f64,
    value: Value,
    tangent: Option<DVec3>,
    /// Its tag.
    tag: Span,
}

/// Reads an `<animation>`. `None` after a mistake, which has been reported.
pub(crate) fn read(
    reader: &mut Reader<'_>,
    file: &File,
    node: Node<'_, '_>,
    attributes: &Attributes<'_>,
) -> Option<Animation> {
    let before = reader.mistakes();
    let children: Vec<_> = node.children().filter(Node::is_element).collect();
    let Some(first) = children.first() else {
        let message = "an `<animation>` needs a key at least";
        let help = "such as `<float time=\"0\" value=\"1\"/>` or `<transform time=\"0\">`";
        reader.report(Diagnostic::error(attributes.tag_span, message).help(help));
        return None;
    };
    let kind = first.tag_name().name();
    let mut keys: Vec<AnimationKey> = Vec::new();
    for child in &children {
        let name = child.tag_name().name();
        if name != kind {
            let message = format!("a `<{name}>` among keys that are `<{kind}>`");
            let diagnostic = Diagnostic::error(tag_span(file.id, *child), message)
                .label("of another kind")
                .related(tag_span(file.id, *first), "the first key is here");
            reader.report(diagnostic.help("all keys of an `<animation>` have one tag"));
        } else if let Some(found) = key(reader, file, *child) {
            if let Some(last) = keys.last()
                && found.time <= last.time
            {
                let message = format!(
                    "the time of a key must be after that before it, but {} follows {}",
                    found.time, last.time
                );
                reader.report(
                    Diagnostic::error(found.tag, message)
                        .label("out of order")
                        .related(last.tag, "the key before it is here"),
                );
            }
            keys.push(found);
        }
    }
    let interpolation = interpolation(reader, attributes, &keys, kind);
    if reader.mistakes() > before {
        return None;
    }
    if kind == "transform" {
        return motion(reader, attributes, interpolation?, &keys);
    }
    if let Some(other) = keys.iter().find(|key| !alike(&key.value, &keys[0].value)) {
        let message = "the spectra of all keys have one number, or values at the same wavelengths";
        let diagnostic = Diagnostic::error(other.tag, message);
        reader.report(diagnostic.related(keys[0].tag, "the first key has others"));
        return None;
    }
    let keys = keys
        .into_iter()
        .map(|key| (key.time, key.value, key.tangent));
    Some(Animation::Changing(interpolation?, keys.collect()))
}

/// Whether there is something between two values: not between spectra of other wavelengths.
fn alike(a: &Value, b: &Value) -> bool {
    let wavelengths = |value: &Value| match value {
        Value::Spectrum(SpectrumText::Samples(samples)) => {
            samples.iter().map(|(wavelength, _)| *wavelength).collect()
        }
        _ => Vec::new(),
    };
    wavelengths(a) == wavelengths(b)
}

/// Reads one key.
fn key(reader: &mut Reader<'_>, file: &File, node: Node<'_, '_>) -> Option<AnimationKey> {
    let name = node.tag_name().name();
    let tag = tag_span(file.id, node);
    let accepted: &[&'static str] = match Tag::of(name) {
        Some(Tag::Transform) => &["!time", "tangent"],
        Some(Tag::Float) | Some(Tag::Rgb) => &["!time", "tangent", "!value"],
        Some(Tag::Vector) => &["!time", "tangent", "value", "x", "y", "z"],
        Some(Tag::Spectrum) => &["!time", "value", "filename"],
        Some(Tag::Integer | Tag::Boolean | Tag::String) => &["!time", "!value"],
        _ => {
            let message = format!("`<{name}>` cannot stand in an `<animation>`");
            reader.report(Diagnostic::error(tag, message).help(
                "accepted: `<transform time=\"0.5\">`, `<float time=\"0.5\" value=\"1\"/>`, and so \
                 `<rgb>`, `<spectrum>`, `<point>`, `<vector>`, `<integer>`, `<boolean>`, `<string>`",
            ));
            return None;
        }
    };
    let attributes = Attributes::read(reader, file.id, node, accepted)?;
    let time = attributes.float(reader, "time");
    let tangent = match attributes.get("tangent") {
        None => None,
        Some(_) => {
            let counts: &[usize] = if name == "float" { &[1] } else { &[3] };
            let numbers = attributes.list(reader, "tangent", counts)?;
            let number = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
            Some(DVec3::new(number(0), number(1), number(2)))
        }
    };
    let value = match Tag::of(name) {
        Some(Tag::Transform) => Value::Transform(operation::operations(reader, file, node)?),
        tag => value::value(reader, file, tag?, node, &attributes).0,
    };
    Some(AnimationKey {
        time: time?,
        value,
        tangent,
        tag,
    })
}

/// The way between the keys: as written, or the simplest that their kind has.
fn interpolation(
    reader: &mut Reader<'_>,
    attributes: &Attributes<'_>,
    keys: &[AnimationKey],
    kind: &str,
) -> Option<Interpolation> {
    let steps = matches!(kind, "integer" | "boolean" | "string");
    let names = || Interpolation::ALL.map(Interpolation::name);
    let Some(attribute) = attributes.get("interpolation") else {
        let way = if steps {
            Interpolation::Step
        } else {
            Interpolation::Linear
        };
        return Some(way);
    };
    let Some(way) = Interpolation::named(attribute.text.trim()) else {
        let message = format!("`{}` is not an interpolation", attribute.text);
        let diagnostic = attribute.error_whole(message);
        reader.report(diagnostic.suggest(&attribute.text, names()));
        return None;
    };
    if steps && way != Interpolation::Step {
        let message = format!("keys that are `<{kind}>` have nothing between them");
        let diagnostic = attribute.error_whole(message);
        reader.report(diagnostic.help("accepted: interpolation=\"step\""));
        return None;
    }
    if kind == "spectrum" && way == Interpolation::Hermite {
        let diagnostic = attribute.error_whole("spectra have no tangents");
        reader.report(diagnostic.help("accepted: step, linear, catmull-rom, cubic"));
        return None;
    }
    if !way.takes(keys.len()) {
        let message = format!("`cubic` goes through 4, 7, 10 … keys, not {}", keys.len());
        reader.report(attribute.error_whole(message));
        return None;
    }
    let mut sound = true;
    for key in keys {
        let wants = way == Interpolation::Hermite;
        if wants != key.tangent.is_some() {
            let message = match wants {
                true => "each key of `hermite` needs a `tangent`: the change per unit of time",
                false => "only the keys of `hermite` have a `tangent`",
            };
            reader.report(Diagnostic::error(key.tag, message));
            sound = false;
        }
    }
    sound.then_some(way)
}

/// The motion through transforms.
fn motion(
    reader: &mut Reader<'_>,
    attributes: &Attributes<'_>,
    interpolation: Interpolation,
    keys: &[AnimationKey],
) -> Option<Animation> {
    let matrix = |value: &Value| match value {
        Value::Transform(matrix) => *matrix,
        _ => DMat4::IDENTITY,
    };
    let moments: Vec<MotionKey> = (keys.iter())
        .map(|key| MotionKey {
            time: key.time,
            matrix: matrix(&key.value),
            velocity: key.tangent,
        })
        .collect();
    let mistake = match Motion::new(interpolation, &moments) {
        Ok(motion) => return Some(Animation::Moving(Arc::new(motion))),
        Err(mistake) => mistake,
    };
    let tag = |key: usize| keys.get(key).map_or(attributes.tag_span, |key| key.tag);
    let diagnostic = match mistake {
        MotionError::Count => Diagnostic::error(attributes.tag_span, "an animation of no keys"),
        MotionError::Order(key) => Diagnostic::error(tag(key), "a key out of order"),
        MotionError::Singular(key) => {
            Diagnostic::error(tag(key), "the transform of a key cannot be undone")
                .label("flattens space, is projective, or is not finite")
        }
        MotionError::Mirrors(key) => Diagnostic::error(
            tag(key),
            "one of two keys mirrors space, the other does not",
        )
        .related(tag(key.saturating_sub(1)), "the key before it is here"),
        MotionError::Flattens(key) => {
            let message = "between this key and the next the scale swings through zero";
            Diagnostic::error(tag(key), message).help("more keys, or `linear`")
        }
    };
    reader.report(diagnostic);
    None
}
