//! A one-line notation for materials.
//!
//! `plugin key=kind:value … ( nested ) …` with the kinds `f` (number), `i` (integer), `s` (string, `_` for a
//! space), `b` (boolean), `u` (uniform spectrum) and `t` (tabulated spectrum, `nm:value,…`)
//! and `n` (the same as a nested object), `c` (a colour, `r,g,b`).

use etalon_params::{Class, DVec3, FileId, Node, Property, Span, Spanned, SpectrumText, Value};
use std::sync::Arc;

/// A place for things that stand nowhere.
pub(crate) const NOWHERE: Span = Span {
    file: FileId(0),
    start: 0,
    end: 0,
};

/// The description tree of a material.
pub(crate) fn node(text: &str) -> Arc<Node> {
    let mut words = text.split_whitespace().peekable();
    let node = parse(&mut words);
    assert_eq!(words.next(), None, "trailing words in {text}");
    node
}

fn parse<'a>(words: &mut std::iter::Peekable<impl Iterator<Item = &'a str>>) -> Arc<Node> {
    let name = words.next().expect("a plugin's name");
    let mut properties = Vec::new();
    while let Some(&word) = words.peek() {
        if word == ")" {
            break;
        }
        words.next();
        let (name, value) = if word == "(" {
            let nested = parse(words);
            assert_eq!(words.next(), Some(")"));
            ("", Value::Object(nested))
        } else {
            let (name, rest) = word.split_once('=').expect("key=kind:value");
            let (kind, text) = rest.split_once(':').expect("kind:value");
            (name, value(kind, text))
        };
        properties.push(Property::new(name, NOWHERE, value, NOWHERE));
    }
    Arc::new(Node {
        class: Class::Bsdf,
        plugin: Spanned {
            value: name.to_owned(),
            span: NOWHERE,
        },
        id: None,
        span: NOWHERE,
        properties,
    })
}

fn value(kind: &str, text: &str) -> Value {
    let number = |text: &str| text.parse::<f64>().expect("a number");
    match kind {
        "f" => Value::Float(number(text)),
        "i" => Value::Integer(number(text) as i64),
        "s" => Value::String(text.replace('_', " ")),
        "b" => Value::Boolean(text == "true"),
        "c" => {
            let channels: Vec<f64> = text.split(',').map(number).collect();
            Value::Rgb(DVec3::from_slice(&channels))
        }
        "u" => Value::Spectrum(SpectrumText::Uniform(number(text))),
        "t" => Value::Spectrum(SpectrumText::Samples(
            text.split(',')
                .map(|pair| {
                    let (wavelength, value) = pair.split_once(':').expect("nm:value");
                    (number(wavelength), number(value))
                })
                .collect(),
        )),
        "n" => Value::Object(Arc::new(Node {
            class: Class::Texture,
            plugin: Spanned {
                value: "irregular".to_owned(),
                span: NOWHERE,
            },
            id: None,
            span: NOWHERE,
            properties: vec![Property::new("", NOWHERE, value("t", text), NOWHERE)],
        })),
        _ => panic!("unknown kind {kind}"),
    }
}
