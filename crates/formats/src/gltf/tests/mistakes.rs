//! What is said of broken models, and where.

use super::*;

/// What is said of a model in which one text stands for another.
#[track_caller]
fn said(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{text}");
    let outcome = read(&text.replacen(old, new, 1));
    assert!(outcome.document.is_none());
    outcome.lines()
}

#[test]
fn syntax_has_a_place() {
    let said = read("{\"asset\": {\"version\": \"2.0\"},\n  \"nodes\": [{},, {}]}").lines();
    assert!(said.starts_with("a.gltf:2:16: error: "), "{said}");
    let said = read("{\"asset\": {\"version\": \"2.0\"},\n  \"nodes\": {}}").lines();
    assert!(
        said.contains("a.gltf:2:") && said.contains("invalid type: map"),
        "{said}"
    );
}

/// Each mistake has the path and the value, and its place in the text.
#[test]
fn mistakes_have_a_path_and_a_place() {
    let text = with_material("");
    let cases = [
        (
            r#""POSITION": 0"#,
            r#""POSITION": 77"#,
            "`meshes[0].primitives[0].attributes.POSITION` is `77`: there is nothing of this number",
        ),
        (
            r#""NORMAL": 2"#,
            r#""NORMAL": 8"#,
            "`meshes[0].primitives[0].attributes[\"NORMAL\"]` is `8`: there is nothing",
        ),
        (
            r#""NORMAL": 2"#,
            r#""NORMAL": 1"#,
            "`accessors[1]`: it holds 2 numbers of F32",
        ),
        (
            r#""material": 0"#,
            r#""material": 3"#,
            "`meshes[0].primitives[0].material` is `3`: there is nothing",
        ),
        (
            r#""wrapS": 33071"#,
            r#""wrapS": 5"#,
            "`samplers[0].wrapS` is `5`: this is none of the values",
        ),
        (
            r#""byteLength": 104"#,
            r#""byteLength": 105"#,
            "`buffers[0].byteLength` is `105`: there are 104 bytes only",
        ),
        (
            r#""byteLength": 36"#,
            r#""byteLength": 3600"#,
            "`bufferViews[0]`",
        ),
        (
            r#""count": 3, "type": "VEC3""#,
            r#""count": 4, "type": "VEC3""#,
            "4 elements of 12 bytes from byte 0 on, 12 apart, go beyond the 36 bytes",
        ),
        (
            r#""count": 3, "type": "VEC3""#,
            r#""count": 4294967295, "type": "VEC3""#,
            "4294967295 elements",
        ),
        (
            r#""count": 3, "type": "VEC3""#,
            r#""count": 0, "type": "VEC3""#,
            "`accessors[0].count` is `0`: an accessor is not empty",
        ),
        (
            r#""count": 3, "type": "VEC2""#,
            r#""byteOffset": 18446744073709551615, "count": 3, "type": "VEC2""#,
            "go beyond",
        ),
        (
            "AAABAAIA",
            "AAABAAMA",
            "`accessors[3]`: element 2 is 3, and there are 3 vertices",
        ),
        (
            r#""nodes": [{"mesh": 0}]"#,
            r#""nodes": [{"mesh": 0}, {"children": [1]}], "scenes": [{"nodes": [1]}]"#,
            "`nodes[1]`: the node stands in two places, or within itself",
        ),
        (
            r#""asset""#,
            r#""extensionsRequired": ["KHR_draco_mesh_compression"], "asset""#,
            "`extensionsRequired[0]` is `\"KHR_draco_mesh_compression\"`: the scene requires",
        ),
    ];
    for (old, new, expected) in cases {
        // Coordinates are looked at only if a texture is.
        let text = match old.contains("VEC2") {
            true => with_material(r#""emissiveFactor": [1,1,1], "emissiveTexture": {"index": 0}"#),
            false => text.clone(),
        };
        let said = said(&text, old, new);
        assert!(said.contains(expected), "{expected}\n{said}");
        assert!(said.starts_with("a.gltf:"), "{said}");
    }
    let said = said(&text, r#""material": 0"#, r#""material": 3"#);
    let line = with_material("")
        .lines()
        .position(|line| line.contains("meshes"));
    let line = line.expect("a line") + 1;
    assert!(said.starts_with(&format!("a.gltf:{line}:")), "{said}");
}

#[test]
fn what_is_not_read_is_noted() {
    let text = with_material(r#""doubleSided": true, "emissiveFactor": [1, 1, 1]"#);
    let text = text.replace(
        r#""asset""#,
        r#""extensionsUsed": ["KHR_materials_iridescence", "KHR_materials_ior"], "asset""#,
    );
    let text = text.replace(
        r#""indices": 3"#,
        r#""indices": 3, "targets": [{"POSITION": 0}]"#,
    );
    let said = read(&text).lines();
    for expected in [
        "note: the extension KHR_materials_iridescence is not read",
        "note: a surface shines in front only",
        "note: morph targets are not read",
    ] {
        assert!(said.contains(expected), "{said}");
    }
    assert!(!said.contains("KHR_materials_ior"), "{said}");
    let options = ReadOptions {
        defines: vec![("a".to_owned(), "1".to_owned())],
        ..ReadOptions::default()
    };
    let said = read_bytes("a.gltf", text.as_bytes(), &options).lines();
    assert!(said.contains("scenes of glTF have no parameters"), "{said}");
}
