//! References by Mitsuba 3: every seed is a replicate.
//!
//! Mitsuba runs in a Python environment of its own: the one whose interpreter `ETALON_PYTHON`
//! names, or `target/venv`, which is made and given a pinned Mitsuba when it is not there. The
//! LLVM variant is used if LLVM 17 or later is found (`DRJIT_LIBLLVM_PATH`), otherwise
//! `scalar_spectral`.

use etalon_validation::claim::Claim;
use etalon_validation::reference::{self, Rendered};
use etalon_validation::{folders, run};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The version that references are made with.
const MITSUBA: &str = "mitsuba==3.9.1";

/// Where Debian and Ubuntu keep LLVM.
const LIBRARIES: &str = "/usr/lib/x86_64-linux-gnu";

/// Mitsuba, made ready.
pub(super) struct Mitsuba {
    python: PathBuf,
    variant: String,
}

impl Mitsuba {
    /// Finds it or installs it.
    pub(super) fn new(variant: &str) -> Result<Self, String> {
        Ok(Self {
            python: python()?,
            variant: variant.to_owned(),
        })
    }

    /// Makes the reference of a claim.
    pub(super) fn make(&self, claim: &Claim, spp: u32, seeds: u32) -> Result<(), String> {
        let mut defines = run::defines(claim, None);
        let integrator = claim.oracle.integrator();
        defines.extend(integrator.map(|name| ("integrator".to_owned(), name.to_owned())));
        let (rendered, pixels) =
            render(&self.python, &self.variant, claim, &defines, [spp, seeds])?;
        let error = reference::write(claim, &rendered, spp, &pixels)?;
        println!(
            "{}: {seeds} seeds of {spp} samples per pixel by {}; standard error of the mean {:.4} %",
            claim.name,
            rendered.variant,
            100.0 * error
        );
        if !rendered.skipped_seeds.is_empty() {
            println!(
                "{}: left out the seeds {:?}, whose pictures have pixels that are not finite",
                claim.name, rendered.skipped_seeds
            );
        }
        Ok(())
    }
}

/// Whether a claim's reference belongs to the present state of its scene, and is as large as the
/// claim states.
pub(super) fn is_fresh(claim: &Claim) -> Result<bool, String> {
    let expected = reference::expected(claim)?;
    let read = reference::read_in(&folders::references(), &claim.name, &expected);
    Ok(read.is_ok())
}

/// Renders all seeds of a claim's scene.
fn render(
    python: &Path,
    variant: &str,
    claim: &Claim,
    defines: &[(String, String)],
    [spp, seeds]: [u32; 2],
) -> Result<(Rendered, Vec<f32>), String> {
    let folder = folders::root().join("target/references");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let raw = folder.join(format!("{}.raw", claim.name));
    let mut command = Command::new(python);
    command
        .arg(folders::root().join("validation/mitsuba_seeds.py"))
        .arg(folders::scenes().join(&claim.scene))
        .arg(&raw)
        .args(["--spp", &spp.to_string(), "--seeds", &seeds.to_string()])
        .args(["--variant", variant]);
    for (key, value) in defines {
        command.arg("-D").arg(format!("{key}={value}"));
    }
    find_llvm(&mut command);
    let output = command
        .stderr(std::process::Stdio::inherit())
        .output()
        .map_err(|e| format!("{}: {e}", python.display()))?;
    if !output.status.success() {
        return Err(format!("Mitsuba could not render `{}`", claim.name));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let last = text.trim().lines().last().unwrap_or_default();
    let rendered: Rendered = serde_json::from_str(last)
        .map_err(|e| format!("what rendered `{}` is unclear: {e}", claim.name))?;
    let bytes = fs::read(&raw).map_err(|e| format!("{}: {e}", raw.display()))?;
    fs::remove_file(&raw).map_err(|e| format!("{}: {e}", raw.display()))?;
    let pixels = bytes
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    Ok((rendered, pixels))
}

/// Tells Mitsuba where LLVM is, unless it is told already.
pub(crate) fn find_llvm(command: &mut Command) {
    if std::env::var_os("DRJIT_LIBLLVM_PATH").is_none()
        && let Some(library) = llvm()
    {
        command.env("DRJIT_LIBLLVM_PATH", library);
    }
}

/// The newest LLVM that Mitsuba accepts, if the system has one.
fn llvm() -> Option<PathBuf> {
    (17..=21).rev().find_map(|version| {
        let plain = format!("libLLVM.so.{version}");
        let names = [format!("{plain}.1"), plain];
        names
            .iter()
            .map(|name| Path::new(LIBRARIES).join(name))
            .find(|path| path.exists())
    })
}

/// The Python interpreter that is to have Mitsuba.
fn interpreter() -> PathBuf {
    std::env::var_os("ETALON_PYTHON").map_or_else(
        || folders::root().join("target/venv/bin/python"),
        PathBuf::from,
    )
}

/// A Python interpreter that has Mitsuba, if there is one already.
pub(crate) fn installed() -> Option<PathBuf> {
    Some(interpreter()).filter(|python| has_mitsuba(python))
}

/// A Python interpreter that has Mitsuba.
fn python() -> Result<PathBuf, String> {
    let python = interpreter();
    if std::env::var_os("ETALON_PYTHON").is_none() && !has_mitsuba(&python) {
        let folder = folders::root().join("target/venv");
        println!("making {} with {MITSUBA}", folder.display());
        check(Command::new("python3").args(["-m", "venv"]).arg(&folder))?;
        let pip = ["-m", "pip", "install", "--quiet", MITSUBA, "numpy"];
        check(Command::new(&python).args(pip))?;
    }
    Ok(python)
}

fn has_mitsuba(python: &Path) -> bool {
    Command::new(python)
        .args(["-c", "import mitsuba, numpy"])
        .output()
        .is_ok_and(|output| output.status.success())
}

fn check(command: &mut Command) -> Result<(), String> {
    let name = command.get_program().to_string_lossy().into_owned();
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{name} failed: {status}")),
        Err(error) => Err(format!("{name}: {error}")),
    }
}
