//! From a file to its text: gzip, byte order marks, and bytes that are no text.

use flate2::read::MultiGzDecoder;
use std::io::Read;
use std::path::Path;

/// The longest text that is read; a span reaches twice as far.
pub(crate) const MOST_BYTES: u64 = 2 << 30;

/// The text of a scene file, or why it cannot be had.
///
/// Only the comments of old scenes have characters outside of ASCII that are not UTF-8; those become `U+FFFD`.
pub(crate) fn read(path: &Path) -> Result<String, String> {
    let bytes = crate::read_bounded(path, MOST_BYTES)?;
    let bytes = match bytes.starts_with(b"\x1f\x8b") {
        true => decompressed(&bytes, MOST_BYTES)?,
        false => bytes,
    };
    text_of(bytes)
}

fn decompressed(bytes: &[u8], limit: u64) -> Result<Vec<u8>, String> {
    let mut result = Vec::new();
    MultiGzDecoder::new(bytes)
        .take(limit + 1)
        .read_to_end(&mut result)
        .map_err(|error| format!("the gzip data is broken: {error}"))?;
    if result.len() as u64 > limit {
        return Err(format!(
            "it has more than the {limit} bytes that are accepted, decompressed"
        ));
    }
    Ok(result)
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
    use flate2::{Compression, write::GzEncoder};
    use std::io::Write;

    fn compressed(text: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(text).expect("written");
        encoder.finish().expect("finished")
    }

    #[test]
    fn compressed_files_are_bounded() {
        let mut twice = compressed(b"Shape");
        twice.extend(compressed(b" \"sphere\""));
        assert_eq!(
            decompressed(&twice, 14).as_deref(),
            Ok(&b"Shape \"sphere\""[..])
        );
        let long = decompressed(&twice, 13).expect_err("too long");
        assert!(long.starts_with("it has more than the 13 bytes"), "{long}");
        let cut = decompressed(&twice[..20], 14).expect_err("cut");
        assert!(cut.starts_with("the gzip data is broken"), "{cut}");
    }

    #[test]
    fn encodings() {
        let text = |bytes: &[u8]| text_of(bytes.to_vec());
        assert_eq!(text(b"\xef\xbb\xbfa").as_deref(), Ok("a"));
        assert_eq!(text(b"# caf\xe9").as_deref(), Ok("# caf\u{fffd}"));
        assert!(text(b"\xff\xfea\0").is_err());
    }
}
