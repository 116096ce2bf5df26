//! What is wrong with the JSON: its syntax, and what the schema forbids.

use super::reader::Reader;
use ::gltf::Semantic;
use ::gltf::json::validation::{Checked, Error, Validate};
use ::gltf::json::{Path, Root};
use etalon_params::{Diagnostic, FileId, Span};

const NO_SUCH: &str = "there is nothing of this number";

/// Reads the JSON.
pub(crate) fn parse(text: &str, file: FileId) -> Result<Root, Diagnostic> {
    ::gltf::json::deserialize::from_str(text).map_err(|error| {
        let message = error.to_string();
        // The place has a column of its own in front of the message.
        let message = message
            .rsplit_once(" at line ")
            .map_or(message.as_str(), |(message, _)| message);
        let message = format!("the JSON cannot be read as glTF: {message}");
        match offset(text, error.line(), error.column()) {
            Some(start) => {
                let end = start;
                Diagnostic::error(Span { file, start, end }, message)
            }
            None => Diagnostic::error_nowhere(message),
        }
    })
}

/// The byte at a line and a column, both counted from 1, the latter in bytes; `None` if there is no such line.
fn offset(text: &str, line: usize, column: usize) -> Option<u32> {
    let before = line.checked_sub(1)?;
    let start: usize = text.split_inclusive('\n').take(before).map(str::len).sum();
    let mut at = (start + column.saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    u32::try_from(at).ok()
}

/// Reports what the schema forbids.
pub(crate) fn validate(reader: &Reader<'_>) {
    let root = reader.root;
    // The crate looks these up before it has checked them.
    if has_unknown_positions(reader) {
        return;
    }
    root.validate(root, Path::new, &mut |path, error| {
        let path = path();
        let path = path.as_str();
        // The bounds of positions are for those who do not read them; required extensions have a judge of their own.
        let bounds = path.ends_with(".min") || path.ends_with(".max");
        if bounds || path.starts_with("extensionsRequired") {
            return;
        }
        let message = match error {
            Error::IndexOutOfBounds => NO_SUCH,
            Error::Invalid => "this is none of the values that glTF has here",
            Error::Missing => "this is missing",
            Error::Oversize => "this is too large a number",
            Error::Unsupported => "this is not supported",
        };
        reader.error(path, message);
    });
}

/// Reports positions of which there is no accessor.
fn has_unknown_positions(reader: &Reader<'_>) -> bool {
    let root = reader.root;
    let mut found = false;
    for (i, mesh) in root.meshes.iter().enumerate() {
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let positions = primitive
                .attributes
                .get(&Checked::Valid(Semantic::Positions));
            if positions.is_some_and(|index| root.get(*index).is_none()) {
                let path = format!("meshes[{i}].primitives[{j}].attributes.POSITION");
                reader.error(&path, NO_SUCH);
                found = true;
            }
        }
    }
    found
}
