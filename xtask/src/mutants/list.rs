//! The list of mutants, `validation/mutants.toml`, and whether it still fits the sources.

use etalon_validation::claim::Claim;
use etalon_validation::folders;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A physical fault, and the exact change to the sources that commits it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mutant {
    /// Its name, unique in the list.
    pub(crate) name: String,
    /// What is replaced; it occurs exactly once in the sources of all crates.
    pub(crate) text: String,
    /// What it becomes.
    pub(crate) replacement: String,
    /// The physical fault in words.
    pub(crate) fault: String,
    /// Claims that must fail, the surest first.
    pub(crate) claims: Vec<String>,
    /// Whether the energy of some claim's scene changes by 1 % or more.
    #[serde(default = "yes")]
    pub(crate) moves_energy: bool,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    mutants: Vec<Mutant>,
}

/// Reads the list.
pub(crate) fn read() -> Result<Vec<Mutant>, String> {
    let path = folders::root().join("validation/mutants.toml");
    let name = path.display();
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{name}: {e}"))?;
    let file: File = toml::from_str(&text).map_err(|e| format!("{name}: {e}"))?;
    Ok(file.mutants)
}

/// A source file and its text.
pub(crate) type Source = (PathBuf, String);

/// The sources of all crates below `root`.
pub(crate) fn sources(root: &Path) -> Vec<Source> {
    let mut files = Vec::new();
    let mut folders = vec![root.join("crates")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs")
                && path.components().any(|part| part.as_os_str() == "src")
                && let Ok(text) = std::fs::read_to_string(&path)
            {
                files.push((path, text));
            }
        }
    }
    files
}

impl Mutant {
    /// The file that the fault goes into, with the fault in it.
    pub(crate) fn applied(&self, sources: &[Source]) -> Result<Source, String> {
        if self.text.is_empty() || self.text == self.replacement {
            return Err("its text is empty, or the same as its replacement".to_owned());
        }
        let count = |source: &Source| source.1.matches(&self.text).count();
        match sources.iter().map(count).sum() {
            1 => {}
            0 => return Err("its text does not occur".to_owned()),
            count => return Err(format!("its text occurs {count} times, not once")),
        }
        let found = sources.iter().find(|source| count(source) == 1);
        let (path, text) = found.ok_or("its text does not occur")?;
        Ok((path.clone(), text.replace(&self.text, &self.replacement)))
    }
}

/// What is wrong with the list; nothing if every entry applies to the sources of the workspace and
/// says what it must.
pub(crate) fn mistakes(mutants: &[Mutant]) -> Result<Vec<String>, String> {
    let claims = Claim::read_all(&folders::claims())?;
    let claims: BTreeSet<String> = claims.into_iter().map(|claim| claim.name).collect();
    let sources = sources(&folders::root());
    let mut names = BTreeSet::new();
    let mut mistakes = Vec::new();
    for mutant in mutants {
        let mut complain = |what: String| mistakes.push(format!("{}: {what}", mutant.name));
        if !names.insert(&mutant.name) {
            complain("another mutant has this name".to_owned());
        }
        if let Err(what) = mutant.applied(&sources) {
            complain(what);
        }
        for claim in mutant.claims.iter().filter(|c| !claims.contains(*c)) {
            complain(format!("there is no claim `{claim}`"));
        }
        if mutant.claims.is_empty() {
            complain("it names no claim that must fail".to_owned());
        }
    }
    Ok(mistakes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mutant_applies_exactly_once() {
        let mutants = read().expect("the list can be read");
        assert!(mutants.len() >= 60, "only {} mutants", mutants.len());
        let mistakes = mistakes(&mutants).expect("the claims can be read");
        assert!(mistakes.is_empty(), "{}", mistakes.join("\n"));
    }

    #[test]
    fn a_text_that_occurs_twice_or_never_does_not_apply() {
        let mut mutant = read().expect("the list can be read").swap_remove(0);
        let source = |text: &str| (PathBuf::from("a.rs"), text.to_owned());
        mutant.text = "x * y".to_owned();
        mutant.replacement = "x".to_owned();
        let once = [source("x / y"), source("f(x * y)")];
        assert_eq!(mutant.applied(&once), Ok(source("f(x)")));
        // Mutants rejected: a check that is content with one occurrence or more, in one file or in two.
        for sources in [
            vec![source("x / y")],
            vec![source("x * y + x * y")],
            vec![source("x * y"), source("x * y")],
        ] {
            assert!(mutant.applied(&sources).is_err());
        }
    }
}
