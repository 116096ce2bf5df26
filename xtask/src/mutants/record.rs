//! The results of mutants: one line of JSON for each, so that an interrupted run can resume.

use super::list::Mutant;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What became of a mutant.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Fate {
    /// A claim failed.
    Killed,
    /// No claim failed that was run.
    Survived,
    /// Its text does not occur exactly once: a mistake in the list.
    DoesNotApply,
    /// The compiler refuses it: a mistake in the list.
    DoesNotBuild,
    /// A claim did not end in time.
    TimedOut,
}

impl std::fmt::Display for Fate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Killed => "killed",
            Self::Survived => "survived",
            Self::DoesNotApply => "does not apply",
            Self::DoesNotBuild => "does not build",
            Self::TimedOut => "timed out",
        })
    }
}

/// The comparison that killed a mutant.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Killer {
    /// The claim.
    pub(crate) claim: String,
    /// Its estimator.
    pub(crate) estimator: String,
    /// `failed`, `broken` if the comparison could not be made any more, or `crashed`.
    pub(crate) outcome: String,
    /// The verdict on the pictures.
    pub(crate) verdict: Option<String>,
    /// The corrected p-value.
    pub(crate) p: Option<f64>,
}

/// How mutants are run: records of another setup are of no use.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub(crate) struct Setup {
    /// The commit that they are planted in.
    pub(crate) commit: String,
    /// The seed of all pictures.
    pub(crate) seed: u64,
    /// Whether the default suite is left out after the named claims.
    pub(crate) named_only: bool,
}

/// One mutant's line.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Record {
    /// The mutant's name and change: a record of another change is of no use.
    pub(crate) name: String,
    text: String,
    replacement: String,
    setup: Setup,
    /// What became of it.
    pub(crate) fate: Fate,
    /// Who killed it.
    pub(crate) killer: Option<Killer>,
    /// Whether a claim killed it that the list names.
    pub(crate) as_named: bool,
    /// Why it does not apply, build or end.
    pub(crate) message: Option<String>,
    /// Seconds of build and claims.
    pub(crate) seconds: f64,
}

impl Record {
    /// A mutant's record; `fate` and what follows it are for the caller to fill in.
    pub(crate) fn new(mutant: &Mutant, setup: &Setup) -> Self {
        Self {
            name: mutant.name.clone(),
            text: mutant.text.clone(),
            replacement: mutant.replacement.clone(),
            setup: setup.clone(),
            fate: Fate::Survived,
            killer: None,
            as_named: false,
            message: None,
            seconds: 0.0,
        }
    }

    /// Whether this tells what becomes of `mutant`. Mistakes of the list are tried again.
    fn tells(&self, mutant: &Mutant, setup: &Setup) -> bool {
        self.name == mutant.name
            && self.text == mutant.text
            && self.replacement == mutant.replacement
            && self.setup == *setup
            && !matches!(self.fate, Fate::DoesNotApply | Fate::DoesNotBuild)
    }
}

/// The records of all runs.
pub(crate) struct Records {
    path: PathBuf,
    all: Vec<Record>,
}

impl Records {
    /// Those in the file at `path`, if there is one. A last line that an interruption cut short
    /// is left out, as is what an older program wrote.
    pub(crate) fn open(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        let parse = |line| serde_json::from_str(line).ok();
        Self {
            path: path.to_owned(),
            all: text.lines().filter_map(parse).collect(),
        }
    }

    /// The latest record of a mutant.
    pub(crate) fn of(&self, mutant: &Mutant, setup: &Setup) -> Option<&Record> {
        let mut latest = self.all.iter().rev();
        latest.find(|record| record.tells(mutant, setup))
    }

    /// Keeps a record, in memory and in the file.
    pub(crate) fn push(&mut self, record: Record) -> Result<(), String> {
        let name = self.path.display();
        let line = serde_json::to_string(&record).map_err(|e| format!("{name}: {e}"))?;
        std::fs::OpenOptions::new()
            .append(true)
            .create(true)
            .open(&self.path)
            .and_then(|mut file| writeln!(file, "{line}"))
            .map_err(|e| format!("{name}: {e}"))?;
        self.all.push(record);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_tells_of_the_same_change_and_setup_only() {
        let mutants = super::super::list::read().expect("the list can be read");
        let setup = |commit: &str, seed, named_only| Setup {
            commit: commit.to_owned(),
            seed,
            named_only,
        };
        let own = setup("abc", 1, true);
        let mut record = Record::new(&mutants[0], &own);
        assert!(record.tells(&mutants[0], &own));
        // Mutants rejected: survivors of fewer claims, another commit, seed or change are kept.
        for other in [
            setup("abd", 1, true),
            setup("abc", 2, true),
            setup("abc", 1, false),
        ] {
            assert!(!record.tells(&mutants[0], &other));
        }
        assert!(!record.tells(&mutants[1], &own));
        record.fate = Fate::DoesNotBuild;
        assert!(!record.tells(&mutants[0], &own));
    }
}
