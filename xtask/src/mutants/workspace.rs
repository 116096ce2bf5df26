//! The worktree in which faults are planted, built and put to the claims.
//!
//! It holds a commit, so that work in progress has no part in it, and lies in
//! `target/mutants/workspace` with a target directory of its own beside it.

use super::list::{Mutant, sources};
use etalon_validation::folders;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The worktree.
pub(crate) struct Workspace {
    folder: PathBuf,
    /// The commit that it holds.
    pub(crate) commit: String,
    /// When a run of claims is given up.
    limit: Duration,
}

/// What came of a run of claims.
pub(crate) enum Run {
    /// Its rows, as the report's JSON has them.
    Rows(Vec<Value>),
    /// It did not end in time.
    TimedOut,
    /// It left no report: the reason.
    Crashed(String),
}

/// Which program is put to the claims.
#[derive(Clone, Copy)]
pub(crate) enum Program {
    /// The one that is built of the worktree as it is.
    Mutated,
    /// The one that [`Workspace::build_sound`] has put aside: faults are in sources, not in claims or scenes.
    Sound,
}

/// Where everything lies.
pub(crate) fn folder() -> PathBuf {
    folders::root().join("target/mutants")
}

impl Workspace {
    /// The worktree at the commit that it was made of; at the last commit if there is none or if
    /// `fresh`. Git writes only files that differ, so builds stay incremental.
    pub(crate) fn open(fresh: bool, limit: Duration) -> Result<Self, String> {
        let (root, folder) = (folders::root(), folder());
        let copy = folder.join("workspace");
        if copy.join(".git").exists() {
            let commit = git(if fresh { &root } else { &copy }, &["rev-parse", "HEAD"])?;
            // Undoes what an interrupted run has left planted, too.
            git(&copy, &["checkout", "--force", "--detach", &commit])?;
        } else {
            // What is there without it was made by an older program.
            let _ = fs::remove_dir_all(&copy);
            let place = copy.to_string_lossy();
            git(&root, &["worktree", "add", "--force", "--detach", &place])?;
        }
        Ok(Self {
            commit: git(&copy, &["rev-parse", "HEAD"])?,
            folder,
            limit,
        })
    }

    /// The root of the worktree.
    fn root(&self) -> PathBuf {
        self.folder.join("workspace")
    }

    /// Plants a fault, in place of any other.
    pub(crate) fn plant(&self, mutant: &Mutant) -> Result<(), String> {
        git(&self.root(), &["checkout", "--force", "--detach"])?;
        let (path, mutated) = mutant.applied(&sources(&self.root()))?;
        fs::write(path, mutated).map_err(|e| e.to_string())
    }

    /// Builds the validation. The inner `Err` is what the compiler says.
    pub(crate) fn build(&self) -> Result<Result<(), String>, String> {
        let output = Command::new("cargo")
            .args(["build", "--quiet", "--profile=fast", "--package=xtask"])
            .current_dir(self.root())
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            .output()
            .map_err(|e| format!("cannot run cargo: {e}"))?;
        if output.status.success() {
            return Ok(Ok(()));
        }
        let said = String::from_utf8_lossy(&output.stderr);
        let errors = said.lines().skip_while(|line| !line.starts_with("error"));
        Ok(Err(errors.take(12).collect::<Vec<_>>().join("\n")))
    }

    /// Builds the sound program and puts it aside, unless that was done before.
    pub(crate) fn build_sound(&self) -> Result<(), String> {
        let program = self.program(Program::Sound);
        if !program.exists() {
            self.build()??;
            // Whole or not at all: half of one would be taken for the sound program by the next run.
            let half = program.with_extension("part");
            fs::copy(self.program(Program::Mutated), &half)
                .and_then(|_| fs::rename(&half, &program))
                .map_err(|e| format!("{}: {e}", program.display()))?;
        }
        Ok(())
    }

    fn program(&self, which: Program) -> PathBuf {
        match which {
            Program::Mutated => self.folder.join("target/fast/xtask"),
            Program::Sound => self.folder.join(format!("sound-{}", self.commit)),
        }
    }

    /// Whether the worktree has a claim of this name.
    pub(crate) fn has_claim(&self, name: &str) -> bool {
        let claims = self.root().join("validation/claims");
        claims.join(format!("{name}.toml")).exists()
    }

    /// Runs the default suite, or the claims that `only` means.
    pub(crate) fn validate(
        &self,
        program: Program,
        only: Option<&str>,
        seed: u64,
    ) -> Result<Run, String> {
        let report = self.folder.join("report");
        let json = report.join("report.json");
        if json.exists() {
            fs::remove_file(&json).map_err(|e| format!("{}: {e}", json.display()))?;
        }
        let log = self.folder.join("validate.log");
        let file = fs::File::create(&log).map_err(|e| format!("{}: {e}", log.display()))?;
        let mut child = Command::new(self.program(program))
            .args(["validate", "--seed", &seed.to_string(), "--report"])
            .arg(&report)
            .args(only.map(|name| ["--only", name]).into_iter().flatten())
            .current_dir(self.root())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(file)
            .spawn()
            .map_err(|e| format!("cannot run the validation of the worktree: {e}"))?;
        let start = Instant::now();
        while child.try_wait().map_err(|e| e.to_string())?.is_none() {
            if start.elapsed() > self.limit {
                child.kill().map_err(|e| e.to_string())?;
                child.wait().map_err(|e| e.to_string())?;
                return Ok(Run::TimedOut);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        let text = fs::read_to_string(&json).unwrap_or_default();
        let mut report: Value = serde_json::from_str(&text).unwrap_or_default();
        match report["rows"].take() {
            Value::Array(rows) => Ok(Run::Rows(rows)),
            _ => Ok(Run::Crashed(last_lines(&log))),
        }
    }
}

fn last_lines(log: &Path) -> String {
    let text = fs::read_to_string(log).unwrap_or_default();
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(6)..].join("\n")
}

/// What git says when it is run in `folder`.
fn git(folder: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new("git")
        .args(arguments)
        .current_dir(folder)
        .output()
        .map_err(|e| format!("cannot run git: {e}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    } else {
        let said = String::from_utf8_lossy(&output.stderr);
        Err(format!("git {}: {}", arguments.join(" "), said.trim()))
    }
}
