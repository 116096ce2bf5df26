//! Meshes and pictures that are not what they should be.

use crate::workshop::Workshop;
use std::time::{Duration, Instant};

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
    property float y\nproperty float z\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n";

/// Renders a scene with one element in its third line, beside a file; the message must stand
/// at that line and hold `words`.
#[track_caller]
fn refused(name: &str, bytes: &[u8], element: &str, words: &str) {
    let workshop = Workshop::new();
    workshop.write(name, bytes);
    let element = element.replace(
        "FILE",
        &format!("<string name=\"filename\" value=\"{name}\"/>"),
    );
    let scene =
        format!("<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n{element}\n</scene>\n");
    workshop.write("scene.xml", scene);
    let start = Instant::now();
    let ran = workshop
        .run(&["render", "scene.xml", "-o", "x.exr"])
        .refused();
    assert!(
        start.elapsed() < Duration::from_secs(1),
        "{:?}",
        start.elapsed()
    );
    let first = ran.stderr.lines().next().unwrap_or_default();
    assert!(first.starts_with("scene.xml:3:"), "{}", ran.stderr);
    assert!(
        first.contains(": error: ") && first.contains(words),
        "{}",
        ran.stderr
    );
    assert_eq!(ran.stderr.matches(": error: ").count(), 1, "{}", ran.stderr);
    let mut expected = [name, "scene.xml"];
    expected.sort_unstable();
    assert_eq!(workshop.files(), expected);
}

#[track_caller]
fn bad_ply(bytes: impl AsRef<[u8]>, words: &str) {
    refused(
        "m.ply",
        bytes.as_ref(),
        "<shape type=\"ply\">FILE</shape>",
        words,
    );
}

#[track_caller]
fn bad_obj(text: &str, words: &str) {
    refused(
        "m.obj",
        text.as_bytes(),
        "<shape type=\"obj\">FILE</shape>",
        words,
    );
}

#[track_caller]
fn bad_picture(name: &str, bytes: &[u8]) {
    let bitmap = "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\">FILE</texture></bsdf></shape>";
    refused(name, bytes, bitmap, name);
    refused(name, bytes, "<emitter type=\"envmap\">FILE</emitter>", name);
}

/// A picture of every format that is read, written by the binary itself.
fn picture(name: &str) -> Vec<u8> {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "1", "-q"]);
    if name != "a.exr" {
        workshop.run(&["convert", "a.exr", name]).fine();
    }
    workshop.read(name)
}

#[test]
fn ply() {
    bad_ply("", "m.ply");
    bad_ply("ply\n", "m.ply");
    bad_ply(PLY, "m.ply");
    bad_ply(format!("{PLY}0 0 0\n1 0 0\n"), "m.ply");
    bad_ply(format!("{PLY}0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), "m.ply");
    bad_ply(format!("{PLY}0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n"), "m.ply");
    bad_ply(format!("{PLY}0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"), "m.ply");
    let huge = PLY.replace("vertex 3", "vertex 4000000000");
    bad_ply(format!("{huge}0 0 0\n"), "m.ply");
    let binary = PLY.replace("ascii", "binary_little_endian");
    bad_ply(format!("{binary}too short"), "m.ply");
    let binary = huge.replace("ascii", "binary_big_endian");
    bad_ply(format!("{binary}too short"), "m.ply");
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
    bad_ply(bytes, "m.ply");
}

#[test]
fn obj() {
    bad_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "m.obj");
    bad_obj("v 0 0\n", "m.obj");
    bad_obj("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj");
    bad_obj("v 0 0 x\n", "m.obj");
    bad_obj("v 0 0 0\nf 1 1\n", "m.obj");
    bad_obj("ply\nformat ascii 1.0\n", "m.obj");
}

#[test]
fn pictures() {
    for name in ["a.exr", "a.png", "a.hdr"] {
        let whole = picture(name);
        bad_picture(name, b"");
        bad_picture(name, b"nothing like a picture");
        bad_picture(name, &whole[..whole.len() / 2]);
        bad_picture(name, &whole[..20]);
    }
}

#[test]
fn a_mesh_without_triangles_is_no_mistake() {
    let workshop = Workshop::new();
    workshop.write("m.obj", "v 0 0 0\n");
    workshop.write(
        "scene.xml",
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\">\
         <integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/></film></sensor>\
         <shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></shape></scene>",
    );
    let ran = workshop.run(&["render", "scene.xml", "-o", "x.exr"]);
    assert!(!ran.stderr.contains("panicked"), "{}", ran.stderr);
    if ran.code == Some(0) {
        let image = workshop.image("x.exr").image;
        assert!(
            image
                .channels()
                .iter()
                .all(|c| c.samples.iter().all(|v| *v == 0.0))
        );
    } else {
        assert!(ran.refused().stderr.contains("m.obj"));
    }
}

/// What git keeps of a large file that was not fetched says so, wherever a picture is read.
#[test]
fn pointers_of_git_lfs_are_told() {
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
    let bitmap = "<texture type=\"bitmap\" name=\"reflectance\">FILE</texture>";
    let shape = format!("<shape type=\"sphere\"><bsdf type=\"diffuse\">{bitmap}</bsdf></shape>");
    refused("t.png", pointer.as_bytes(), &shape, "a pointer of git LFS");
    let workshop = Workshop::new();
    for name in ["a.exr", "b.exr", "c.png"] {
        workshop.write(name, pointer);
    }
    for arguments in [
        &["info", "a.exr"][..],
        &["info", "c.png"],
        &["compare", "a.exr", "b.exr"],
        &["convert", "a.exr", "o.png"],
        &["convert", "c.png", "o.pfm"],
    ] {
        let ran = workshop.run(arguments).refused();
        assert!(
            ran.stderr.contains("a pointer of git LFS"),
            "{}",
            ran.stderr
        );
    }
}
