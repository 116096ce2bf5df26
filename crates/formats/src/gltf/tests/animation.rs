//! Where things stand at a moment.

use super::*;
use etalon_params::{DMat4, DVec3, Value};
use glam::DQuat;

/// The place of the first shape at a moment, of a node whose keys at 1 and 3 are these numbers.
fn place(time: f64, path: &str, interpolation: &str, keys: &[f32]) -> DMat4 {
    let width = if path == "rotation" { 4 } else { 3 };
    let count = keys.len() / width;
    let times = [1.0_f32, 3.0];
    let numbers = times.iter().chain(keys).flat_map(|x| x.to_le_bytes());
    let bytes: Vec<u8> = numbers.collect();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "nodes": [{{"children": [1], "translation": [0, 0, 5]}}, {{"mesh": 0}}],
        "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 1, "path": "{path}"}}}}],
            "samplers": [{{"input": 1, "output": 2, "interpolation": "{interpolation}"}}]}}],
        "accessors": [
            {{"bufferView": 0, "count": 3, "type": "VEC3", "componentType": 5126}},
            {{"bufferView": 1, "count": 2, "type": "SCALAR", "componentType": 5126}},
            {{"bufferView": 1, "byteOffset": 8, "count": {count}, "type": "VEC{width}", "componentType": 5126}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 1, "byteLength": {length}}}],
        "buffers": [{{"byteLength": 104, "uri": "data:;base64,{}"}}, {{"byteLength": {length}, "uri": "data:;base64,{}"}}]}}"#,
        BASE64_STANDARD.encode(triangle()),
        BASE64_STANDARD.encode(&bytes),
        length = bytes.len(),
    );
    let options = ReadOptions {
        time,
        ..ReadOptions::default()
    };
    let outcome = read_bytes("a.gltf", text.as_bytes(), &options);
    assert!(!outcome.has_errors(), "{}", outcome.lines());
    let root = outcome.document.expect("a document").root;
    let shape = crate::same_tree::children(&root)
        .into_iter()
        .find(|node| node.plugin.value == "ply")
        .expect("a shape");
    let found = shape.properties.iter().find_map(|p| match p.value {
        Value::Transform(matrix) if p.name == "to_world" => Some(matrix),
        _ => None,
    });
    found.expect("a place")
}

#[track_caller]
fn assert_near(found: DMat4, expected: DMat4) {
    assert!(found.abs_diff_eq(expected, 1e-6), "{found} {expected}");
}

fn moved(x: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new(x, 0.0, 5.0))
}

/// Along lines and in steps; before and after the keys nothing moves. The cubic from 0 to 4 in two units of time, leaving with 1 and arriving with 0, is at
/// s = ½: 2 + ⅛ · 2.
#[test]
fn keys_are_interpolated() {
    let keys = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0];
    for (time, x) in [(0.0, 0.0), (1.0, 0.0), (2.0, 2.0), (2.5, 3.0), (9.0, 4.0)] {
        assert_near(place(time, "translation", "LINEAR", &keys), moved(x));
    }
    assert_near(place(2.9, "translation", "STEP", &keys), moved(0.0));
    assert_near(place(3.0, "translation", "STEP", &keys), moved(4.0));
    let mut keys = [0.0; 18];
    (keys[6], keys[12]) = (1.0, 4.0);
    assert_near(place(2.0, "translation", "CUBICSPLINE", &keys), moved(2.25));
    let keys = [1.0, 1.0, 1.0, 3.0, 1.0, 1.0];
    let wide = moved(0.0) * DMat4::from_scale(DVec3::new(2.0, 1.0, 1.0));
    assert_near(place(2.0, "scale", "LINEAR", &keys), wide);
}

/// Along the great arc, and the shorter way: the second quaternion has the other sign.
#[test]
fn rotations_go_the_shorter_way() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let keys = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -half, -half];
    let found = place(1.5, "rotation", "LINEAR", &keys);
    let turned = moved(0.0) * DMat4::from_quat(DQuat::from_rotation_z(22.5_f64.to_radians()));
    assert_near(found, turned);
}
