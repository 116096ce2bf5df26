//! Reading EXR files, pixels and all.

use super::{Document, IntegerPlane, Part, bounds, header};
use crate::{Error, Image};
use ::exr::block::chunk::Chunk;
use ::exr::block::lines::LineRef;
use ::exr::block::reader::Reader;
use ::exr::block::{BlockIndex, UncompressedBlock};
use ::exr::error::UnitResult;
use ::exr::meta::attribute::SampleType;
use ::exr::meta::{MetaData, header::Header};
use ::exr::prelude::f16;
use std::collections::HashSet;
use std::io::Cursor;
use std::path::Path;
use std::sync::Mutex;

/// Reads a file.
///
/// # Errors
/// [`Error::Read`] where the operating system refuses; otherwise as [`decode`].
pub fn read(path: &Path) -> Result<Document, Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::read(path, source))?;
    decode(&bytes, path)
}

/// Reads a file's bytes; `path` is only for messages.
///
/// All samples become 32-bit floats: 16-bit floats exactly, integers to the nearest.
///
/// # Errors
/// [`Error::Invalid`] where the file is damaged or pixels are missing, [`Error::Unsupported`]
/// for deep or subsampled images and unknown compressions, [`Error::TooLarge`] where it declares
/// more than its length can justify.
pub fn decode(bytes: &[u8], path: &Path) -> Result<Document, Error> {
    decode_apart(bytes, path, None).map(|(document, _)| document)
}

/// As [`read`], but channels of whole numbers whose names begin with `prefix` come apart, as
/// they are.
///
/// # Errors
/// As [`read`].
pub fn read_with_integers(
    path: &Path,
    prefix: &str,
) -> Result<(Document, Vec<IntegerPlane>), Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::read(path, source))?;
    decode_with_integers(&bytes, path, prefix)
}

/// As [`read_with_integers`], of a file's bytes; `path` is only for messages.
///
/// # Errors
/// As [`decode`].
pub fn decode_with_integers(
    bytes: &[u8],
    path: &Path,
    prefix: &str,
) -> Result<(Document, Vec<IntegerPlane>), Error> {
    decode_apart(bytes, path, Some(prefix))
}

fn decode_apart(
    bytes: &[u8],
    path: &Path,
    prefix: Option<&str>,
) -> Result<(Document, Vec<IntegerPlane>), Error> {
    // The header alone comes first: nothing large may be allocated before it has been judged.
    let meta = header::metadata_of_bytes(bytes, path)?;
    bounds::check(path, &meta.headers, bytes.len())?;

    let chunks = Reader::read_from_buffered(Cursor::new(bytes), false)
        .and_then(|reader| reader.all_chunks(false)?.collect::<Result<Vec<_>, _>>())
        .map_err(|error| header::failure(path, error))?;
    bounds::check_chunks(path, &meta.headers, &chunks)?;

    let mut planes: Vec<Planes> = (meta.headers.iter())
        .map(|header| Planes::new(header, prefix))
        .collect();
    decompress(&meta, chunks, |block| {
        let layer = block.index.layer;
        planes[layer].insert(&meta.headers[layer], &block)
    })
    .map_err(|error| header::failure(path, error))?;

    let mut parts = Vec::with_capacity(planes.len());
    let mut integers = Vec::new();
    for (planes, header) in planes.into_iter().zip(&meta.headers) {
        if planes.missing > 0 {
            return Err(Error::invalid(
                path,
                format!("{} of its pixels are missing", planes.missing),
            ));
        }
        parts.push(Part {
            name: header.own_attributes.layer_name.as_ref().map(header::utf8),
            image: planes.into_image(header, path, &mut integers)?,
            offset: header::offset(header),
        });
    }
    let document = Document {
        parts,
        size: header::size(&meta),
        text: header::text(&meta),
    };
    Ok((document, integers))
}

/// Files with up to this many samples are decompressed by one thread.
const SMALL: usize = 1 << 20;

/// Decompresses the chunks, on several threads if there is much to do, and hands each block to
/// `insert`, in any order.
///
/// The decoder may panic on damaged data (its arithmetic overflows where that is checked). Such a
/// panic ends its thread, not the process, and becomes an error.
fn decompress(
    meta: &MetaData,
    chunks: Vec<Chunk>,
    mut insert: impl FnMut(UncompressedBlock) -> UnitResult,
) -> UnitResult {
    let samples: usize = meta
        .headers
        .iter()
        .map(|header| header.layer_size.area() * header.channels.list.len())
        .sum();
    let threads = if samples <= SMALL {
        1
    } else {
        std::thread::available_parallelism().map_or(1, |n| n.get().min(16))
    };
    let chunks = Mutex::new(chunks.into_iter());
    let take = || chunks.lock().ok()?.next();
    let (sender, receiver) = std::sync::mpsc::sync_channel(2 * threads);
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|_| {
                let sender = sender.clone();
                scope.spawn(move || {
                    while let Some(chunk) = take() {
                        let block = UncompressedBlock::decompress_chunk(chunk, meta, false);
                        if sender.send(block).is_err() {
                            return;
                        }
                    }
                })
            })
            .collect();
        drop(sender);
        let inserted = receiver.into_iter().try_for_each(|block| insert(block?));
        // Join each: the panic of a thread that is not joined would propagate from the scope.
        let panics = workers
            .into_iter()
            .filter_map(|worker| worker.join().err())
            .count();
        if panics > 0 {
            return Err(::exr::error::Error::Invalid(
                "its compressed pixels are damaged".into(),
            ));
        }
        inserted
    })
}

