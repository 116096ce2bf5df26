//! The copy of the workspace in which faults are planted, built and put to the claims.
//!
//! It holds the files of the last commit, so that work in progress has no part in it, and lies in
//! `target/mutants/workspace` with a target directory of its own beside it.

use super::list::Mutant;
use etalon_images::write_atomically;
use etalon_validation::folders;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The copy.
pub(crate) struct Workspace {
    folder: PathBuf,
    /// The commit that it holds.
    pub(crate) commit: String,
    /// When a run of claims is given up.
    pub(crate) limit: Duration,
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

/// Where everything lies.
pub(crate) fn folder() -> PathBuf {
    folders::root().join("target/mutants")
}

impl Workspace {
    /// The copy as it lies there, of the commit that it was made of; made of the last commit if
    /// there is none or if `fresh`. Only files that differ are written, so builds stay incremental.
    pub(crate) fn open(fresh: bool, limit: Duration) -> Result<Self, String> {
        let folder = folder();
        let note = folder.join("commit");
        fs::create_dir_all(folder.join("workspace")).map_err(|e| e.to_string())?;
        let kept = fs::read_to_string(&note).ok().filter(|_| !fresh);
        let commit = match kept {
            Some(commit) => commit,
            None => git(&folder, &["rev-parse", "HEAD"])?.trim().to_owned(),
        };
        git(&folder, &["read-tree", "--reset", "-u", &commit])?;
        // What an interrupted run has left mutated.
        git(&folder, &["checkout-index", "--all", "--force"])?;
        fs::write(&note, &commit).map_err(|e| format!("{}: {e}", note.display()))?;
        Ok(Self {
            folder,
            commit,
            limit,
        })
    }

    /// The root of the copy.
    pub(crate) fn root(&self) -> PathBuf {
        self.folder.join("workspace")
    }

    /// Plants a fault.
    pub(crate) fn plant(&self, mutant: &Mutant) -> Result<Planted, String> {
        let application = mutant.applied(&self.root())?;
        let path = self.root().join(&application.file);
        let sound = fs::read(&path).map_err(|e| e.to_string())?;
        let planted = Planted { path, sound };
        fs::write(&planted.path, application.mutated).map_err(|e| e.to_string())?;
        Ok(planted)
    }

