//! RELAX NG: which parameters each plugin takes, and by which tags.
//!
//! An object's pattern is a choice over the plugins of its class. What depends on a `$parameter` may be anything there, and values are
//! looked at as far as their tag says: whether a number is in its range is for `etalon` to say.

use super::xml::Xml;
use crate::plugins::Described;
use etalon_formats::mitsuba::tags::{OPERATIONS, TAGS, Tag};
use etalon_params::{Class, ParameterKind, ignored};
use std::collections::{BTreeMap, BTreeSet};

/// What the schema says of itself.
const REMARK: &str =
    "RELAX NG of Etalon's scenes (Mitsuba 3 XML), written by `cargo xtask plugins`";

/// Numbers that are known when a scene is read only: by a `$name`, or an expression.
const COMPUTED: &str = r".*[$(*/+\^].*|.*[0-9.)]\s*-\s*.*|-?(pi|tau|e)";

/// Names of parameters by the tags that give their values.
type Slots = BTreeMap<Vec<&'static str>, BTreeSet<String>>;

/// The schema.
pub(crate) fn schema(all: &[Described<'_>]) -> String {
    let mut xml = Xml::new(REMARK);
    let spaces = [
        ("xmlns", "http://relaxng.org/ns/structure/1.0"),
        (
            "datatypeLibrary",
            "http://www.w3.org/2001/XMLSchema-datatypes",
        ),
    ];
    xml.element("grammar", &spaces, |xml| {
        xml.element("start", &[], |xml| xml.leaf("ref", &[("name", "scene")]));
        let classes: BTreeSet<Class> = all.iter().map(|described| described.class).collect();
        scene(xml, &classes);
        for (name, kind) in [("number", "double"), ("whole", "integer")] {
            define(xml, name, |xml| {
                xml.element("choice", &[], |xml| {
                    xml.leaf("data", &[("type", kind)]);
                    pattern(xml, COMPUTED);
                });
            });
        }
        define(xml, "truth", |xml| {
            pattern(xml, r"[Tt]rue|[Ff]alse|.*[$].*")
        });
        transforms(xml);
        for (name, tag) in TAGS {
            if !matches!(tag, Tag::Object(_)) {
                define(xml, &format!("{name}.value"), |xml| value(xml, tag));
            }
        }
        language(xml);
        anything(xml);
        for class in classes {
            body(xml, class, all.iter().filter(|d| d.class == class));
        }
    });
    xml.finish()
}

fn define(xml: &mut Xml, name: &str, children: impl FnOnce(&mut Xml)) {
    xml.element("define", &[("name", name)], children);
}

fn refer(xml: &mut Xml, name: &str) {
    xml.leaf("ref", &[("name", name)]);
}

/// A text of this form.
fn pattern(xml: &mut Xml, form: &str) {
    xml.element("data", &[("type", "string")], |xml| {
        xml.text("param", &[("name", "pattern")], form);
    });
}

fn any_number_of(xml: &mut Xml, choices: impl FnOnce(&mut Xml)) {
    xml.element("zeroOrMore", &[], |xml| xml.element("choice", &[], choices));
}

/// An attribute `name` that is in a defined set of names, or any.
fn named(xml: &mut Xml, names: Option<&str>) {
    match names {
        None => xml.element("optional", &[], |xml| {
            xml.leaf("attribute", &[("name", "name")])
        }),
        Some(names) => refer(xml, names),
    }
}

/// Defines the sets of names of some slots.
fn define_names(xml: &mut Xml, of: &str, slots: &Slots) {
    for (index, names) in slots.values().enumerate() {
        define(xml, &format!("{of}.{index}"), |xml| {
            xml.element("attribute", &[("name", "name")], |xml| {
                xml.element("choice", &[], |xml| {
                    for name in names {
                        xml.text("value", &[], name);
                    }
                });
            });
        });
    }
}

/// The names of the tags of a class's objects; a texture may be a `<spectrum type="…">` too.
fn tags(class: Class) -> impl Iterator<Item = &'static str> {
    (TAGS.into_iter())
        .filter(move |(_, tag)| {
            *tag == Tag::Object(class) || (class, *tag) == (Class::Texture, Tag::Spectrum)
        })
        .map(|(name, _)| name)
}

fn scene(xml: &mut Xml, classes: &BTreeSet<Class>) {
    let ignored = of_ignored(Class::Scene, &[]);
    define_names(xml, "scene", &ignored);
    define(xml, "scene", |xml| {
        xml.element("element", &[("name", "scene")], |xml| {
            xml.element("optional", &[], |xml| {
                xml.leaf("attribute", &[("name", "version")])
            });
            any_number_of(xml, |xml| {
                refer(xml, "language");
                for class in classes {
                    objects(xml, *class, None);
                }
                slots(xml, "scene", &ignored);
            });
        });
    });
}

