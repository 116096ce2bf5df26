//! XML Schema, flat: the tags with their attributes and the plugins of each class, for editors that complete names.
//!
//! It cannot tell the parameters of one plugin from those of another, as they all stand under the same tags: [`super::relax_ng`] can.

use super::xml::Xml;
use crate::plugins::Described;
use etalon_formats::mitsuba::tags::{OPERATIONS, TAGS, Tag};
use etalon_params::Class;
use std::collections::BTreeSet;

/// What the schema says of itself.
const REMARK: &str =
    "XML Schema of Etalon's scenes (Mitsuba 3 XML) for editors, written by `cargo xtask plugins`";

/// The schema.
pub(crate) fn schema(all: &[Described<'_>]) -> String {
    let mut xml = Xml::new(REMARK);
    let space = [("xmlns:xs", "http://www.w3.org/2001/XMLSchema")];
    xml.element("xs:schema", &space, |xml| {
        for class in all.iter().map(|d| d.class).collect::<BTreeSet<Class>>() {
            let of_class = all.iter().filter(|described| described.class == class);
            types(xml, class, of_class);
        }
        names(xml, all);
        xml.element("xs:group", &[("name", "anything")], |xml| {
            xml.element("xs:choice", &[], |xml| {
                for name in (TAGS.iter().map(|(name, _)| *name))
                    .filter(|name| *name != "scene")
                    .chain(OPERATIONS.iter().map(|(name, _)| *name))
                {
                    xml.leaf("xs:element", &[("ref", name)]);
                }
            });
        });
        for (name, tag) in TAGS {
            let attributes: &[&str] = match tag {
                Tag::Object(Class::Scene) => &["version"],
                Tag::Spectrum => &["name", "value", "filename", "intent", "type", "id"],
                tag => tag.attributes(),
            };
            element(xml, name, Some(tag), attributes);
        }
        for (name, attributes) in OPERATIONS {
            element(xml, name, None, attributes);
        }
    });
    xml.finish()
}

/// The names of a class's plugins; others, such as a `$parameter`, are texts too.
fn types<'a>(xml: &mut Xml, class: Class, plugins: impl Iterator<Item = &'a Described<'a>>) {
    let names: BTreeSet<&String> = plugins.flat_map(|d| &d.plugin.names).collect();
    words(xml, &format!("{}.type", class.name()), names.into_iter());
}

/// The names of all parameters.
fn names(xml: &mut Xml, all: &[Described<'_>]) {
    let names: BTreeSet<&String> = (all.iter())
        .flat_map(|described| described.rows.keys())
        .filter(|name| !name.starts_with('<'))
        .collect();
    words(xml, "parameter", names.into_iter());
}

/// A text that is one of these words, or another.
fn words<'a>(xml: &mut Xml, name: &str, words: impl Iterator<Item = &'a String>) {
    let known = format!("{name}.known");
    xml.element("xs:simpleType", &[("name", &known)], |xml| {
        xml.element("xs:restriction", &[("base", "xs:string")], |xml| {
            for word in words {
                xml.leaf("xs:enumeration", &[("value", word)]);
            }
        });
    });
    xml.element("xs:simpleType", &[("name", name)], |xml| {
        let members = format!("{known} xs:string");
        xml.leaf("xs:union", &[("memberTypes", &members)]);
    });
}

fn element(xml: &mut Xml, name: &str, tag: Option<Tag>, attributes: &[&str]) {
    xml.element("xs:element", &[("name", name)], |xml| {
        xml.element("xs:complexType", &[], |xml| {
            if matches!(
                tag,
                Some(Tag::Object(_) | Tag::Spectrum | Tag::Transform | Tag::Animation)
            ) {
                let many = [("minOccurs", "0"), ("maxOccurs", "unbounded")];
                xml.element("xs:sequence", &many, |xml| {
                    xml.leaf("xs:group", &[("ref", "anything")]);
                });
            }
            for attribute in attributes {
                let bare = attribute.trim_start_matches('!');
                let kind = match (tag, bare) {
                    (Some(Tag::Object(class)), "type") => format!("{}.type", class.name()),
                    (Some(Tag::Spectrum), "type") => "texture.type".to_owned(),
                    (Some(Tag::Default), "name") => "xs:string".to_owned(),
                    (_, "name") => "parameter".to_owned(),
                    _ => "xs:string".to_owned(),
                };
                // In an `<animation>` keys have a time and no name.
                let required = attribute.starts_with('!') && bare != "name";
                let needed = if required { "required" } else { "optional" };
                let kind = kind.as_str();
                xml.leaf(
                    "xs:attribute",
                    &[("name", bare), ("type", kind), ("use", needed)],
                );
            }
            if tag.is_some_and(|tag| tag.attributes().contains(&"!name")) {
                for timed in ["time", "tangent", "interpolation"] {
                    if !attributes.contains(&timed) {
                        xml.leaf("xs:attribute", &[("name", timed), ("type", "xs:string")]);
                    }
                }
            }
        });
    });
}
