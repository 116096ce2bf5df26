//! Meshes and pictures that are not what they should be.

use crate::Said;
use etalon_images::{Frame, Image, exr, hdr, png};

const LFS: &[u8] = b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
    property float y\nproperty float z\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n";

/// Loads a scene with one element in its third line, beside a file; there is one message, which stands at that line and
/// holds `words`.
#[track_caller]
fn refused(name: &str, bytes: &[u8], element: &str, words: &str) {
    let file = format!("<string name=\"filename\" value=\"{name}\"/>");
    let element = element.replace("FILE", &file);
    let scene =
        format!("<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n{element}\n</scene>\n");
    let said = Said::of(&scene, &[(name, bytes)]);
    let [only] = said.errors()[..] else {
        panic!("{}", said.text);
    };
    assert!(
        said.refused && only.contains("a.xml:3:") && only.contains(words),
        "{only}"
    );
}

#[track_caller]
fn bad_ply(bytes: impl AsRef<[u8]>) {
    refused(
        "m.ply",
        bytes.as_ref(),
        "<shape type=\"ply\">FILE</shape>",
        "m.ply",
    );
}

#[track_caller]
fn bad_picture(name: &str, bytes: &[u8], words: &str) {
    let bitmap = "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\">FILE</texture></bsdf></shape>";
    refused(name, bytes, bitmap, words);
    refused(
        name,
        bytes,
        "<emitter type=\"envmap\">FILE</emitter>",
        words,
    );
}

#[test]
fn ply() {
    bad_ply("");
    bad_ply("ply\n");
    bad_ply(PLY);
    bad_ply(format!("{PLY}0 0 0\n1 0 0\n"));
    bad_ply(format!("{PLY}0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"));
    bad_ply(format!("{PLY}0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n"));
    bad_ply(format!("{PLY}0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"));
    let huge = PLY.replace("vertex 3", "vertex 4000000000");
    bad_ply(format!("{huge}0 0 0\n"));
    let binary = PLY.replace("ascii", "binary_little_endian");
    bad_ply(format!("{binary}too short"));
    let binary = huge.replace("ascii", "binary_big_endian");
    bad_ply(format!("{binary}too short"));
}

#[test]
fn binary_ply_with_numbers_that_are_none() {
    let mut bytes = PLY.replace("ascii", "binary_little_endian").into_bytes();
    for value in [0.0, 0.0, 0.0, 1.0, f32::INFINITY, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(f32::to_le_bytes(value));
    }
    bytes.push(3);
    for index in [0u32, 1, 2] {
        bytes.extend(index.to_le_bytes());
    }
    bad_ply(bytes);
}

#[test]
fn obj() {
    for text in [
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
        "v 0 0\n",
        "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 x\n",
        "v 0 0 0\nf 1 1\n",
        "ply\nformat ascii 1.0\n",
    ] {
        let shape = "<shape type=\"obj\">FILE</shape>";
        refused("m.obj", text.as_bytes(), shape, "m.obj");
    }
}

#[test]
fn pictures() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut image = Image::new(24, 20);
    for name in ["R", "G", "B"] {
        image.push(name, (0..480).map(|i| i as f32 * 0.01).collect());
    }
    let path = |name: &str| folder.path().join(name);
    exr::write(&path("a.exr"), &image, Frame::whole(&image), "").expect("written");
    png::write(
        &path("a.png"),
        &image,
        etalon_images::Development::default(),
    )
    .expect("written");
    hdr::write(&path("a.hdr"), &image).expect("written");
    for name in ["a.exr", "a.png", "a.hdr"] {
        let whole = std::fs::read(path(name)).expect("there");
        for bytes in [
            &b""[..],
            b"nothing like a picture",
            &whole[..whole.len() / 2],
            &whole[..20],
        ] {
            bad_picture(name, bytes, name);
        }
    }
    // What git keeps of a large file that was not fetched says so.
    bad_picture("t.png", LFS, "a pointer of git LFS");
}
