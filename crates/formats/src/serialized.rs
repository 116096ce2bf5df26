//! Meshes in Mitsuba's `.serialized` files, versions 3 and 4.
//!
//! A file holds one or more shapes, each a header (`0x041C` and the version, 16 bits each) and a
//! zlib stream, and ends with a dictionary of the places where they begin (see `dictionary.rs`).
//! Everything is little-endian. In the stream stand
//!
//! ```text
//! flags u32 | name (version 4; UTF-8, ends with 0) | vertices u64 | triangles u64 |
//! positions 3·V | normals 3·V | texture coordinates 2·V | colours 3·V | corners u32, 3·T
//! ```
//!
//! where the flags say which of the optional arrays are there, and whether the numbers are single or
//! double precision. Colours become the attribute `vertex_color`. What follows the corners is not
//! looked at, nor is the name.
//!
//! Counts are not believed: memory grows as bytes arrive, and a shape that claims to unfold into far more
//! than the file could hold is refused before anything is unfolded.

mod dictionary;

use crate::mesh_error::{MeshError, Place};
use crate::unused;
use etalon_transport::{Attribute, MeshData};
use flate2::bufread::ZlibDecoder;
use glam::{Vec2, Vec3};
use std::io::{BufRead, ErrorKind, Read, Seek, SeekFrom};

/// What every shape begins with.
pub const MAGIC: u16 = 0x041c;

const HAS_NORMALS: u32 = 0x0001;
const HAS_TEXTURE_COORDINATES: u32 = 0x0002;
const HAS_COLOURS: u32 = 0x0008;
const FACE_NORMALS: u32 = 0x0010;
const DOUBLE_PRECISION: u32 = 0x2000;

/// The longest name of a shape, in bytes.
const LONGEST_NAME: usize = 1 << 16;

/// How many bytes are unfolded at once; a multiple of the size of every element.
const CHUNK: usize = 3 * (1 << 14);

/// Shapes that unfold to more bytes than this must not be folded tighter than [`TIGHTEST`].
const LARGE: u64 = 64 << 20;

/// The most bytes, of a large shape, for one in the file. Grids of planes reach 10; deflate ends at 1032.
const TIGHTEST: u64 = 64;

/// Reads the mesh with this number, counted from 0.
pub fn read<R: BufRead + Seek>(file: &mut R, shape_index: u32) -> Result<MeshData, MeshError> {
    let length = file.seek(SeekFrom::End(0)).map_err(|e| failed(0, &e))?;
    header(file, 0)?;
    let mut notes = Vec::new();
    let start = match shape_index {
        0 => 0,
        index => dictionary::find(file, length, index, &mut notes)?,
    };
    let version = header(file, start)?;
    let stream = Stream {
        unfolded: ZlibDecoder::new(file),
        start,
        double: false,
    };
    stream.mesh(version, length - start, notes)
}

/// The version of the shape that begins at byte `start`; leaves the file at its stream.
fn header<R: Read + Seek>(file: &mut R, start: u64) -> Result<u16, MeshError> {
    let mut head = [0; 4];
    file.seek(SeekFrom::Start(start))
        .and_then(|_| file.read_exact(&mut head))
        .map_err(|e| failed(start, &e))?;
    let [a, b, c, d] = head;
    let (magic, version) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]));
    if magic != MAGIC {
        return Err(at(
            start,
            format!("this is no serialized mesh: it begins with {magic:#06x}, not {MAGIC:#06x}"),
        ));
    }
    if !(3..=4).contains(&version) {
        return Err(at(
            start,
            format!("version {version} of serialized meshes is not known, only 3 and 4 are"),
        ));
    }
    Ok(version)
}

fn at(byte: u64, message: String) -> MeshError {
    MeshError::new(Place::Byte(byte as usize), message)
}

fn failed(byte: u64, error: &std::io::Error) -> MeshError {
    match error.kind() {
        ErrorKind::UnexpectedEof => at(byte, "the file ends too early".into()),
        _ => at(byte, error.to_string()),
    }
}

/// The unfolded bytes of a shape.
struct Stream<R> {
    unfolded: ZlibDecoder<R>,
    /// Where the shape begins in the file.
    start: u64,
    /// Whether numbers have 64 bits.
    double: bool,
}

