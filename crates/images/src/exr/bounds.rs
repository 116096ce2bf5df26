//! What a file may ask for, given its length.
//!
//! A header of a hundred bytes can declare an image of exabytes, and a tile of gigabytes in a
//! tiny image. Nothing is allocated for pixels before these limits have been checked:
//!
//! - every chunk takes at least 16 bytes of the file (its offset, its place and its size), so a
//!   file with fewer than 16 bytes per declared chunk is truncated;
//! - no block holds more than 256 MiB;
//! - all samples together take no more than 256 MiB as 32-bit floats, or else no more than 1,100
//!   times the file's length (the best DEFLATE can do is 1,032).

use crate::Error;
use ::exr::meta::attribute::LevelMode;
use ::exr::meta::{BlockDescription, header::Header};
use std::path::Path;

/// Bytes of one block of pixels.
const MAX_BLOCK: u128 = 1 << 28;
/// Bytes of all pixels of a file of any length.
const ALWAYS: u128 = 1 << 28;
/// Bytes of pixels per byte of the file.
const RATIO: u128 = 1100;
/// Bytes of the file per chunk.
const CHUNK: u128 = 16;

/// Checks all that the headers declare against the length of the file, and that it is something
/// that can be read at all.
pub(super) fn check(path: &Path, headers: &[Header], file_length: usize) -> Result<(), Error> {
    let file_length = file_length as u128;
    let (mut all, mut chunks) = (0, 0);
    for header in headers {
        if header.deep {
            return Err(Error::unsupported(
                path,
                "deep EXR images are not supported",
            ));
        }
        let unit = |channel: &::exr::meta::attribute::ChannelDescription| {
            channel.sampling.x() == 1 && channel.sampling.y() == 1
        };
        if !header.channels.list.iter().all(unit) {
            return Err(Error::unsupported(
                path,
                "subsampled EXR channels are not supported; write every channel at full size",
            ));
        }
        let (width, height) = (
            header.layer_size.width() as u128,
            header.layer_size.height() as u128,
        );
        let channels = header.channels.list.len() as u128;
        if width == 0 || height == 0 || channels == 0 {
            return Err(Error::invalid(
                path,
                "it has a part without pixels or channels",
            ));
        }
        let block = match header.blocks {
            BlockDescription::ScanLines => {
                width * header.compression.scan_lines_per_block() as u128
            }
            BlockDescription::Tiles(tiles) => {
                tiles.tile_size.width() as u128 * tiles.tile_size.height() as u128
            }
        } * channels
            * 4;
        if block > MAX_BLOCK {
            return Err(Error::too_large(
                path,
                format!("a block of {block} bytes; at most {MAX_BLOCK} are accepted"),
            ));
        }
        // Further resolutions are skipped, but pass through memory one block at a time.
        let levels = match header.blocks {
            BlockDescription::Tiles(tiles) if tiles.level_mode != LevelMode::Singular => 4,
            _ => 1,
        };
        all += width * height * channels * 4 * levels;
        chunks += header.chunk_count as u128;
    }
    if chunks * CHUNK > file_length {
        return Err(Error::invalid(
            path,
            format!("it declares {chunks} blocks of pixels, but has only {file_length} bytes"),
        ));
    }
    if all > ALWAYS.max(RATIO * file_length) {
        return Err(Error::too_large(
            path,
            format!("{all} bytes of pixels in a file of {file_length} bytes"),
        ));
    }
    Ok(())
}
