//! Scenes of several files.

use super::super::{ParseOptions, Parsed, parse};
use flate2::{Compression, write::GzEncoder};
use std::io::Write;
use std::path::Path;

fn write(folder: &Path, name: &str, bytes: &[u8]) {
    let path = folder.join(name);
    let parent = path.parent().expect("a folder");
    std::fs::create_dir_all(parent).expect("created");
    std::fs::write(path, bytes).expect("written");
}

/// Reads `main.pbrt` among files.
fn parsed(files: &[(&str, &str)]) -> Parsed {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        write(folder.path(), name, text.as_bytes());
    }
    parse(&folder.path().join("main.pbrt"), &ParseOptions::default())
}

/// The messages without the folder's name.
fn lines(parsed: &Parsed) -> String {
    let main = parsed.sources.name(etalon_params::FileId(0));
    let folder = main.strip_suffix("main.pbrt").expect("the main file");
    parsed
        .lines()
        .replace(folder, "")
        .replace(folder.trim_end_matches('/'), "FOLDER")
}

#[test]
fn included_files_continue_and_imported_ones_do_not() {
    let parsed = parsed(&[
        (
            "main.pbrt",
            r#"Include "settings.pbrt" WorldBegin
            Include "open.pbrt" Shape "sphere" AttributeEnd
            CoordinateSystem "outer"
            Import "parts/part.pbrt"
            Shape "disk" CoordSysTransform "outer""#,
        ),
        ("settings.pbrt", "Camera \"orthographic\""),
        ("open.pbrt", "AttributeBegin Scale 2 2 2"),
        (
            "parts/part.pbrt",
            r#"Translate 5 0 0 CoordinateSystem "outer" CoordinateSystem "inner" Include "beside.pbrt"
            ObjectBegin "o" Shape "cylinder" ObjectEnd"#,
        ),
        ("parts/beside.pbrt", "Shape \"cylinder\""),
    ]);
    assert_eq!(parsed.lines(), "");
    let scene = parsed.sound().expect("a scene");
    assert_eq!(scene.camera.entity.kind, "orthographic");
    let xs: Vec<f64> = scene
        .shapes
        .iter()
        .map(|s| s.placement.start.row(0).w)
        .collect();
    assert_eq!(xs, [0.0, 5.0, 0.0]);
    assert_eq!(scene.shapes[0].placement.start.row(0).x, 2.0);
    assert_eq!(scene.objects[0].shapes.len(), 1);
    assert_eq!(scene.files.len(), 5);
    let folders = scene.search.folders();
    assert!(
        folders.last().is_some_and(|last| last.ends_with("parts")),
        "{folders:?}"
    );
}

#[test]
fn coordinate_systems_of_imported_files_are_forgotten() {
    let parsed = parsed(&[
        (
            "main.pbrt",
            "WorldBegin Import \"part.pbrt\"\nCoordSysTransform \"inner\"",
        ),
        (
            "part.pbrt",
            "CoordinateSystem \"inner\" CoordSysTransform \"inner\"",
        ),
    ]);
    let missing = "main.pbrt:2:19: error: there is no coordinate system `inner`";
    assert!(lines(&parsed).starts_with(missing), "{}", lines(&parsed));
}

#[test]
fn circles_and_missing_files() {
    let circle = parsed(&[
        (
            "main.pbrt",
            "WorldBegin Include \"a.pbrt\"\nInclude \"A.pbrt\"",
        ),
        ("a.pbrt", "Shape \"sphere\" Include \"b.pbrt\""),
        ("b.pbrt", "\nInclude \"a.pbrt\""),
    ]);
    assert_eq!(
        lines(&circle),
        "main.pbrt:2:9: error: the file `A.pbrt` was not found (there is `a.pbrt`: capital and small letters differ in the names of files)\n\
         b.pbrt:2:9: error: files include each other: a.pbrt → b.pbrt → a.pbrt"
    );
    let related = &circle.diagnostics[1].related;
    let places: Vec<String> = related
        .iter()
        .map(|(span, _)| circle.sources.location(*span))
        .collect();
    assert!(
        places[0].ends_with("main.pbrt:1:20") && places[1].ends_with("a.pbrt:1:24"),
        "{places:?}"
    );

    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = parse(&folder.path().join("main.pbrt"), &ParseOptions::default());
    assert!(
        missing
            .lines()
            .ends_with("main.pbrt`: there is no such file"),
        "{}",
        missing.lines()
    );
    assert!(missing.scene.is_none());
    let not_a_file = parse(folder.path(), &ParseOptions::default());
    assert!(
        not_a_file.lines().ends_with("`: it is a folder"),
        "{}",
        not_a_file.lines()
    );
}

#[test]
fn included_again_and_again_is_not_exponential() {
    let twice = |name: &str| format!("Include \"{name}\" Include \"{name}\"");
    let mut files: Vec<(String, String)> = (0..40)
        .map(|i| (format!("{i}.pbrt"), twice(&format!("{}.pbrt", i + 1))))
        .collect();
    files.push(("40.pbrt".to_owned(), String::new()));
    files.push((
        "main.pbrt".to_owned(),
        "WorldBegin Include \"0.pbrt\"".to_owned(),
    ));
    let files: Vec<(&str, &str)> = files
        .iter()
        .map(|(n, t)| (n.as_str(), t.as_str()))
        .collect();
    let parsed = parsed(&files);
    assert!(
        parsed
            .lines()
            .contains("the scene includes more than 16384 files"),
        "{}",
        parsed.lines()
    );
}

#[test]
fn blocks_across_files() {
    let parsed = parsed(&[
        (
            "main.pbrt",
            "WorldBegin AttributeBegin Import \"part.pbrt\" AttributeEnd",
        ),
        (
            "part.pbrt",
            "AttributeEnd\nAttributeBegin\nCamera \"perspective\"",
        ),
    ]);
    assert_eq!(
        lines(&parsed),
        "part.pbrt:1:1: error: `AttributeEnd` without `AttributeBegin` (an imported file closes the blocks that it opens, and no others)\n\
         part.pbrt:2:1: error: `AttributeBegin` without `AttributeEnd`\n\
         part.pbrt:3:1: error: `Camera` must stand before `WorldBegin`"
    );
}

#[test]
fn compressed_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(b"Shape \"spher\"").expect("written");
    write(
        folder.path(),
        "part.pbrt.gz",
        &encoder.finish().expect("finished"),
    );
    write(
        folder.path(),
        "main.pbrt",
        b"WorldBegin Include \"part.pbrt.gz\"",
    );
    let parsed = parse(&folder.path().join("main.pbrt"), &ParseOptions::default());
    let expected =
        "part.pbrt.gz:1:7: error: there is no shape of the type `spher` (did you mean `sphere`?)";
    assert_eq!(lines(&parsed), expected);
}
