//! The schemas hold for all scenes of the repository, and for no scene with a mistake that they can know.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every scene of today's format below a folder.
fn scenes(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("it is there") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            scenes(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "xml") {
            let text = fs::read_to_string(&path).expect("a text");
            if text.contains("<scene version=\"3") {
                found.push(path);
            }
        }
    }
}

/// What `xmllint` says of these files; `None` where there is none.
fn validated(option: &str, schema: &str, files: &[PathBuf]) -> Option<Output> {
    let schema = root().join("docs/schema").join(schema);
    let mut command = Command::new("xmllint");
    command.args(["--noout", option]).arg(schema).args(files);
    let output = command.output();
    if output.is_err() {
        eprintln!("not tried: there is no xmllint");
    }
    output.ok()
}

#[test]
fn all_scenes_are_valid() {
    let mut files = Vec::new();
    scenes(&root().join("scenes"), &mut files);
    assert!(files.len() > 150, "{}", files.len());
    for (option, schema) in [("--relaxng", "etalon.rng"), ("--schema", "etalon.xsd")] {
        let Some(output) = validated(option, schema, &files) else {
            return;
        };
        let said = String::from_utf8_lossy(&output.stderr);
        let faults: Vec<&str> = (said.lines())
            .filter(|line| !line.ends_with(" validates"))
            .take(20)
            .collect();
        assert!(output.status.success(), "{schema}: {}", faults.join("\n"));
    }
}

#[test]
fn mistakes_are_not() {
    let folder = std::env::temp_dir().join(format!("etalon-schema-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let within = |inner: &str| format!("<scene version=\"3.0.0\">{inner}</scene>");
    let ball = |inner: &str| within(&format!("<shape type=\"sphere\">{inner}</shape>"));
    for (index, (text, valid)) in [
        (ball("<float name=\"radius\" value=\"2\"/>"), true),
        (ball("<float name=\"radius\" value=\"$r\"/>"), true),
        (ball("<float name=\"radius\" value=\"2*pi/3\"/>"), true),
        (ball("<float name=\"radius\" value=\"two\"/>"), false),
        (ball("<float name=\"radios\" value=\"2\"/>"), false),
        (ball("<string name=\"radius\" value=\"2\"/>"), false),
        (ball("<float name=\"radius\"/>"), false),
        (ball("<film type=\"hdrfilm\"/>"), false),
        (within("<shape type=\"spere\"/>"), false),
        (within("<shape type=\"$shape\"><float name=\"any\" value=\"1\"/></shape>"), true),
        (ball("<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"checkerboard\"/></bsdf>"), true),
        (ball("<bsdf type=\"diffuse\"><texture name=\"reflection\" type=\"checkerboard\"/></bsdf>"), false),
        (ball("<transform name=\"to_world\"><rotate z=\"1\"/></transform>"), false),
    ]
    .into_iter()
    .enumerate()
    {
        let path = folder.join(format!("{index}.xml"));
        fs::write(&path, &text).expect("written");
        let Some(output) = validated("--relaxng", "etalon.rng", &[path]) else {
            break;
        };
        assert_eq!(output.status.success(), valid, "{text}");
    }
    fs::remove_dir_all(&folder).expect("removed");
}
