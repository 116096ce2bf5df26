//! Where claims, scenes, references and reports lie in the workspace.

use std::path::{Path, PathBuf};

/// The root of the workspace.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_owned()
}

/// The claims, one TOML file each.
pub fn claims() -> PathBuf {
    root().join("validation/claims")
}

/// The references, an EXR and a JSON file each.
pub fn references() -> PathBuf {
    root().join("validation/references")
}

/// The scenes that claims are about.
pub fn scenes() -> PathBuf {
    root().join("scenes")
}

/// Where the report is written unless somebody asks for another place.
pub fn report() -> PathBuf {
    root().join("target/validation")
}
