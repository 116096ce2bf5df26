//! The list of mutants, `validation/mutants.toml`, and whether it still fits the sources.

use super::pattern;
use etalon_validation::claim::Claim;
use etalon_validation::folders;
use serde::Deserialize;
use std::cell::OnceCell;
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
    /// What is replaced; it occurs exactly once, in whatever layout.
    pub(crate) text: String,
    /// What it becomes.
    pub(crate) replacement: String,
    /// The physical fault in words.
    pub(crate) fault: String,
    /// Claims that must fail, the surest first.
    pub(crate) claims: Vec<String>,
    /// Whether the energy of some claim's scene changes by 1 % or more.
    pub(crate) moves_energy: bool,
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

/// A mutant's change to one file.
pub(crate) struct Application {
    /// The file, from the root of the workspace.
    pub(crate) file: PathBuf,
    /// The file's text with the fault in it.
    pub(crate) mutated: String,
    /// The identifiers that are called otherwise than in the list, as `old -> new`.
    pub(crate) renamed: Vec<String>,
}

impl Mutant {
    /// Where the fault goes among the sources below `root`: where its text stands in its file; failing
    /// that in another file; failing that, in either, under other names. It must be one place.
    pub(crate) fn applied(&self, root: &Path) -> Result<Application, String> {
        if self.text == self.replacement {
            return Err("its text and its replacement are the same".to_owned());
        }
        let own = [self.file.clone()];
        let others = OnceCell::new();
        for (renamed, moved) in [(false, false), (false, true), (true, false), (true, true)] {
            let files: &[PathBuf] = if moved {
                others.get_or_init(|| sources(root))
            } else {
                &own
            };
            if let Some(application) = self.applied_to(root, files, renamed)? {
                return Ok(application);
            }
        }
        let file = self.file.display();
        Err(format!("its text occurs neither in {file} nor elsewhere"))
    }

    fn applied_to(
        &self,
        root: &Path,
        files: &[PathBuf],
        renamed: bool,
    ) -> Result<Option<Application>, String> {
        let mut applications = Vec::new();
        for file in files {
            let Ok(source) = std::fs::read_to_string(root.join(file)) else {
                continue;
            };
            for found in pattern::find(&source, &self.text, renamed) {
                let replacement = found.renamed(&self.replacement);
                applications.push(Application {
                    file: file.clone(),
                    mutated: [
                        &source[..found.place.start],
                        &replacement,
                        &source[found.place.end..],
                    ]
                    .concat(),
                    renamed: found.changes(),
                });
            }
        }
        match applications.len() {
            0 | 1 => Ok(applications.pop()),
            count => {
                let file = applications[0].file.display();
                Err(format!(
                    "its text occurs {count} times, not once: first in {file}"
                ))
            }
        }
    }
}

/// The sources of all crates, from `root`.
fn sources(root: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![root.join("crates")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs")
                && path.components().any(|part| part.as_os_str() == "src")
            {
                files.extend(path.strip_prefix(root).map(Path::to_owned));
            }
        }
    }
    files.sort_unstable();
    files
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
        assert!(mutants.len() >= 45, "only {} mutants", mutants.len());
        let mistakes = mistakes(&mutants, &folders::root()).expect("the claims can be read");
        assert!(mistakes.is_empty(), "{}", mistakes.join("\n"));
    }

    #[test]
    fn a_text_that_occurs_twice_or_never_does_not_apply() {
        let mut mutant = read().expect("the list can be read").swap_remove(0);
        // Mutant rejected: a check that is content with one occurrence or more.
        mutant.text = "self".to_owned();
        let error = mutant.applied(&folders::root()).err().expect("many words");
        assert!(error.contains("not once"), "{error}");
        mutant.text = "no 1 such 2 text 3 in 4 any 5 of 6 ours".to_owned();
        let error = mutant.applied(&folders::root()).err().expect("no text");
        assert!(error.contains("neither in"), "{error}");
    }

    #[test]
    fn a_mutant_outlives_a_move_and_a_renaming() {
        let mut mutant = read().expect("the list can be read").swap_remove(0);
        let root = folders::root();
        let there = mutant.applied(&root).expect("applies");
        mutant.file = "crates/integrators/src/gone.rs".into();
        mutant.text = mutant.text.replace("r_u", "rescaled");
        mutant.replacement = mutant.replacement.replace("r_u", "rescaled");
        let again = mutant.applied(&root).expect("applies under other names");
        assert_eq!((again.file, again.mutated), (there.file, there.mutated));
        assert!(!again.renamed.is_empty());
    }
}
