//! Files in: Mitsuba XML, pbrt-v4, glTF 2.0, OBJ, PLY, Mitsuba's serialized meshes.
//!
//! [`mitsuba`] turns a scene file into the description tree, [`pbrt`] and `gltf` do the same with those of pbrt and glTF; [`FileAssets`] finds and reads the
//! files that a scene refers to. Nothing here trusts a file: sizes are checked before memory is
//! asked for, and a broken file is a message, never a panic.

#[cfg(test)]
mod changed_files;
mod document;
mod draft;
mod file_assets;
#[cfg(feature = "gltf")]
pub mod gltf;
mod gzip;
mod mesh_error;
pub mod mitsuba;
mod nan;
pub mod obj;
pub mod pbrt;
pub mod ply;
mod polygon;
#[cfg(test)]
mod same_tree;
mod search_path;
pub mod serialized;
mod unused;

pub use document::{Document, ReadOptions, ReadOutcome, SourceFile, embedded_name, mesh_name};
pub use file_assets::FileAssets;
pub use mesh_error::{MeshError, Place};
pub use search_path::SearchPath;

use etalon_images::lfs_pointer;
use etalon_params::Diagnostic;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// What the names of pbrt's scenes end in.
const PBRT: &[&str] = &[".pbrt", ".pbrt.gz"];

/// What those of glTF end in.
const GLTF: &[&str] = &[".gltf", ".glb"];

/// Whether the name of a file is that of a scene.
pub fn is_scene(path: &Path) -> bool {
    is_pbrt(path) || is_gltf(path) || has_ending(path, &[".xml"])
}

/// What the names of scenes end in, for messages.
pub fn scene_endings() -> String {
    let all = [&[".xml"], PBRT, GLTF].concat();
    all.join(", ")
}

fn is_pbrt(path: &Path) -> bool {
    has_ending(path, PBRT)
}

fn is_gltf(path: &Path) -> bool {
    has_ending(path, GLTF)
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let name = path.to_string_lossy().to_ascii_lowercase();
    endings.iter().any(|ending| name.ends_with(ending))
}

/// Reads a scene in the language that the name of its file tells: pbrt's for `.pbrt` and `.pbrt.gz`, glTF for `.gltf` and `.glb`, else Mitsuba's XML.
pub fn read(path: &Path, options: &ReadOptions) -> ReadOutcome {
    if is_gltf(path) {
        return read_gltf(path, options);
    }
    let mut outcome = match is_pbrt(path) {
        true => pbrt::read(path, options),
        false => mitsuba::read(path, options),
    };
    if let Some(environment) = &options.environment {
        let message = format!(
            "the surroundings `{}` are for scenes of glTF: this one says itself what lights it",
            environment.display()
        );
        outcome.diagnostics.push(Diagnostic::error_nowhere(message));
    }
    outcome
}

#[cfg(feature = "gltf")]
fn read_gltf(path: &Path, options: &ReadOptions) -> ReadOutcome {
    gltf::read(path, options)
}

#[cfg(not(feature = "gltf"))]
fn read_gltf(path: &Path, _: &ReadOptions) -> ReadOutcome {
    let message = format!(
        "`{}`: this program was built without the feature `gltf`",
        path.display()
    );
    ReadOutcome {
        sources: Default::default(),
        diagnostics: vec![Diagnostic::error_nowhere(message)],
        document: None,
        stand_ins: Vec::new(),
    }
}

/// The bytes of a regular file of at most `limit` bytes, or why they cannot be had.
pub(crate) fn read_bounded(path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let length = bounded_length(path, limit)?;
    let mut bytes = Vec::with_capacity(length as usize);
    File::open(path)
        .and_then(|file| file.take(limit).read_to_end(&mut bytes))
        .map_err(reason)?;
    Ok(bytes)
}

/// A regular file of at most `limit` bytes, to read from here and there.
pub(crate) fn open_bounded(path: &Path, limit: u64) -> Result<BufReader<File>, String> {
    bounded_length(path, limit)?;
    File::open(path).map(BufReader::new).map_err(reason)
}

fn reason(error: std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => error.to_string(),
    }
}

/// How many bytes a regular file has, if they are at most `limit`.
fn bounded_length(path: &Path, limit: u64) -> Result<u64, String> {
    let metadata = std::fs::metadata(path).map_err(reason)?;
    if metadata.is_dir() {
        return Err("it is a folder".to_owned());
    }
    if !metadata.is_file() {
        return Err("it is not a regular file".to_owned());
    }
    if metadata.len() > limit {
        return Err(format!(
            "it has {} bytes, more than the {limit} that are accepted",
            metadata.len()
        ));
    }
    // What git keeps in place of a large file is some 130 bytes.
    if metadata.len() < 1024
        && let Ok(bytes) = std::fs::read(path)
        && let Some(pointer) = lfs_pointer(&bytes)
    {
        return Err(pointer.to_owned());
    }
    Ok(metadata.len())
}