/// The attributes of a tag, but its name, and what it holds.
fn value(xml: &mut Xml, tag: Tag) {
    for attribute in tag.attributes() {
        let name = attribute.trim_start_matches('!');
        if name == "name" {
            continue;
        }
        let typed = |xml: &mut Xml| match (tag, name) {
            (Tag::Integer, "value") => refer(xml, "whole"),
            (Tag::Boolean, "value") => refer(xml, "truth"),
            (Tag::Float, "value") | (_, "x" | "y" | "z" | "temperature" | "scale") => {
                refer(xml, "number");
            }
            _ => xml.leaf("text", &[]),
        };
        let here = |xml: &mut Xml| xml.element("attribute", &[("name", name)], typed);
        match attribute.starts_with('!') {
            true => here(xml),
            false => xml.element("optional", &[], here),
        }
    }
    match tag {
        Tag::Transform => any_number_of(xml, |xml| refer(xml, "operation")),
        Tag::Animation => any_number_of(xml, |xml| refer(xml, "key")),
        _ if tag.attributes() == ["!name"] => xml.leaf("empty", &[]),
        _ => {}
    }
}

fn transforms(xml: &mut Xml) {
    define(xml, "operation", |xml| {
        xml.element("choice", &[], |xml| {
            for (name, attributes) in OPERATIONS {
                xml.element("element", &[("name", name)], |xml| {
                    for attribute in attributes {
                        let bare = attribute.trim_start_matches('!');
                        let here = |xml: &mut Xml| {
                            xml.element("attribute", &[("name", bare)], |xml| match bare {
                                "x" | "y" | "z" | "angle" => refer(xml, "number"),
                                _ => xml.leaf("text", &[]),
                            });
                        };
                        match attribute.starts_with('!') {
                            true => here(xml),
                            false => xml.element("optional", &[], here),
                        }
                    }
                });
            }
        });
    });
    // A value at a moment.
    define(xml, "key", |xml| {
        xml.element("choice", &[], |xml| {
            for (name, tag) in TAGS {
                if tag.attributes().contains(&"!name")
                    && !matches!(tag, Tag::Default | Tag::Animation)
                {
                    xml.element("element", &[("name", name)], |xml| {
                        for attribute in ["time", "tangent", "interpolation"] {
                            xml.element("optional", &[], |xml| {
                                xml.leaf("attribute", &[("name", attribute)]);
                            });
                        }
                        refer(xml, &format!("{name}.value"));
                    });
                }
            }
        });
    });
}

/// What belongs to the language, and may stand in any object.
fn language(xml: &mut Xml) {
    define(xml, "language", |xml| {
        xml.element("choice", &[], |xml| {
            for name in ["ref", "alias", "include", "default", "path"] {
                xml.element("element", &[("name", name)], |xml| {
                    if name != "alias" && name != "path" {
                        named(xml, None);
                    }
                    refer(xml, &format!("{name}.value"));
                });
            }
        });
    });
}

/// What an object may hold whose `type` is not known.
fn anything(xml: &mut Xml) {
    define(xml, "anything", |xml| {
        any_number_of(xml, |xml| {
            xml.element("element", &[], |xml| {
                xml.leaf("anyName", &[]);
                xml.element("zeroOrMore", &[], |xml| {
                    xml.element("attribute", &[], |xml| {
                        xml.leaf("anyName", &[]);
                    });
                });
                refer(xml, "anything");
            });
        });
    });
}

/// Objects of a class, with one of these names or any.
fn objects(xml: &mut Xml, class: Class, names: Option<&str>) {
    for tag in tags(class) {
        xml.element("element", &[("name", tag)], |xml| {
            named(xml, names);
            xml.element("optional", &[], |xml| {
                xml.leaf("attribute", &[("name", "id")])
            });
            refer(xml, &format!("{}.body", class.name()));
        });
    }
}

/// Those of any value.
const ALL_TAGS: [&str; 14] = [
    "float",
    "integer",
    "boolean",
    "string",
    "point",
    "vector",
    "rgb",
    "srgb",
    "blackbody",
    "spectrum",
    "transform",
    "animation",
    "texture",
    "volume",
];

