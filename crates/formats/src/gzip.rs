//! Files that may be compressed with gzip, which is known by how they begin.

use crate::open_bounded;
use flate2::read::MultiGzDecoder;
use std::io::{BufRead, Read};
use std::path::Path;

/// How compressed files begin.
const MAGIC: &[u8] = b"\x1f\x8b";

/// The contents of a file, decompressed to at most `limit` bytes, or why they cannot be had.
pub(crate) fn plain(bytes: Vec<u8>, limit: u64) -> Result<Vec<u8>, String> {
    if !bytes.starts_with(MAGIC) {
        return Ok(bytes);
    }
    let mut result = Vec::new();
    MultiGzDecoder::new(bytes.as_slice())
        .take(limit.saturating_add(1))
        .read_to_end(&mut result)
        .map_err(|error| format!("the gzip data is broken: {error}"))?;
    if result.len() as u64 > limit {
        return Err(format!(
            "it has more than the {limit} bytes that are accepted, decompressed"
        ));
    }
    Ok(result)
}

/// The first bytes of a file, at most `most`, or why they cannot be had.
pub(crate) fn head(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let mut file = open_bounded(path, u64::MAX)?;
    let is_compressed = file.fill_buf().is_ok_and(|bytes| bytes.starts_with(MAGIC));
    let mut head = Vec::new();
    let read = match is_compressed {
        true => MultiGzDecoder::new(file).take(most).read_to_end(&mut head),
        false => file.take(most).read_to_end(&mut head),
    };
    read.map(|_| head).map_err(|error| error.to_string())
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
            plain(twice.clone(), 14).as_deref(),
            Ok(&b"Shape \"sphere\""[..])
        );
        let long = plain(twice.clone(), 13).expect_err("too long");
        assert!(long.starts_with("it has more than the 13 bytes"), "{long}");
        let cut = plain(twice[..20].to_vec(), 14).expect_err("cut");
        assert!(cut.starts_with("the gzip data is broken"), "{cut}");
        assert_eq!(plain(b"Shape".to_vec(), 1).as_deref(), Ok(&b"Shape"[..]));
    }

    #[test]
    fn heads_are_decompressed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a");
        for bytes in [b"ply, and more".to_vec(), compressed(b"ply, and more")] {
            std::fs::write(&path, bytes).expect("written");
            assert_eq!(head(&path, 3).as_deref(), Ok(&b"ply"[..]));
        }
    }
}
