//! The two forms of a file: JSON alone (`.gltf`), or JSON and a buffer in one binary file (`.glb`).
//!
//! A `.glb` has a header (magic, version, length) and chunks (length, type, data), the first of which is JSON; numbers are
//! little-endian (glTF 2.0, §4.4). Which form it is, the first bytes tell.

use std::borrow::Cow;

const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BINARY: &[u8] = b"BIN\0";

/// A file taken apart.
#[derive(Debug, PartialEq)]
pub(crate) struct Container<'a> {
    /// The description.
    pub(crate) json: Cow<'a, str>,
    /// The first buffer, if the file holds it.
    pub(crate) binary: Option<&'a [u8]>,
}

/// Takes a file apart, or says why not.
pub(crate) fn split(bytes: &[u8]) -> Result<Container<'_>, String> {
    if !bytes.starts_with(MAGIC) {
        let json = text(bytes)?;
        return Ok(Container { json, binary: None });
    }
    let version = number(bytes, 4).ok_or("the file ends within its header")?;
    if version != 2 {
        return Err(format!("version {version} of glTF is not read, only 2"));
    }
    let length = number(bytes, 8).ok_or("the file ends within its header")? as usize;
    let Some(whole) = bytes.get(..length) else {
        let there = bytes.len();
        return Err(format!(
            "the file should have {length} bytes, and has {there}"
        ));
    };
    let (kind, json, next) = chunk(whole, 12)?;
    if kind != JSON {
        return Err("the first chunk of the file is not JSON".to_owned());
    }
    let binary = match next < whole.len() {
        true => {
            let (kind, data, _) = chunk(whole, next)?;
            // Chunks of other types are to be ignored.
            (kind == BINARY).then_some(data)
        }
        false => None,
    };
    Ok(Container {
        json: text(json)?,
        binary,
    })
}

fn text(bytes: &[u8]) -> Result<Cow<'_, str>, String> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(Cow::Borrowed(text)),
        Err(error) => Err(format!(
            "the JSON is no UTF-8 text: byte {} is broken",
            error.valid_up_to()
        )),
    }
}

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

/// The type and the data of the chunk at `at`, and where the next begins.
fn chunk(bytes: &[u8], at: usize) -> Result<(&[u8], &[u8], usize), String> {
    let broken = || format!("the chunk at byte {at} goes beyond the end of the file");
    let length = number(bytes, at).ok_or_else(broken)? as usize;
    let start = at + 8;
    let end = start.checked_add(length).ok_or_else(broken)?;
    let kind = bytes.get(at + 4..start).ok_or_else(broken)?;
    let data = bytes.get(start..end).ok_or_else(broken)?;
    // Chunks begin at multiples of four.
    Ok((kind, data, end.next_multiple_of(4)))
}