/// The tags by which a value of this kind is given.
fn tags_of(kind: ParameterKind) -> &'static [&'static str] {
    match kind {
        ParameterKind::Number => &["float", "integer", "animation"],
        ParameterKind::Integer => &["integer"],
        ParameterKind::Boolean => &["boolean"],
        ParameterKind::String => &["string"],
        ParameterKind::Vector => &["point", "vector", "animation"],
        ParameterKind::Transform | ParameterKind::Motion => &["transform", "animation"],
        ParameterKind::SpectrumOrTexture => &[
            "float",
            "integer",
            "rgb",
            "srgb",
            "blackbody",
            "spectrum",
            "animation",
            "texture",
            "volume",
        ],
        ParameterKind::Unsaid | ParameterKind::Nested | ParameterKind::Words(_) => &ALL_TAGS,
    }
}

/// Parameters by the tags that give their values, whose names are defined.
fn slots(xml: &mut Xml, of: &str, slots: &Slots) {
    for (index, tags) in slots.keys().enumerate() {
        let names = &format!("{of}.{index}");
        for tag in tags {
            match *tag {
                "texture" => objects(xml, Class::Texture, Some(names)),
                "volume" => objects(xml, Class::Volume, Some(names)),
                tag => xml.element("element", &[("name", tag)], |xml| {
                    named(xml, Some(names));
                    refer(xml, &format!("{tag}.value"));
                }),
            }
        }
    }
}

/// Parameters of Mitsuba's that are accepted and change nothing.
fn of_ignored(class: Class, plugins: &[String]) -> Slots {
    let matching = ignored::list().filter(|entry| {
        let is_of = |name: &&str| plugins.iter().any(|plugin| plugin == name);
        entry.class == class && (entry.plugins.is_empty() || entry.plugins.iter().any(is_of))
    });
    let names: BTreeSet<String> = matching
        .flat_map(|entry| entry.names.iter().map(|name| (*name).to_owned()))
        .collect();
    match names.is_empty() {
        true => Slots::new(),
        false => Slots::from([(ALL_TAGS.to_vec(), names)]),
    }
}

fn body<'a>(xml: &mut Xml, class: Class, plugins: impl Iterator<Item = &'a Described<'a>>) {
    let plugins: Vec<(String, Slots, &Described<'_>)> = plugins
        .map(|described| {
            let of = format!("{}.{}", class.name(), described.plugin.names[0]);
            (of, parameters(described), described)
        })
        .collect();
    for (of, parameters, _) in &plugins {
        define_names(xml, of, parameters);
    }
    define(xml, &format!("{}.body", class.name()), |xml| {
        xml.element("choice", &[], |xml| {
            xml.element("group", &[], |xml| {
                xml.element("attribute", &[("name", "type")], |xml| {
                    pattern(xml, r".*[$].*");
                });
                refer(xml, "anything");
            });
            for (of, parameters, described) in &plugins {
                xml.element("group", &[], |xml| plugin(xml, of, parameters, described));
            }
        });
    });
}

/// The parameters of some plugins, by tags.
fn parameters(described: &Described<'_>) -> Slots {
    let mut parameters = of_ignored(described.class, &described.plugin.names);
    for (name, heard) in &described.rows {
        if !name.starts_with('<') {
            let kinds = heard.kinds.iter().copied();
            let tags: BTreeSet<&str> = match heard.question.kind {
                ParameterKind::Unsaid => ALL_TAGS.into(),
                _ => (kinds.filter(|kind| *kind != ParameterKind::Unsaid))
                    .flat_map(|kind| tags_of(kind).iter().copied())
                    .collect(),
            };
            let tags = tags.into_iter().collect();
            (parameters.entry(tags).or_default()).insert(name.clone());
        }
    }
    parameters
}

fn plugin(xml: &mut Xml, of: &str, parameters: &Slots, described: &Described<'_>) {
    xml.element("attribute", &[("name", "type")], |xml| {
        xml.element("choice", &[], |xml| {
            for name in &described.plugin.names {
                xml.text("value", &[], name);
            }
        });
    });
    any_number_of(xml, |xml| {
        refer(xml, "language");
        slots(xml, of, parameters);
        for (tag_name, tag) in TAGS {
            let is_input = described.plugin.inputs.iter().any(|name| name == tag_name);
            if is_input && !matches!(tag, Tag::Object(_)) {
                xml.element("element", &[("name", tag_name)], |xml| {
                    named(xml, None);
                    refer(xml, &format!("{tag_name}.value"));
                });
            }
            if let Tag::Object(class) = tag
                && (is_input
                    // A shape may be what a sensor measures the light of.
                    || (described.class, class) == (Class::Shape, Class::Sensor)
                    || described.rows.contains_key(&format!("<{}>", class.name())))
            {
                objects(xml, class, None);
            }
        }
    });
}
