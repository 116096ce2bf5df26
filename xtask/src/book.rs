//! `cargo xtask book`: the pages of `docs/` as a book, by mdBook.

use std::path::Path;
use std::process::Command;

/// Builds the book into `target/book`.
///
/// # Errors
/// If mdBook is not there, or fails.
pub(crate) fn run() -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let built = Command::new("mdbook")
        .arg("build")
        .arg(root.join("docs"))
        .status();
    let status = built.map_err(|error| {
        format!("`mdbook` cannot be run ({error}): `cargo install mdbook` brings it")
    })?;
    if !status.success() {
        return Err(format!("`mdbook build docs` failed: {status}"));
    }
    println!("target/book/index.html");
    Ok(())
}
