//! The list of mutants, `validation/mutants.toml`, and whether it still fits the sources.

use etalon_validation::claim::Claim;
use etalon_validation::folders;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A physical fault, and the exact change to one file that commits it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mutant {
    /// Its name, unique in the list.
    pub(crate) name: String,
    /// The file, from the root of the workspace.
    pub(crate) file: PathBuf,
    /// What is replaced; it occurs exactly once.
    pub(crate) text: String,
    /// What it becomes.
    pub(crate) replacement: String,
    /// The physical fault in words.
    pub(crate) fault: String,
    /// Claims that must fail, the surest first.
    pub(crate) claims: Vec<String>,
    /// Whether the energy of some claim's scene changes by 1 % or more.
    pub(crate) moves_energy: bool,
    /// What becomes of it today.
    #[serde(default)]
    pub(crate) expected: Expected,
    /// Why it survives, and which claim would kill it.
    pub(crate) reason: Option<String>,
}

/// What becomes of a mutant.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Expected {
    /// A claim fails.
    #[default]
    Killed,
    /// No claim can see it yet.
    Survives,
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

impl Mutant {
    /// The file below `root` with the fault in it.
    pub(crate) fn applied(&self, root: &Path) -> Result<String, String> {
        let path = root.join(&self.file);
        let source =
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", self.file.display()))?;
        match source.matches(&self.text).count() {
            1 if self.text != self.replacement => {
                Ok(source.replacen(&self.text, &self.replacement, 1))
            }
            1 => Err("its text and its replacement are the same".to_owned()),
            count => Err(format!(
                "its text occurs {count} times in {}, not once",
                self.file.display()
            )),
        }
    }
}

/// What is wrong with the list; nothing if every entry applies to the sources below `root` and
/// says what it must.
pub(crate) fn mistakes(mutants: &[Mutant], root: &Path) -> Result<Vec<String>, String> {
    let claims: BTreeSet<String> = Claim::read_all(&folders::claims())?
        .into_iter()
        .map(|claim| claim.name)
        .collect();
    let mut names = BTreeSet::new();
    let mut mistakes = Vec::new();
    for mutant in mutants {
        let mut complain = |what: String| mistakes.push(format!("{}: {what}", mutant.name));
        if !names.insert(&mutant.name) {
            complain("another mutant has this name".to_owned());
        }
        if let Err(what) = mutant.applied(root) {
            complain(what);
        }
        if mutant.file.extension().is_none_or(|e| e != "rs") {
            complain("a fault is in a source file".to_owned());
        }
        for claim in mutant.claims.iter().filter(|c| !claims.contains(*c)) {
            complain(format!("there is no claim `{claim}`"));
        }
        let explained = mutant.reason.as_ref().is_some_and(|r| !r.is_empty());
        match mutant.expected {
            Expected::Killed if mutant.claims.is_empty() => {
                complain("it names no claim that must fail".to_owned());
            }
            Expected::Survives if !explained => complain("it gives no `reason`".to_owned()),
            Expected::Survives if mutant.moves_energy => {
                complain("what moves energy must not survive".to_owned());
            }
            _ => {}
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
        assert!(mutants.len() >= 45, "only {} mutants", mutants.len());
        let mistakes = mistakes(&mutants, &folders::root()).expect("the claims can be read");
        assert!(mistakes.is_empty(), "{}", mistakes.join("\n"));
    }

    #[test]
    fn a_text_that_occurs_twice_does_not_apply() {
        let mut mutant = read().expect("the list can be read").swap_remove(0);
        // Mutant rejected: a check that is content with one occurrence or more.
        mutant.text = "\n".to_owned();
        let error = mutant.applied(&folders::root()).expect_err("many lines");
        assert!(error.contains("not once"), "{error}");
        mutant.text = "no such text in any file of ours, not even here".to_owned();
        let error = mutant.applied(&folders::root()).expect_err("no such text");
        assert!(error.contains("occurs 0 times"), "{error}");
    }
}
