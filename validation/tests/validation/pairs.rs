//! The scenes of `scenes/pairs` are what they say: in them each kind of shape is of each material, and each material
//! and shape has each kind of texture.

use roxmltree::{Document, Node};
use std::collections::BTreeSet;
use std::path::Path;

const SHAPES: [&str; 8] = [
    "sphere",
    "rectangle",
    "disk",
    "cylinder",
    "cube",
    "obj",
    "ply",
    "instance",
];
const MATERIALS: [&str; 11] = [
    "diffuse",
    "twosided",
    "blendbsdf",
    "mask",
    "plastic",
    "roughplastic",
    "conductor",
    "roughconductor",
    "dielectric",
    "thindielectric",
    "roughdielectric",
];
const TEXTURES: [&str; 6] = [
    "rgb",
    "irregular",
    "checkerboard",
    "bitmap",
    "bitmap nearest",
    "bitmap clamp",
];

fn attribute<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    node.attribute(name).unwrap_or_default()
}

/// Within a two-sided material, the blend that it may hold.
fn material<'a>(shape: Node<'a, '_>) -> Option<&'a str> {
    let outer = shape.children().find(|n| n.has_tag_name("bsdf"))?;
    let blend = outer
        .descendants()
        .find(|n| attribute(*n, "type") == "blendbsdf");
    Some(blend.map_or(attribute(outer, "type"), |_| "blendbsdf"))
}

fn textures(shape: Node) -> BTreeSet<String> {
    shape
        .descendants()
        .filter_map(
            |node| match (node.tag_name().name(), attribute(node, "type")) {
                // Not the colours of a checkerboard.
                ("rgb", _) => (node.parent())
                    .is_some_and(|n| n.has_tag_name("bsdf"))
                    .then(|| "rgb".to_owned()),
                ("texture", "bitmap") => {
                    let kept = ["nearest", "clamp"];
                    let mut values = node.children().map(|n| attribute(n, "value"));
                    let kind = values.find(|value| kept.contains(value));
                    Some(kind.map_or("bitmap".to_owned(), |kind| format!("bitmap {kind}")))
                }
                ("texture" | "spectrum", kind) => Some(kind.to_owned()),
                _ => None,
            },
        )
        .collect()
}

#[test]
fn shapes_materials_and_textures_all_meet() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/pairs");
    let mut made_of = BTreeSet::new();
    let (mut materials, mut shapes) = (BTreeSet::new(), BTreeSet::new());
    for name in ["a", "b", "c"] {
        let text = std::fs::read_to_string(folder.join(format!("{name}.xml"))).expect("a scene");
        let document = Document::parse(&text).expect("XML");
        for shape in (document.descendants()).filter(|n| n.has_tag_name("shape")) {
            let Some(material) = material(shape) else {
                continue;
            };
            let group = shape.parent().is_some_and(|n| n.has_tag_name("shape"));
            let kind = if group {
                "instance"
            } else {
                attribute(shape, "type")
            };
            made_of.insert((kind.to_owned(), material.to_owned()));
            for texture in textures(shape) {
                materials.insert((material.to_owned(), texture.clone()));
                shapes.insert((kind.to_owned(), texture));
            }
        }
    }
    let missing = |found: &BTreeSet<(String, String)>, first: &[&str], second: &[&str]| {
        let pairs = first
            .iter()
            .flat_map(|a| second.iter().map(move |b| (a, b)));
        pairs
            .filter(|(a, b)| !found.contains(&((**a).to_owned(), (**b).to_owned())))
            .map(|(a, b)| format!("{a} of {b}"))
            .collect::<Vec<_>>()
    };
    assert_eq!(missing(&made_of, &SHAPES, &MATERIALS), [""; 0]);
    assert_eq!(missing(&materials, &MATERIALS, &TEXTURES), [""; 0]);
    assert_eq!(missing(&shapes, &SHAPES, &TEXTURES), [""; 0]);
}
