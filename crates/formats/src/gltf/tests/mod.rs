//! Tests of the reader: a model against the XML that means the same, and what is said of broken ones.

mod animation;
mod containers;
mod hostile;
mod materials;
mod meshes;
mod mistakes;
mod scenes;

use super::read_bytes;
use crate::same_tree::{assert_alike, xml};
use crate::{Document, ReadOptions, ReadOutcome};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;

/// A triangle: positions, texture coordinates and normals as floats, and three indices.
const FLOATS: [f32; 24] = [
    0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, // positions
    0.0, 1.0, 1.0, 1.0, 0.0, 0.0, // texture coordinates
    0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, // normals
];

/// A picture of one white texel with alpha.
const PICTURE: &str = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGP4////fwAJ+wP9CNHoHgAAAABJRU5ErkJggg==";

/// The bytes of the triangle.
fn triangle() -> Vec<u8> {
    let floats = FLOATS.iter().flat_map(|x| x.to_le_bytes());
    floats.chain([0, 0, 1, 0, 2, 0, 0, 0]).collect()
}

/// The members of a model that hold the triangle: accessor 0 has positions, 1 texture coordinates, 2 normals, 3 indices.
fn held(uri: &str) -> String {
    format!(
        r#""asset": {{"version": "2.0"}},
"buffers": [{{"byteLength": 104 {uri}}}],
"bufferViews": [
  {{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 24}},
  {{"buffer": 0, "byteOffset": 60, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 96, "byteLength": 6}}],
"accessors": [
  {{"bufferView": 0, "count": 3, "type": "VEC3", "componentType": 5126, "min": [0, 0, 0], "max": [1, 1, 0]}},
  {{"bufferView": 1, "count": 3, "type": "VEC2", "componentType": 5126}},
  {{"bufferView": 2, "count": 3, "type": "VEC3", "componentType": 5126}},
  {{"bufferView": 3, "count": 3, "type": "SCALAR", "componentType": 5123}}]"#
    )
}

/// A model of the triangle and further members.
fn model(members: &str) -> String {
    let bytes = BASE64_STANDARD.encode(triangle());
    let uri = format!(r#", "uri": "data:application/octet-stream;base64,{bytes}""#);
    format!("{{{},\n{members}}}", held(&uri))
}

/// The same with the triangle as a mesh that stands in the scene, and its material.
fn with_material(material: &str) -> String {
    model(&format!(
        r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2}}, "indices": 3, "material": 0}}]}}],
"nodes": [{{"mesh": 0}}], "images": [{{"uri": "data:image/png;base64,{PICTURE}"}}],
"samplers": [{{"wrapS": 33071, "wrapT": 33071, "magFilter": 9728}}],
"textures": [{{"source": 0}}, {{"source": 0, "sampler": 0}}],
"materials": [{{{material}}}]"#
    ))
}

fn read(text: &str) -> ReadOutcome {
    read_bytes("a.gltf", text.as_bytes(), &ReadOptions::default())
}

/// The document of a model without mistakes.
#[track_caller]
fn sound(text: &str) -> Document {
    let outcome = read(text);
    assert!(!outcome.has_errors(), "{}", outcome.lines());
    outcome.document.expect("a document")
}

/// Asserts that a model has, of the classes that the XML has, the same objects.
#[track_caller]
fn assert_same(gltf: &str, mitsuba: &str) {
    assert_alike(&sound(gltf), &xml(mitsuba));
}
