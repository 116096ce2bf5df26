//! From a file to its text: byte order marks, and bytes that are no text.

use crate::gzip;
use std::path::Path;

/// The longest text that is read; a span reaches twice as far.
pub(crate) const MOST_BYTES: u64 = 2 << 30;

/// The text of a scene file, or why it cannot be had.
///
/// Only the comments of old scenes have characters outside of ASCII that are not UTF-8; those become `U+FFFD`.
pub(crate) fn read(path: &Path) -> Result<String, String> {
    let bytes = crate::read_bounded(path, MOST_BYTES)?;
    text_of(gzip::plain(bytes, MOST_BYTES)?)
}

fn text_of(mut bytes: Vec<u8>) -> Result<String, String> {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err("it is encoded in UTF-16; pbrt and this program read UTF-8".to_owned());
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
    }
    Ok(String::from_utf8(bytes)
        .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings() {
        let text = |bytes: &[u8]| text_of(bytes.to_vec());
        assert_eq!(text(b"\xef\xbb\xbfa").as_deref(), Ok("a"));
        assert_eq!(text(b"# caf\xe9").as_deref(), Ok("# caf\u{fffd}"));
        assert!(text(b"\xff\xfea\0").is_err());
    }
}
