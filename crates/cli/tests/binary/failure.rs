//! What cannot work is refused before anything is rendered, and leaves nothing behind.

use crate::workshop::{Workshop, cornell_box};

/// Tries to render to a file that cannot be written; `words` must be in the one line that says
/// so.
#[track_caller]
fn refused(workshop: &Workshop, output: &str, words: &str) {
    let before = workshop.files();
    // So many samples that rendering first would be noticed.
    let scene = cornell_box();
    let ran = workshop
        .run(&["render", &scene, "-o", output, "--spp", "1000000000"])
        .refused();
    assert_eq!(ran.stderr.lines().count(), 1, "{}", ran.stderr);
    assert!(
        ran.stderr.starts_with("error: cannot write "),
        "{}",
        ran.stderr
    );
    assert!(
        ran.stderr.contains(output) && ran.stderr.contains(words),
        "{}",
        ran.stderr
    );
    assert_eq!(workshop.files(), before);
}

#[test]
fn outputs_that_cannot_be_written() {
    let workshop = Workshop::new();
    refused(&workshop, "a.jpg", ".exr");
    refused(&workshop, "a", ".exr");
    refused(&workshop, "nowhere/a.exr", "no such folder");
    std::fs::create_dir(workshop.path("folder.exr")).expect("created");
    refused(&workshop, "folder.exr", "a folder");
    workshop.write("file", "");
    refused(&workshop, "file/a.exr", "no such folder");
}

/// Nobody may write there, not even root.
#[cfg(target_os = "linux")]
#[test]
fn folders_in_which_no_file_can_be_made() {
    refused(&Workshop::new(), "/proc/a.exr", "/proc");
}

#[test]
fn scenes_that_are_not_there() {
    let workshop = Workshop::new();
    for scene in ["none.xml", ".", "scene.blend"] {
        let ran = workshop.run(&["render", scene, "-o", "a.exr"]).refused();
        assert!(ran.stderr.contains(scene), "{}", ran.stderr);
    }
    assert!(workshop.files().is_empty());
}

#[test]
fn a_refused_scene_leaves_an_older_image_alone() {
    let workshop = Workshop::new();
    workshop.write("a.exr", "precious");
    workshop.write(
        "bad.xml",
        "<scene version=\"3.0.0\"><shape type=\"sphear\"/></scene>",
    );
    workshop
        .run(&["render", "bad.xml", "-o", "a.exr"])
        .refused();
    assert_eq!(workshop.read("a.exr"), b"precious");
}
