//! Every file in `tests/malformed` and what is said about it.
//!
//! `NAME.xml` is read; the messages must be the lines of `NAME.expected`, with file names
//! without their folder. `parts` holds files that others include.

use etalon_formats::ReadOptions;
use etalon_formats::mitsuba::read;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[test]
fn every_malformed_file_has_its_messages() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed");
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)
        .expect("the folder exists")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| e == "xml"))
        .collect();
    files.sort();
    assert!(files.len() >= 40, "the corpus is there");
    let mut failures = Vec::new();
    for file in files {
        let start = Instant::now();
        let outcome = read(&file, &ReadOptions::default());
        assert!(
            start.elapsed() < Duration::from_secs(1),
            "{}",
            file.display()
        );
        assert!(outcome.has_errors(), "{} has a mistake", file.display());
        let folder = folder.display().to_string();
        let found = outcome
            .lines()
            .replace(&format!("{folder}/"), "")
            .replace(&folder, "FOLDER");
        let expected = std::fs::read_to_string(file.with_extension("expected")).unwrap_or_default();
        if found.trim() != expected.trim() {
            failures.push(format!(
                "== {}\n{found}\n-- expected\n{expected}",
                file.display()
            ));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
