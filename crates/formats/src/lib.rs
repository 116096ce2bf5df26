//! Files in: Mitsuba XML, OBJ, PLY.
//!
//! [`mitsuba`] turns a scene file into the description tree; [`FileAssets`] finds and reads the
//! files that a scene refers to. Nothing here trusts a file: sizes are checked before memory is
//! asked for, and a broken file is a message, never a panic.

mod file_assets;
mod mesh_error;
pub mod mitsuba;
pub mod obj;
pub mod ply;
mod polygon;
mod search_path;

pub use file_assets::FileAssets;
pub use mesh_error::{MeshError, Place};
pub use search_path::SearchPath;

use std::io::Read;
use std::path::Path;

/// The bytes of a regular file of at most `limit` bytes, or why they cannot be had.
pub(crate) fn read_bounded(path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let reason = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => error.to_string(),
    };
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
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    std::fs::File::open(path)
        .and_then(|file| file.take(limit).read_to_end(&mut bytes))
        .map_err(reason)?;
    Ok(bytes)
}
