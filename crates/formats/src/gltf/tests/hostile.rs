//! No file panics, and none takes memory for what it only claims.

use super::containers::glb;
use super::*;
use crate::changed_files::{Numbers, changed_files};

/// A model with some of everything.
fn whole(uri: &str) -> String {
    format!(
        r#"{{{},
"scene": 0, "scenes": [{{"nodes": [0, 3]}}],
"nodes": [{{"children": [1, 2], "rotation": [0, 0, 0, 1]}}, {{"mesh": 0, "scale": [1, 2, 3]}},
  {{"mesh": 0, "translation": [1, 2, 3]}}, {{"camera": 0, "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
"meshes": [{{"primitives": [
  {{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2}}, "indices": 3, "material": 0, "mode": 4}},
  {{"attributes": {{"POSITION": 4, "COLOR_0": 0}}, "mode": 6}}]}}],
"materials": [{{"alphaMode": "MASK", "alphaCutoff": 0.5, "emissiveFactor": [1, 1, 0], "normalTexture": {{"index": 0, "scale": 2}},
  "pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, "extensions": {{"KHR_texture_transform": {{"scale": [2, 2]}}}}}}}},
  "extensions": {{"KHR_materials_transmission": {{"transmissionFactor": 1}}, "KHR_materials_clearcoat": {{"clearcoatFactor": 1}},
    "KHR_materials_volume": {{"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0]}}}}}}],
"textures": [{{"source": 0, "sampler": 0}}], "samplers": [{{"wrapS": 33648}}], "images": [{{"bufferView": 1, "mimeType": "image/png"}}],
"cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.5, "znear": 0.1}}}}],
"animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 1, "path": "translation"}}}}],
  "samplers": [{{"input": 5, "output": 6, "interpolation": "LINEAR"}}]}}],
"extensionsUsed": ["KHR_lights_punctual"], "extensions": {{"KHR_lights_punctual": {{"lights": [
  {{"type": "spot", "intensity": 10, "spot": {{"outerConeAngle": 0.5}}}}]}}}}}}"#,
        held(uri).replace(
            r#""componentType": 5123}]"#,
            r#""componentType": 5123},
  {"count": 3, "type": "VEC3", "componentType": 5126, "min": [0, 0, 0], "max": [1, 1, 0],
   "sparse": {"count": 1, "indices": {"bufferView": 3, "componentType": 5123}, "values": {"bufferView": 0}}},
  {"bufferView": 1, "count": 2, "type": "SCALAR", "componentType": 5126},
  {"bufferView": 2, "count": 2, "type": "VEC3", "componentType": 5126}]"#
        )
    )
}

/// What stands for what: numbers at their limits, other kinds of values.
const WORDS: [&str; 16] = [
    "0",
    "1",
    "3",
    "7",
    "-1",
    "255",
    "65536",
    "4294967295",
    "18446744073709551615",
    "1e38",
    "1e-45",
    "null",
    "true",
    "\"VEC4\"",
    "[]",
    "{}",
];

/// A file with one to four changes.
fn changed(numbers: &mut Numbers, whole: &[u8]) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..=numbers.below(4) {
        let at = numbers.below(bytes.len());
        match numbers.below(9) {
            0 => bytes[at] = numbers.below(256) as u8,
            1 => bytes[at] ^= 1 << numbers.below(8),
            2 => bytes.truncate(at + 1),
            3 => drop(bytes.remove(at)),
            _ => {
                // The next number becomes another word.
                let digits = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
                let Some(start) = bytes[at..].iter().position(digits) else {
                    continue;
                };
                let start = at + start;
                let rest = &bytes[start..];
                let end = rest.iter().position(|byte| !digits(byte));
                let end = start + end.unwrap_or(rest.len());
                let word = WORDS[numbers.below(WORDS.len())];
                bytes.splice(start..end, word.bytes());
            }
        }
        if bytes.is_empty() {
            bytes.push(b'{');
        }
    }
    bytes
}

/// Reads files with changes; how many were still scenes.
fn survived(count: u32) -> u32 {
    let data = BASE64_STANDARD.encode(triangle());
    let text = whole(&format!(r#", "uri": "data:;base64,{data}""#));
    let binary = glb(&whole(""), &triangle());
    assert!(!read(&text).has_errors(), "{}", read(&text).lines());
    let mut numbers = Numbers(20_240_229);
    let mut sound = 0;
    for i in 0..count {
        let bytes = match i % 2 {
            0 => changed(&mut numbers, text.as_bytes()),
            _ => {
                let mut bytes = changed(&mut numbers, &binary);
                // Most changes of the length would hide all others.
                if let Some(length) = bytes.get(8..12).map(|_| bytes.len() as u32) {
                    bytes[8..12].copy_from_slice(&length.to_le_bytes());
                }
                bytes
            }
        };
        let outcome = read_bytes("a.gltf", &bytes, &ReadOptions::default());
        for diagnostic in &outcome.diagnostics {
            if let Some(span) = diagnostic.span {
                let length = outcome.sources.text(span.file).len();
                assert!(span.start <= span.end && span.end as usize <= length);
            }
        }
        outcome.lines();
        if let Some(document) = outcome.document {
            let claimed = document.meshes.iter().map(|mesh| mesh.positions.len());
            assert!(claimed.sum::<usize>() <= 1 << 21);
            sound += 1;
        }
    }
    sound
}

/// `ETALON_CHANGED_FILES=100000` asks for more of them.
#[test]
fn changed_files_are_survived() {
    let count = changed_files(4000);
    let sound = survived(count);
    assert!(
        sound > count / 40 && sound < count,
        "{sound} were still scenes"
    );
}