/// The samples of a channel.
enum Samples {
    Floats(Vec<f32>),
    /// Of a channel that comes apart.
    Integers(Vec<u32>),
}

/// The channels of a part while they are read.
struct Planes {
    width: usize,
    height: usize,
    channels: Vec<Samples>,
    /// Pixels not read yet.
    missing: usize,
    /// Upper left pixels of the blocks read so far.
    seen: HashSet<(usize, usize)>,
}

impl Planes {
    fn new(header: &Header, prefix: Option<&str>) -> Self {
        let pixels = header.layer_size.area();
        let channels = header.channels.list.iter().map(|channel| {
            let apart = channel.sample_type == SampleType::U32
                && prefix.is_some_and(|p| channel.name.bytes().starts_with(p.as_bytes()));
            if apart {
                Samples::Integers(vec![0; pixels])
            } else {
                Samples::Floats(vec![0.0; pixels])
            }
        });
        Self {
            width: header.layer_size.width(),
            height: header.layer_size.height(),
            channels: channels.collect(),
            missing: pixels,
            seen: HashSet::new(),
        }
    }

    fn insert(&mut self, header: &Header, block: &UncompressedBlock) -> UnitResult {
        let BlockIndex {
            pixel_position: at,
            pixel_size: size,
            level,
            ..
        } = block.index;
        if level.x() != 0 || level.y() != 0 {
            return Ok(());
        }
        let invalid = |reason: &'static str| Err(::exr::error::Error::Invalid(reason.into()));
        let inside = |at: usize, size: usize, whole: usize| {
            at.checked_add(size).is_some_and(|end| end <= whole)
        };
        if !inside(at.x(), size.width(), self.width) || !inside(at.y(), size.height(), self.height)
        {
            return invalid("a block lies outside the image");
        }
        if block.data.len() != size.area() * header.channels.bytes_per_pixel {
            return invalid("a block has the wrong size");
        }
        if !self.seen.insert((at.x(), at.y())) {
            return invalid("a block occurs twice");
        }
        self.missing = self.missing.saturating_sub(size.area());
        for line in block.lines(&header.channels) {
            let place = line.location;
            let start = place.position.y() * self.width + place.position.x();
            let end = start + place.sample_count;
            match &mut self.channels[place.channel] {
                Samples::Floats(samples) => {
                    let stored = header.channels.list[place.channel].sample_type;
                    copy(line, stored, &mut samples[start..end])?;
                }
                Samples::Integers(samples) => {
                    line.read_samples_into_slice(&mut samples[start..end])?;
                }
            }
        }
        Ok(())
    }

    /// The floats; whole numbers that come apart are added to `integers`.
    fn into_image(
        self,
        header: &Header,
        path: &Path,
        integers: &mut Vec<IntegerPlane>,
    ) -> Result<Image, Error> {
        let part = header.own_attributes.layer_name.as_ref().map(header::utf8);
        let mut image = Image::new(self.width, self.height)
            .of_part(part.unwrap_or_default())
            .with_chromaticities(header::chromaticities(header));
        for (samples, channel) in self.channels.into_iter().zip(&header.channels.list) {
            let name = header::utf8(&channel.name);
            let taken =
                image.channel(&name).is_some() || integers.iter().any(|plane| plane.name == name);
            if taken {
                return Err(Error::invalid(
                    path,
                    format!("it has two channels called {name:?}"),
                ));
            }
            match samples {
                Samples::Floats(samples) => image.push(name, samples),
                Samples::Integers(samples) => integers.push(IntegerPlane { name, samples }),
            }
        }
        Ok(image)
    }
}

/// Copies a row of samples, converting them to floats.
fn copy(line: LineRef<'_>, sample_type: SampleType, target: &mut [f32]) -> UnitResult {
    match sample_type {
        SampleType::F32 => return line.read_samples_into_slice(target),
        SampleType::F16 => {
            for (target, sample) in target.iter_mut().zip(line.read_samples::<f16>()) {
                *target = sample?.to_f32();
            }
        }
        SampleType::U32 => {
            for (target, sample) in target.iter_mut().zip(line.read_samples::<u32>()) {
                *target = sample? as f32;
            }
        }
    }
    Ok(())
}
