//! Where the shapes of a `.serialized` file begin.
//!
//! The file ends with the offsets of all shapes (32 bits each in version 3, 64 in version 4; the first
//! is 0) and their number, 32 bits. Writers have got this wrong, by the other width or by bytes
//! that came to stand behind, so an offset is believed if it leads to a header. Where none does,
//! the shapes are counted from the beginning of the file, each as long as its stream.

use super::{at, failed, header};
use crate::mesh_error::MeshError;
use flate2::bufread::ZlibDecoder;
use std::io::{BufRead, Read, Seek, SeekFrom};

/// Where the shape `index`, which is not 0, begins in a file of `length` bytes.
pub(super) fn find<R: BufRead + Seek>(
    file: &mut R,
    length: u64,
    index: u32,
    notes: &mut Vec<String>,
) -> Result<u64, MeshError> {
    let widths = match header(file, 0)? {
        3 => [4, 8],
        _ => [8, 4],
    };
    for width in widths {
        match looked_up(file, length, index, width) {
            Some(Ok(offset)) => return Ok(offset),
            Some(Err(count)) => return Err(out_of_range(index, count)),
            None => {}
        }
    }
    let offset = counted(file, index)?;
    notes.push(
        "the dictionary at the end of the file is damaged; \
         its shapes were counted from the beginning"
            .into(),
    );
    Ok(offset)
}

fn out_of_range(index: u32, count: u32) -> MeshError {
    let held = match count {
        1 => "1 shape, 0".to_owned(),
        _ => format!("{count} shapes, 0 to {}", count.saturating_sub(1)),
    };
    at(0, format!("there is no shape {index}: the file has {held}"))
}

/// What the dictionary says, if it is one with entries of `width` bytes (4 or 8): the offset, or how
/// many shapes there are where they are too few.
fn looked_up<R: BufRead + Seek>(
    file: &mut R,
    length: u64,
    index: u32,
    width: usize,
) -> Option<Result<u64, u32>> {
    let end = length.checked_sub(4)?;
    file.seek(SeekFrom::Start(end)).ok()?;
    let count = number(file, 4)? as u32;
    let start = end.checked_sub(u64::from(count) * width as u64)?;
    file.seek(SeekFrom::Start(start)).ok()?;
    let mut previous = None;
    let mut wanted = None;
    for i in 0..count {
        let offset = number(file, width)?;
        // Halves of wider entries, or pairs of narrower ones, do not rise from 0.
        if previous.map_or(offset != 0, |previous| offset <= previous) {
            return None;
        }
        previous = Some(offset);
        if i <= index {
            wanted = Some(offset);
        }
    }
    header(file, wanted?).ok()?;
    match wanted {
        Some(offset) if index < count => Some(Ok(offset)),
        _ => Some(Err(count)),
    }
}

/// The next number, of `width` bytes.
fn number<R: Read>(file: &mut R, width: usize) -> Option<u64> {
    let mut bytes = [0; 8];
    file.read_exact(&mut bytes[..width]).ok()?;
    Some(u64::from_le_bytes(bytes))
}

/// Goes through the streams of all shapes before the one that is wanted.
fn counted<R: BufRead + Seek>(file: &mut R, index: u32) -> Result<u64, MeshError> {
    let mut start = 0;
    for before in 0..index {
        if before > 0 && header(file, start).is_err() {
            return Err(out_of_range(index, before));
        }
        file.seek(SeekFrom::Start(start + 4))
            .map_err(|e| failed(start, &e))?;
        let mut stream = ZlibDecoder::new(&mut *file);
        std::io::copy(&mut stream, &mut std::io::sink()).map_err(|e| failed(start, &e))?;
        start += 4 + stream.total_in();
    }
    match header(file, start) {
        Ok(_) => Ok(start),
        Err(_) => Err(out_of_range(index, index)),
    }
}