    /// Builds the validation. The inner `Err` is what the compiler says.
    pub(crate) fn build(&self) -> Result<Result<(), String>, String> {
        let output = Command::new("cargo")
            .args([
                "build",
                "--quiet",
                "--profile",
                "fast",
                "--package",
                "xtask",
            ])
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

    /// The sound program's validation, kept aside: faults are in sources, not in claims or scenes.
    fn sound(&self) -> PathBuf {
        self.folder.join(format!("sound/{}", self.commit))
    }

    /// Builds the sound program, unless it was built before.
    pub(crate) fn build_sound(&self) -> Result<(), String> {
        let program = self.sound().join("xtask");
        if !program.exists() {
            self.build()??;
            fs::create_dir_all(self.sound())
                .and_then(|()| copy_whole(&self.mutated(), &program))
                .map_err(|e| format!("{}: {e}", program.display()))?;
        }
        Ok(())
    }

    /// The program that is built of the copy.
    fn mutated(&self) -> PathBuf {
        self.folder.join("target/fast/xtask")
    }

    /// Whether the copy has a claim of this name.
    pub(crate) fn has_claim(&self, name: &str) -> bool {
        let claims = self.root().join("validation/claims");
        claims.join(format!("{name}.toml")).exists()
    }

    /// As [`Workspace::validate`], of the sound program: once for each commit, seed and `only`.
    pub(crate) fn validate_sound(&self, only: Option<&str>, seed: u64) -> Result<Run, String> {
        let name = only.unwrap_or("the suite");
        let kept = self.sound().join(format!("{name}, seed {seed}.json"));
        let text = fs::read_to_string(&kept).ok();
        if let Some(rows) = text.and_then(|text| serde_json::from_str(&text).ok()) {
            return Ok(Run::Rows(rows));
        }
        let run = self.run(&self.sound().join("xtask"), only, seed)?;
        if let Run::Rows(rows) = &run {
            let rows = Value::from(rows.clone()).to_string();
            write_atomically(&kept, |file| file.write_all(rows.as_bytes()))
                .map_err(|e| format!("{}: {e}", kept.display()))?;
        }
        Ok(run)
    }

    /// Runs the default suite, or the claims whose names contain `only`.
    pub(crate) fn validate(&self, only: Option<&str>, seed: u64) -> Result<Run, String> {
        self.run(&self.mutated(), only, seed)
    }

    fn run(&self, program: &Path, only: Option<&str>, seed: u64) -> Result<Run, String> {
        let report = self.folder.join("report");
        let json = report.join("report.json");
        if json.exists() {
            fs::remove_file(&json).map_err(|e| format!("{}: {e}", json.display()))?;
        }
        let mut command = Command::new(program);
        command
            .args(["validate", "--seed", &seed.to_string()])
            .arg("--report")
            .arg(&report);
        if let Some(name) = only {
            command.args(["--only", name]);
        }
        let log = self.folder.join("validate.log");
        let file = fs::File::create(&log).map_err(|e| format!("{}: {e}", log.display()))?;
        let child = command
            .current_dir(self.root())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(file)
            .spawn()
            .map_err(|e| format!("cannot run the copy's validation: {e}"))?;
        if !ended(child, self.limit)? {
            return Ok(Run::TimedOut);
        }
        let rows = fs::read_to_string(&json)
            .ok()
            .and_then(|text| serde_json::from_str::<Value>(&text).ok())
            .and_then(|mut report| match report["rows"].take() {
                Value::Array(rows) => Some(rows),
                _ => None,
            });
        Ok(rows.map_or_else(|| Run::Crashed(last_lines(&log)), Run::Rows))
    }
}

/// Copies a program, which is at `to` whole or not at all: half of one would be taken for the sound
/// program by the next run. Its permissions are those of the original.
fn copy_whole(from: &Path, to: &Path) -> std::io::Result<()> {
    let half = to.with_extension(format!("{}.part", std::process::id()));
    let copied = fs::copy(from, &half).and_then(|_| fs::rename(&half, to));
    if copied.is_err() {
        let _ = fs::remove_file(&half);
    }
    copied
}

/// Waits for `child`, and stops it after `limit`. Whether it ended by itself.
fn ended(mut child: Child, limit: Duration) -> Result<bool, String> {
    let start = Instant::now();
    loop {
        if child.try_wait().map_err(|e| e.to_string())?.is_some() {
            return Ok(true);
        }
        if start.elapsed() > limit {
            child.kill().map_err(|e| e.to_string())?;
            child.wait().map_err(|e| e.to_string())?;
            return Ok(false);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

fn last_lines(log: &Path) -> String {
    let text = fs::read_to_string(log).unwrap_or_default();
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(6)..].join("\n")
}

/// Runs git on the copy: with an index of its own, so that the checkout's stays as it is.
fn git(folder: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new("git")
        .arg("--work-tree")
        .arg(folder.join("workspace"))
        .args(arguments)
        .current_dir(folders::root())
        .env("GIT_INDEX_FILE", folder.join("index"))
        .output()
        .map_err(|e| format!("cannot run git: {e}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        let said = String::from_utf8_lossy(&output.stderr);
        Err(format!("git {}: {}", arguments.join(" "), said.trim()))
    }
}

/// A file with a fault in it; sound again when this is dropped.
pub(crate) struct Planted {
    path: PathBuf,
    sound: Vec<u8>,
}

impl Drop for Planted {
    fn drop(&mut self) {
        if let Err(error) = fs::write(&self.path, &self.sound) {
            eprintln!("error: {} stays mutated: {error}", self.path.display());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_whole_or_not_there() {
        let folder = std::env::temp_dir().join(format!("etalon-copy-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        let (from, to) = (folder.join("from"), folder.join("to"));
        // Mutant rejected: a failed copy leaves a file that the next run takes for the program.
        assert!(copy_whole(&from, &to).is_err() && !to.exists());
        fs::write(&from, "a program").expect("written");
        copy_whole(&from, &to).expect("copied");
        assert_eq!(fs::read_to_string(&to).expect("readable"), "a program");
        assert_eq!(fs::read_dir(&folder).map_or(0, Iterator::count), 2);
        fs::remove_dir_all(&folder).expect("removed");
    }
}
