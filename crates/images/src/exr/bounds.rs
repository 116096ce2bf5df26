//! What a file may ask for, given its length.
//!
//! A header of a hundred bytes can declare an image of exabytes, and a tile of gigabytes in a
//! tiny image. Nothing is allocated for pixels before these limits have been checked:
//!
//! - every chunk takes at least 16 bytes of the file (its offset, its place and its size), so a
//!   file with fewer than 16 bytes per declared chunk is truncated;
//! - no block holds more than 256 MiB;
//! - all samples together take no more than 256 MiB as 32-bit floats, or else no more than 1,100
//!   times the file's length (the best DEFLATE can do is 1,032);
//! - the counts at the head of a DWA chunk, for which its decoder allocates memory, fit the block.

use super::header::failure;
use crate::Error;
use ::exr::block::chunk::{Chunk, CompressedBlock};
use ::exr::meta::attribute::{Compression, LevelMode};
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

/// The greatest count a DWA chunk of a block of `bytes` may declare: coefficients come in blocks of
/// 8 × 8, runs at most double what they hold.
fn dwa_limit(bytes: u128, channels: u128) -> u128 {
    4 * bytes + 4096 * channels
}

/// Checks the chunks against the headers, before they are decompressed.
pub(super) fn check_chunks(path: &Path, headers: &[Header], chunks: &[Chunk]) -> Result<(), Error> {
    for chunk in chunks {
        let Some(header) = headers.get(chunk.layer_index) else {
            return Err(Error::invalid(path, "a block belongs to no part"));
        };
        if !matches!(
            header.compression,
            Compression::DWAA(_) | Compression::DWAB(_)
        ) {
            continue;
        }
        let data = match &chunk.compressed_block {
            CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
            CompressedBlock::Tile(block) => &block.compressed_pixels_le,
            _ => continue,
        };
        // A block that does not compress is stored as it is, without counts.
        let pixels = header
            .get_block_data_indices(&chunk.compressed_block)
            .and_then(|at| header.get_absolute_block_pixel_coordinates(at))
            .map_err(|error| failure(path, error))?
            .size
            .area();
        if data.len() == pixels * header.channels.bytes_per_pixel {
            continue;
        }
        let limit = dwa_limit(block_bytes(header), header.channels.list.len() as u128);
        let counts = data.chunks_exact(8).take(10).skip(1);
        for count in counts {
            let count = count
                .iter()
                .rev()
                .fold(0, |n, &byte| (n << 8) | u128::from(byte));
            if count > limit {
                return Err(Error::invalid(path, "a DWA block declares too many values"));
            }
        }
    }
    Ok(())
}

/// Bytes of a whole block as 32-bit floats.
fn block_bytes(header: &Header) -> u128 {
    let pixels = match header.blocks {
        BlockDescription::ScanLines => {
            header.layer_size.width() as u128 * header.compression.scan_lines_per_block() as u128
        }
        BlockDescription::Tiles(tiles) => {
            tiles.tile_size.width() as u128 * tiles.tile_size.height() as u128
        }
    };
    pixels * header.channels.list.len() as u128 * 4
}

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
        let block = block_bytes(header);
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
