//! Every scene in `tests/bad` is refused: within a second, with the messages that stand in
//! comments at its end (`<!-- LINE:COLUMN WORDS -->`), and without leaving a file.

use crate::workshop::Workshop;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The messages that a scene's comments promise: place and words.
fn promised(text: &str) -> Vec<(String, String)> {
    let comments = text.lines().filter_map(|line| {
        let inside = line.strip_prefix("<!-- ")?.strip_suffix(" -->")?;
        inside.split_once(' ')
    });
    comments
        .map(|(place, words)| (place.to_owned(), words.to_owned()))
        .collect()
}

/// What is wrong with what the binary says about a scene.
fn complaint(file: &Path) -> Option<String> {
    let name = file.file_name()?.to_str()?;
    let promised = promised(&std::fs::read_to_string(file).ok()?);
    let workshop = Workshop::new();
    let start = Instant::now();
    let ran = workshop.run(&["render", &file.display().to_string(), "-o", "x.exr"]);
    let took = start.elapsed();
    let headings: Vec<&str> = ran
        .stderr
        .lines()
        .filter(|line| line.contains(": error: "))
        .collect();
    let as_promised = headings.len() == promised.len()
        && headings
            .iter()
            .zip(&promised)
            .all(|(line, (place, words))| {
                line.contains(&format!("{name}:{place}: error: ")) && line.contains(words.as_str())
            });
    let shown = ran.stderr.matches(" │ ").count() >= promised.len();
    let fine = !promised.is_empty()
        && as_promised
        && shown
        && ran.code == Some(2)
        && took < Duration::from_secs(1)
        && workshop.files().is_empty()
        && !ran.stderr.contains("panicked");
    (!fine).then(|| {
        let files = workshop.files();
        let code = ran.code;
        format!(
            "== {name}: exit {code:?} after {took:?}, files {files:?}\n{}promised {promised:?}",
            ran.stderr
        )
    })
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

#[test]
fn a_scene_with_very_many_mistakes_is_refused_as_fast() {
    let shape = "<shape type=\"sphere\"><float name=\"radios\" value=\"1\"/></shape>\n";
    let text = format!(
        "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n{}</scene>\n",
        shape.repeat(30_000)
    );
    let workshop = Workshop::new();
    workshop.write("many.xml", text);
    let timed = || {
        let start = Instant::now();
        let ran = workshop
            .run(&["render", "many.xml", "-o", "x.exr"])
            .refused();
        (start.elapsed(), ran)
    };
    // The quickest of some: other work on the machine is no fault of ours.
    let mut tries: Vec<_> = (0..5).map(|_| timed()).collect();
    tries.sort_by_key(|(took, _)| *took);
    let (took, ran) = tries.remove(0);
    assert!(took < Duration::from_secs(1), "{took:?}");
    assert!(
        ran.stderr.contains("many.xml:3:35: error: "),
        "{}",
        ran.stderr
    );
    assert!(ran.stderr.ends_with("… and 29950 more messages\n"));
}
