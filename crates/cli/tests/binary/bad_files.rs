//! Meshes of nothing, and pictures that were not fetched.

use crate::workshop::Workshop;

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