impl<R: BufRead> Stream<R> {
    fn mesh(
        mut self,
        version: u16,
        folded: u64,
        notes: Vec<String>,
    ) -> Result<MeshData, MeshError> {
        let flags = u32::from_le_bytes(self.array("flags")?);
        self.double = flags & DOUBLE_PRECISION != 0;
        let has = |flag: u32| flags & flag != 0;
        if version >= 4 {
            self.skip_name()?;
        }
        let vertices = u64::from_le_bytes(self.array("counts")?);
        let triangles = u64::from_le_bytes(self.array("counts")?);
        let numbers = [
            (3, true),
            (3, has(HAS_NORMALS)),
            (2, has(HAS_TEXTURE_COORDINATES)),
            (3, has(HAS_COLOURS)),
        ];
        let per_vertex: u64 = numbers.iter().map(|&(n, has)| n * u64::from(has)).sum();
        self.check_counts(vertices, triangles, per_vertex, folded)?;

        let positions = self.vectors(vertices, "positions", Vec3::from_array)?;
        let mut mesh = MeshData {
            positions,
            face_normals: has(FACE_NORMALS),
            notes,
            ..MeshData::default()
        };
        if has(HAS_NORMALS) {
            mesh.normals = self.vectors(vertices, "normals", Vec3::from_array)?;
        }
        if has(HAS_TEXTURE_COORDINATES) {
            mesh.uvs = self.vectors(vertices, "texture coordinates", Vec2::from_array)?;
        }
        if has(HAS_COLOURS) {
            let colours: Vec<[f32; 3]> = self.vectors(vertices, "colours", |c| c)?;
            mesh.attributes.push(Attribute {
                name: "vertex_color".into(),
                channels: 3,
                values: colours.into_flattened(),
            });
        }
        mesh.triangles = self.triangles(triangles, vertices)?;
        unused::settle(&mut mesh.positions, &mesh.triangles).map_err(|i| {
            at(
                self.start,
                format!("the position of vertex {i} is not finite"),
            )
        })?;
        Ok(mesh)
    }

    /// Refuses counts that no honest file has.
    fn check_counts(
        &self,
        vertices: u64,
        triangles: u64,
        per_vertex: u64,
        folded: u64,
    ) -> Result<(), MeshError> {
        if vertices > u64::from(u32::MAX) || triangles > u64::from(u32::MAX) {
            let message = format!(
                "{vertices} vertices and {triangles} triangles are more than 32 bits can count"
            );
            return Err(at(self.start, message));
        }
        let size = if self.double { 8 } else { 4 };
        let announced = vertices * per_vertex * size + triangles * 12;
        if announced > LARGE && announced / TIGHTEST > folded {
            let message = format!(
                "{vertices} vertices and {triangles} triangles are announced, \
                 but only {folded} bytes are left of the file"
            );
            return Err(at(self.start, message));
        }
        Ok(())
    }

    fn fill(&mut self, bytes: &mut [u8], what: &str) -> Result<(), MeshError> {
        self.unfolded.read_exact(bytes).map_err(|error| {
            let message = match error.kind() {
                ErrorKind::UnexpectedEof => format!("the data end before all {what} have come"),
                _ => format!("the {what} are damaged: {error}"),
            };
            at(self.start, message)
        })
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], MeshError> {
        let mut bytes = [0; N];
        self.fill(&mut bytes, what)?;
        Ok(bytes)
    }

    fn skip_name(&mut self) -> Result<(), MeshError> {
        for _ in 0..LONGEST_NAME {
            if self.array("letters of the name")? == [0] {
                return Ok(());
            }
        }
        Err(at(self.start, "the name of the shape does not end".into()))
    }

    /// Calls `each` with the bytes of `count` elements in turn, of `size` bytes each.
    fn elements(
        &mut self,
        count: u64,
        size: usize,
        what: &str,
        mut each: impl FnMut(&[u8]) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        let mut chunk = vec![0; CHUNK];
        let mut left = count;
        while left > 0 {
            let now = left.min((CHUNK / size) as u64);
            let bytes = &mut chunk[..now as usize * size];
            self.fill(bytes, what)?;
            bytes.chunks_exact(size).try_for_each(&mut each)?;
            left -= now;
        }
        Ok(())
    }

    fn vectors<T, const N: usize>(
        &mut self,
        count: u64,
        what: &str,
        make: impl Fn([f32; N]) -> T,
    ) -> Result<Vec<T>, MeshError> {
        let mut vectors = Vec::new();
        let (double, size) = (self.double, if self.double { 8 } else { 4 });
        self.elements(count, N * size, what, |bytes| {
            let numbers = match double {
                true => std::array::from_fn(|i| f64::from_le_bytes(part(bytes, i)) as f32),
                false => std::array::from_fn(|i| f32::from_le_bytes(part(bytes, i))),
            };
            vectors.push(make(numbers));
            Ok(())
        })?;
        Ok(vectors)
    }

    fn triangles(&mut self, count: u64, vertices: u64) -> Result<Vec<[u32; 3]>, MeshError> {
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        let start = self.start;
        self.elements(count, 12, "triangles", |bytes| {
            let corners = std::array::from_fn(|i| u32::from_le_bytes(part(bytes, i)));
            if let Some(&corner) = corners.iter().find(|&&c| u64::from(c) >= vertices) {
                let number = triangles.len();
                let message = format!(
                    "triangle {number} refers to vertex {corner}, but there are {vertices}"
                );
                return Err(at(start, message));
            }
            triangles.push(corners);
            Ok(())
        })?;
        Ok(triangles)
    }
}

/// The `i`-th group of N bytes.
#[inline]
fn part<const N: usize>(bytes: &[u8], i: usize) -> [u8; N] {
    bytes.as_chunks().0[i]
}

#[cfg(test)]
mod tests;
