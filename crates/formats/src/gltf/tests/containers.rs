//! Files in one piece, and files beside the scene.

use super::*;

/// A `.glb` of a JSON text and a buffer.
pub(super) fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((length as u32).to_le_bytes());
    for (kind, data) in [(b"JSON", &json[..]), (b"BIN\0", binary)] {
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    }
    bytes
}

const SHOWN: &str = r#"
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2}, "indices": 3, "material": 0}]}],
"nodes": [{"mesh": 0}], "images": [{"uri": "b.png"}, {"bufferView": 1, "mimeType": "image/png"}], "textures": [{"source": 1}],
"materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}]"#;

#[test]
fn a_glb_holds_its_buffer() {
    let bytes = glb(&format!("{{{}, {SHOWN}}}", held("")), &triangle());
    let outcome = read_bytes("a.glb", &bytes, &ReadOptions::default());
    assert!(!outcome.has_errors(), "{}", outcome.lines());
    let document = outcome.document.expect("a document");
    assert_eq!(document.meshes[0].triangles, [[0, 1, 2]]);
    // The second picture has the bytes of its view.
    let images: Vec<_> = document.embedded.iter().collect();
    assert_eq!(
        images,
        [(&1, &std::sync::Arc::new(triangle()[36..60].to_vec()))]
    );
    use etalon_transport::Assets;
    let assets = crate::FileAssets::of(&document);
    let name = crate::embedded_name(1);
    assert_eq!(*assets.bytes(&name).expect("there"), triangle()[36..60]);
    assert_eq!(*document.files[0].bytes, bytes);
}

#[test]
fn buffers_stand_beside_the_scene() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = format!("{{{}, {SHOWN}}}", held(r#", "uri": "my%20data.bin""#));
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, text).expect("written");
    let said = crate::read(&path, &ReadOptions::default()).lines();
    assert!(
        said.contains("`buffers[0].uri`") && said.contains("`my data.bin` was not found"),
        "{said}"
    );
    std::fs::write(folder.path().join("my data.bin"), triangle()).expect("written");
    let outcome = crate::read(&path, &ReadOptions::default());
    assert!(!outcome.has_errors(), "{}", outcome.lines());
    let document = outcome.document.expect("a document");
    assert_eq!(*document.files[1].bytes, triangle());
}

#[test]
fn broken_containers_are_named() {
    let whole = glb("{}", &[0; 8]);
    let said = |bytes: &[u8]| read_bytes("a.glb", bytes, &ReadOptions::default()).lines();
    let mut other = whole.clone();
    other[4] = 1;
    assert!(said(&other).contains("version 1 of glTF is not read"));
    let shorter = whole.len() - 1;
    assert!(said(&whole[..shorter]).contains("the file should have"));
    assert!(said(&whole[..7]).contains("ends within its header"));
    let mut other = whole.clone();
    other[16] = b'X';
    assert!(said(&other).contains("the first chunk of the file is not JSON"));
    let mut other = whole;
    other[15] = 1;
    assert!(said(&other).contains("the chunk at byte 12 goes beyond the end"));
    assert!(said(b"\xff\xfe").contains("no UTF-8 text: byte 0 is broken"));
}
