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
fn folders_of_data_that_are_not_there() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let ran = workshop.run(&["render", &scene, "-o", "a.exr", "--data", "nowhere"]);
    assert_eq!(ran.refused().stderr, "error: there is no folder nowhere\n");
}

/// Readers may stop listening (`etalon info a.exr | head -1`); a full disk loses the result.
#[cfg(target_os = "linux")]
#[test]
fn outputs_that_nobody_reads() {
    let workshop = Workshop::new();
    workshop.render("a.exr", &["--spp", "1", "-q"]);
    let shell = |line: &str| {
        // The first word only: the workspace may lie in a folder of that name.
        let line = line.replacen("etalon", env!("CARGO_BIN_EXE_etalon"), 1);
        let mut command = std::process::Command::new("bash");
        let output = command
            .args(["-o", "pipefail", "-c", &line])
            .current_dir(workshop.path(""))
            .output();
        let output = output.expect("bash runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{said}");
        (output.status.code(), said)
    };
    for command in [
        "info a.exr",
        "info none.exr 2>&1",
        "compare a.exr a.exr --json",
    ] {
        shell(&format!("etalon {command} | true"));
    }
    let render = format!(
        "etalon render {} -o b.exr --spp 1 2>&1 | true",
        cornell_box()
    );
    assert_eq!(shell(&render).0, Some(0));
    assert!(workshop.files().contains(&"b.exr".to_owned()));
    // A link to a pipe is written to as to the pipe.
    let piped = "ln -s /dev/stdout o.pfm; [ \"$(etalon convert a.exr o.pfm | head -n 1)\" = PF ]";
    assert_eq!(shell(piped).0, Some(0));
    assert!(std::fs::read_link(workshop.path("o.pfm")).is_ok());
    let (code, said) = shell("etalon info a.exr > /dev/full");
    assert_eq!(code, Some(2));
    assert!(
        said.starts_with("error: cannot write to standard output"),
        "{said}"
    );
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
