//! What became of mutants: one line of JSON for each, so that an interrupted run can go on.

use super::list::Mutant;
use serde::{Deserialize, Serialize};
use std::io::{ErrorKind, Write};
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
    /// `failed`, or `broken` if the comparison could not be made any more.
    pub(crate) outcome: String,
    /// The verdict on the pictures.
    pub(crate) verdict: Option<String>,
    /// The corrected p-value.
    pub(crate) p: Option<f64>,
}

/// One mutant's line.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Record {
    /// The mutant's name, file and change: a record of another change is of no use.
    pub(crate) name: String,
    file: PathBuf,
    text: String,
    replacement: String,
    /// The seed of all pictures.
    seed: u64,
    /// Whether the default suite was to run after the named claims.
    named_only: bool,
    /// The commit that it was planted in; absent where older programs wrote the record.
    #[serde(default)]
    commit: Option<String>,
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
    pub(crate) fn new(mutant: &Mutant, seed: u64, named_only: bool, commit: &str) -> Self {
        Self {
            name: mutant.name.clone(),
            file: mutant.file.clone(),
            text: mutant.text.clone(),
            replacement: mutant.replacement.clone(),
            seed,
            named_only,
            commit: Some(commit.to_owned()),
            fate: Fate::Survived,
            killer: None,
            as_named: false,
            message: None,
            seconds: 0.0,
        }
    }

    /// Whether it was planted in this commit.
    pub(crate) fn is_of(&self, commit: &str) -> bool {
        self.commit.as_deref() == Some(commit)
    }

    /// Whether this tells what became of `mutant` under `seed`. Whoever survived the named claims
    /// alone has yet to see the default suite, and mistakes are tried again.
    pub(crate) fn tells(&self, mutant: &Mutant, seed: u64, named_only: bool) -> bool {
        let same = self.name == mutant.name
            && self.file == mutant.file
            && self.text == mutant.text
            && self.replacement == mutant.replacement
            && self.seed == seed;
        let enough = match self.fate {
            Fate::Killed => true,
            Fate::Survived | Fate::TimedOut => named_only || !self.named_only,
            Fate::DoesNotApply | Fate::DoesNotBuild => false,
        };
        same && enough
    }
}

/// The records of a run.
pub(crate) struct Records {
    path: PathBuf,
    all: Vec<Record>,
}

impl Records {
    /// Those in the file at `path`, if there is one. A last line that an interruption cut short
    /// is left out.
    pub(crate) fn open(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        let parse = |line| serde_json::from_str(line).ok();
        Self {
            path: path.to_owned(),
            all: text.lines().filter_map(parse).collect(),
        }
    }

    /// What is known of a mutant.
    pub(crate) fn of(&self, mutant: &Mutant, seed: u64, named_only: bool) -> Option<&Record> {
        let mut latest = self.all.iter().rev();
        latest.find(|record| record.tells(mutant, seed, named_only))
    }

    /// Forgets these mutants, in memory and in the file.
    pub(crate) fn forget(&mut self, mutants: &[Mutant]) -> Result<(), String> {
        let asked = |record: &Record| mutants.iter().any(|mutant| mutant.name == record.name);
        let (_, kept) = std::mem::take(&mut self.all).into_iter().partition(asked);
        match std::fs::remove_file(&self.path) {
            Err(e) if e.kind() != ErrorKind::NotFound => {
                return Err(format!("{}: {e}", self.path.display()));
            }
            _ => {}
        }
        let kept: Vec<Record> = kept;
        kept.into_iter().try_for_each(|record| self.push(record))
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
    fn a_record_tells_of_the_same_change_only() {
        let mutants = super::super::list::read().expect("the list can be read");
        let mut record = Record::new(&mutants[0], 1, true, "abc");
        assert!(record.tells(&mutants[0], 1, true));
        // Mutants rejected: survivors of fewer claims, another seed or another change are kept.
        assert!(!record.tells(&mutants[0], 1, false));
        assert!(!record.tells(&mutants[0], 2, true));
        assert!(!record.tells(&mutants[1], 1, true));
        record.fate = Fate::Killed;
        assert!(record.tells(&mutants[0], 1, false));
        record.fate = Fate::DoesNotBuild;
        assert!(!record.tells(&mutants[0], 1, true));
    }

    #[test]
    fn a_new_beginning_for_some_leaves_the_others() {
        let mutants = super::super::list::read().expect("the list can be read");
        let path = std::env::temp_dir().join(format!("etalon-records-{}", std::process::id()));
        let mut records = Records::open(&path);
        for mutant in &mutants[..3] {
            let record = Record::new(mutant, 1, true, "abc");
            records.push(record).expect("written");
        }
        // Mutant rejected: everything is forgotten.
        records.forget(&mutants[1..2]).expect("written");
        let again = Records::open(&path);
        for records in [&records, &again] {
            let known = |i: usize| records.of(&mutants[i], 1, true);
            assert!(known(0).is_some() && known(1).is_none() && known(2).is_some());
            assert!(known(0).is_some_and(|record| record.is_of("abc") && !record.is_of("abd")));
        }
        std::fs::remove_file(&path).expect("removed");
    }

    #[test]
    fn records_of_older_programs_are_of_no_known_commit() {
        let mutants = super::super::list::read().expect("the list can be read");
        let mut value = serde_json::json!(Record::new(&mutants[0], 1, true, "abc"));
        value.as_object_mut().expect("an object").remove("commit");
        let record: Record = serde_json::from_value(value).expect("a record");
        assert!(record.tells(&mutants[0], 1, true) && !record.is_of("abc"));
    }
}
