//! Vertices and triangles: all ways of storing numbers.

use super::*;
use etalon_transport::MeshData;
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A model of one part, whose accessors read these bytes: view i has `views[i]` (offset, length, further members).
fn part(bytes: &[u8], views: &[(usize, usize, &str)], accessors: &str, part: &str) -> String {
    let views: Vec<String> = (views.iter())
        .map(|(offset, length, more)| {
            format!(r#"{{"buffer": 0, "byteOffset": {offset}, "byteLength": {length} {more}}}"#)
        })
        .collect();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{{part}}}]}}],
        "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}],
        "textures": [{{"source": 0}}], "images": [{{"uri": "a.png"}}],
        "accessors": [{accessors}], "bufferViews": [{}],
        "buffers": [{{"byteLength": {}, "uri": "data:;base64,{}"}}]}}"#,
        views.join(", "),
        bytes.len(),
        BASE64_STANDARD.encode(bytes)
    )
}

#[track_caller]
fn mesh(text: &str) -> Arc<MeshData> {
    sound(text).meshes.first().expect("a mesh").clone()
}

#[test]
fn plain_floats() {
    let found = mesh(&with_material(
        r#""pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}"#,
    ));
    assert_eq!(found.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(found.uvs, [Vec2::Y, Vec2::ONE, Vec2::ZERO]);
    assert_eq!(found.normals, [Vec3::Z; 3]);
    assert_eq!(found.triangles, [[0, 1, 2]]);
    // Nobody looks at coordinates.
    assert!(mesh(&with_material("")).uvs.is_empty());
}

/// Bytes with a stride, shorts as shares, colours of vertices, and the normal that flat triangles have.
#[test]
fn quantised_numbers() {
    let mut bytes: Vec<u8> = vec![0, 0, 0, 9, 100, 0, 0, 9, 0, 156, 0, 9];
    let shares = [0_u16, 65535, 13107, 0, 0, 0];
    bytes.extend(shares.iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend([255, 0, 51, 255, 0, 0, 0, 255, 0, 0, 0, 102]);
    let accessors = r#"
        {"bufferView": 0, "count": 3, "type": "VEC3", "componentType": 5120, "min": [0,0,0], "max": [0,0,0]},
        {"bufferView": 1, "count": 3, "type": "VEC2", "componentType": 5123, "normalized": true},
        {"bufferView": 2, "count": 3, "type": "VEC4", "componentType": 5121, "normalized": true}"#;
    let views = [(0, 12, r#", "byteStride": 4"#), (12, 12, ""), (24, 12, "")];
    let attributes =
        r#""attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "material": 0"#;
    let found = mesh(&part(&bytes, &views, accessors, attributes));
    let positions = [Vec3::ZERO, Vec3::X * 100.0, Vec3::Y * -100.0];
    assert_eq!(found.positions, positions);
    assert_eq!(found.uvs, [Vec2::Y, Vec2::new(0.2, 0.0), Vec2::ZERO]);
    assert_eq!(found.normals, [Vec3::NEG_Z; 3]);
    let [colour, alpha] = &found.attributes[..] else {
        panic!("{:?}", found.attributes)
    };
    assert_eq!((colour.name.as_str(), colour.channels), ("vertex_color", 3));
    assert_eq!(colour.values, [1.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!((alpha.name.as_str(), alpha.channels), ("vertex_alpha", 1));
    assert_eq!(alpha.values, [1.0, 1.0, 0.4]);
    let text = part(&bytes, &views, accessors, attributes);
    let painted = r#"<shape type="ply"><string name="filename" value="mesh 0 of the scene file"/><transform name="to_world"/>
        <bsdf type="twosided"><bsdf type="principled"><texture type="multiply" name="base_color">
        <texture type="mesh_attribute" name="a"><string name="name" value="vertex_color"/></texture>
        <texture type="bitmap" name="b"><string name="filename" value="a.png"/></texture></texture>
        <float name="eta" value="1.5"/><string name="diffuse_model" value="lambert"/><float name="metallic" value="1"/><float name="roughness" value="1"/></bsdf></bsdf></shape>"#;
    assert_same(&text, painted);
}

/// Zeros, of which two are replaced, and a strip.
#[test]
fn sparse_numbers_and_strips() {
    let mut bytes: Vec<u8> = vec![1, 0, 3, 0];
    let values = [1.0_f32, 0.0, 0.0, 1.0, 1.0, 0.0];
    bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    let accessors = r#"{"count": 4, "type": "VEC3", "componentType": 5126, "min": [0,0,0], "max": [1,1,0],
        "sparse": {"count": 2, "indices": {"bufferView": 0, "componentType": 5123}, "values": {"bufferView": 1}}}"#;
    let views = [(0, 4, ""), (4, 24, "")];
    let attributes = r#""attributes": {"POSITION": 0}, "mode": 5"#;
    let found = mesh(&part(&bytes, &views, accessors, attributes));
    let (a, b, c) = (Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(found.positions, [a, b, a, b, c, a]);
    let said = read(&part(
        &[4, 0, 3, 0].repeat(7),
        &views,
        accessors,
        attributes,
    ))
    .lines();
    let expected = "`accessors[0].sparse.indices`: there is no element 4 among 4";
    assert!(said.contains(expected), "{said}");
}

#[test]
fn points_are_left_out_with_a_note() {
    let text = with_material("").replace(r#""indices": 3,"#, r#""indices": 3, "mode": 0,"#);
    let outcome = read(&text);
    let said = outcome.lines();
    assert!(said.contains("note: Points have no surface"), "{said}");
    assert!(outcome.document.expect("a document").meshes.is_empty());
}

/// A file of a few kilobytes whose parts share one accessor of a thousand numbers very often.
#[test]
fn sharing_does_not_make_a_small_file_large() {
    let bytes = [0; 12_000];
    let parts = vec![r#"{"attributes": {"POSITION": 0}}"#; 30_000].join(", ");
    let accessor = r#"{"bufferView": 0, "count": 1000, "type": "VEC3", "componentType": 5126}"#;
    let text = part(
        &bytes,
        &[(0, 12_000, "")],
        accessor,
        r#""attributes": {"POSITION": 0}"#,
    );
    let text = text.replacen(
        r#"[{"attributes": {"POSITION": 0}}]"#,
        &format!("[{parts}]"),
        1,
    );
    let said = read(&text).lines();
    assert!(
        said.contains("the 12000 bytes of the buffers are read too often"),
        "{said}"
    );
}
