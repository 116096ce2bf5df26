//! Every scene in `tests/bad` is refused: within a second, with the messages that stand in
//! comments at its end (`<!-- LINE:COLUMN WORDS -->`).

use crate::Said;
use std::path::{Path, PathBuf};

/// What is wrong with what is said about a scene.
fn complaint(file: &Path) -> Option<String> {
    let name = file.file_name()?.to_str()?;
    let text = std::fs::read_to_string(file).ok()?;
    let comments = text.lines().filter_map(|line| {
        let inside = line.strip_prefix("<!-- ")?.strip_suffix(" -->")?;
        inside.split_once(' ')
    });
    let promised: Vec<(&str, &str)> = comments.collect();
    let said = Said::of_file(file);
    let errors = said.errors();
    let as_promised = errors.len() == promised.len()
        && errors.iter().zip(&promised).all(|(line, (place, words))| {
            line.contains(&format!("{name}:{place}: error: ")) && line.contains(words)
        });
    let fine = !promised.is_empty() && as_promised && said.refused;
    (!fine).then(|| format!("== {name}\n{}promised {promised:?}", said.text))
}

#[test]
fn every_bad_scene_is_refused_with_its_messages() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the folder exists")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| e == "xml"))
        .collect();
    files.sort();
    assert!(files.len() >= 80, "the corpus is there");
    let complaints: Vec<String> = files.iter().filter_map(|file| complaint(file)).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
}
