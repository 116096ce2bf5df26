//! Messages about mistakes in a line of an OBJ file.
//!
//! The parser returns only the kind of mistake that stopped it. This reads a line again, without
//! keeping anything of it, and names the offending word.

use super::lines::{Line, Lines};
use crate::mesh_error::MeshError;
use crate::nan::is_nan;

/// How many positions, texture coordinates and normals there are.
pub(super) type Counts = [usize; 3];

const NAMES: [&str; 3] = ["position", "texture coordinate", "normal"];

/// The list, of those in [`Counts`], to which a statement adds.
pub(super) fn list_of(keyword: &[u8]) -> Option<usize> {
    match keyword {
        b"v" => Some(0),
        b"vt" => Some(1),
        b"vn" => Some(2),
        _ => None,
    }
}

/// The first mistake in a file that belongs to a line, if there is one.
pub(super) fn first(bytes: &[u8]) -> Result<(), MeshError> {
    let mut all = Counts::default();
    each_line(bytes, |line, _| {
        count(line, &mut all);
        Ok(())
    })?;
    each_line(bytes, |line, given| check(line, given, all))
}

/// Visits all lines, each with the counts of elements before it.
fn each_line(
    bytes: &[u8],
    mut visit: impl FnMut(&Line<'_>, Counts) -> Result<(), MeshError>,
) -> Result<(), MeshError> {
    let mut given = Counts::default();
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.next_line() {
        visit(&line, given)?;
        count(&line, &mut given);
    }
    Ok(())
}

fn count(line: &Line<'_>, counts: &mut Counts) {
    if let Some(list) = line.words().next().and_then(list_of) {
        counts[list] += 1;
    }
}

/// Finds the mistake in a line, before which `given` things stand, of `all` in the file.
pub(super) fn check(line: &Line<'_>, given: Counts, all: Counts) -> Result<(), MeshError> {
    let mut words = line.words();
    match words.next() {
        Some(b"v") => {
            numbers(line, &mut words, 3, NAMES[0])?;
            if words.clone().count() >= 3 {
                numbers(line, &mut words, 3, "colour")?;
            }
        }
        Some(b"vt") => {
            numbers(line, &mut words, 1, NAMES[1])?;
            if words.clone().next().is_some() {
                numbers(line, &mut words, 1, NAMES[1])?;
            }
        }
        Some(b"vn") => numbers(line, &mut words, 3, NAMES[2])?,
        Some(b"f") => {
            for word in words {
                corner(line, word, given, all)?;
            }
        }
        _ => {}
    }
    Ok(())
}

fn numbers<'l>(
    line: &Line<'_>,
    words: &mut impl Iterator<Item = &'l [u8]>,
    count: usize,
    what: &str,
) -> Result<(), MeshError> {
    for _ in 0..count {
        let Some(word) = words.next() else {
            return Err(line.error(format!("a number of this {what} is missing")));
        };
        let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
        let nan = is_nan(word).then_some(f32::NAN);
        let number: f32 = parsed
            .or(nan)
            .ok_or_else(|| line.error(format!("`{}` is not a number", text(word))))?;
        // Normals and texture coordinates do without some numbers.
        if !number.is_finite() && what != NAMES[1] && what != NAMES[2] {
            return Err(line.error(format!("`{}` in this {what} is not finite", text(word))));
        }
    }
    Ok(())
}

/// Checks `position`, `position/uv`, `position//normal` or `position/uv/normal`.
fn corner(line: &Line<'_>, word: &[u8], given: Counts, all: Counts) -> Result<(), MeshError> {
    let parts = word.split(|&b| b == b'/');
    if word.starts_with(b"/") || parts.clone().count() > 3 {
        return Err(line.error(format!("`{}` is not a corner of a face", text(word))));
    }
    for (list, part) in parts.enumerate().filter(|(_, part)| !part.is_empty()) {
        let index = std::str::from_utf8(part).ok().and_then(|p| p.parse().ok());
        let index: i64 =
            index.ok_or_else(|| line.error(format!("`{}` is not an index", text(part))))?;
        let last = if index < 0 { given[list] } else { all[list] };
        if index == 0 || index.unsigned_abs() > last as u64 {
            return Err(line.error(format!(
                "the face refers to {} {index}, but {} are given so far",
                NAMES[list], given[list]
            )));
        }
    }
    Ok(())
}

fn text(word: &[u8]) -> String {
    let short: String = String::from_utf8_lossy(word).chars().take(40).collect();
    short.escape_debug().to_string()
}
