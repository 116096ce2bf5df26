//! NanoVDB files (version 32; K. Museth, NanoVDB: a GPU-friendly and portable VDB data structure for real-time rendering and
//! simulation, 2021): a grid of 32-bit floats, stored plainly or with zlib.
//!
//! A file has one header or more, each followed by 176 bytes and a name for every grid, then the grids. A grid is an image
//! of memory: 672 bytes about it, 64 about its tree, and nodes that refer to each other by offsets in bytes. The root has a table
//! of tiles of 4096³ values, an upper node one of 32³ tiles of 128³, a lower node one of 16³ tiles of 8³, and a leaf 8³ values. A
//! tile is a constant value, or a node. The result is dense: all values in the box of the active ones.
//!
//! Every offset is checked, and memory is allocated in proportion to the data.

use crate::pixels::Values;
use crate::vol_file::{self, VolFile, refuse_bad};
use flate2::read::ZlibDecoder;
use glam::{DAffine3, DMat3, DVec3, IVec3, UVec3};
use std::collections::HashMap;
use std::io::Read;

/// A table of nodes: the sides of its tiles (log₂), how many there are along each axis (log₂), and where masks and table lie.
struct Level {
    tile: u32,
    along: u32,
    children: usize,
    table: usize,
}

const UPPER: Level = Level {
    tile: 7,
    along: 5,
    children: 4128,
    table: 8256,
};
const LOWER: Level = Level {
    tile: 3,
    along: 4,
    children: 544,
    table: 1088,
};

/// Offset of the values in a leaf.
const LEAF_VALUES: usize = 96;

/// Lengths of what precedes the tree and the root's table, and of an entry of that (bytes).
const GRID: usize = 672;
const ROOT: usize = 64;
const ROOT_TILE: usize = 32;

/// As many values may be made of any file, …
const ALWAYS: u64 = 1 << 27;

/// … and of a large one so many for each of its bytes.
const PER_BYTE: u64 = 16;

/// The type of grids of 32-bit floats.
const FLOAT: u32 = 1;

/// Bytes that may end anywhere.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn array<const N: usize>(&self, at: usize) -> Result<[u8; N], String> {
        let found = self.0.get(at..).and_then(|rest| rest.first_chunk::<N>());
        let cut = || format!("it ends before byte {at}, of which it speaks");
        found.copied().ok_or_else(cut)
    }

    fn u32(&self, at: usize) -> Result<u32, String> {
        self.array(at).map(u32::from_le_bytes)
    }

    fn u64(&self, at: usize) -> Result<u64, String> {
        self.array(at).map(u64::from_le_bytes)
    }

    fn f32(&self, at: usize) -> Result<f32, String> {
        self.array(at).map(f32::from_le_bytes)
    }

    fn point(&self, at: usize) -> Result<DVec3, String> {
        let number = |i: usize| self.array(at + 8 * i).map(f64::from_le_bytes);
        Ok(DVec3::new(number(0)?, number(1)?, number(2)?))
    }

    fn corner(&self, at: usize) -> Result<IVec3, String> {
        let number = |i: usize| self.array(at + 4 * i).map(i32::from_le_bytes);
        Ok(IVec3::new(number(0)?, number(1)?, number(2)?))
    }

    /// The place of a node that lies `offset` bytes after another one.
    fn node(&self, from: usize, offset: u64) -> Result<usize, String> {
        let place = usize::try_from(offset)
            .ok()
            .and_then(|o| from.checked_add(o));
        let inside = place.filter(|place| *place < self.0.len());
        inside
            .ok_or_else(|| format!("a node lies {offset} bytes after byte {from}, beyond its end"))
    }

    fn slice(&self, at: usize, length: u64) -> Result<&'a [u8], String> {
        let end = usize::try_from(length).ok().and_then(|n| at.checked_add(n));
        let found = end.and_then(|end| self.0.get(at..end));
        found.ok_or_else(|| {
            format!(
                "it claims {length} bytes from byte {at}, and has {}",
                self.0.len()
            )
        })
    }
}

/// The header of a grid, and its stored bytes.
struct Stored<'a> {
    name: String,
    kind: u32,
    size: u64,
    codec: u16,
    /// The first and the last voxel in use.
    corners: [IVec3; 2],
    bytes: &'a [u8],
}

/// Whether these bytes begin like such a file.
pub fn is_nanovdb(bytes: &[u8]) -> bool {
    bytes.starts_with(b"NanoVDB")
}

/// The value type of a grid, by its number in files.
fn kind(number: u32) -> String {
    let known = match number {
        1 => "32-bit floats",
        2 => "64-bit floats",
        3..=5 | 22 | 23 => "integers",
        6 | 16..=18 => "vectors",
        7 => "vectors of 64-bit floats",
        8 | 21 => "a mask",
        9 | 13..=15 | 20 => "compressed floats",
        10 | 19 | 25 | 26 => "indices and points",
        _ => return format!("values of the type {number}"),
    };
    known.to_owned()
}

/// A summary of a file, one line for each grid.
///
/// # Errors
/// What is wrong with it.
pub fn summary(bytes: &[u8]) -> Result<String, String> {
    let (grids, _) = stored(&Bytes(bytes))?;
    let compression = |codec| match codec {
        0 => "not compressed",
        1 => "compressed with zip",
        2 => "compressed with Blosc",
        _ => "compressed in an unknown way",
    };
    let lines = grids.iter().map(|grid| {
        let [name, holds, how] = [&grid.name, &kind(grid.kind), compression(grid.codec)];
        let [low, high] = grid.corners;
        let side = |i: usize| i64::from(high[i]) - i64::from(low[i]) + 1;
        let size = [0, 1, 2].map(|i| side(i).to_string()).join(" × ");
        format!("grid         `{name}`: {holds}, {size} from {low}, {how}\n")
    });
    Ok(lines.collect())
}

/// Reads the grid called `name`, or the first one.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn read(bytes: &[u8], name: Option<&str>) -> Result<VolFile, String> {
    let (grids, behind) = stored(&Bytes(bytes))?;
    let names = || {
        let names: Vec<String> = grids.iter().map(|g| format!("`{}`", g.name)).collect();
        names.join(", ")
    };
    let grid = match name {
        Some(name) => (grids.iter().find(|grid| grid.name == name))
            .ok_or_else(|| format!("it has no grid `{name}`, but {}", names()))?,
        None => grids.first().ok_or("it has no grid")?,
    };
    if grid.kind != FLOAT {
        let floats = grids.iter().find(|grid| grid.kind == FLOAT);
        let instead = match floats {
            Some(other) => format!("`grid_name` chooses another, such as `{}`", other.name),
            None => format!("it has {}", names()),
        };
        return Err(format!(
            "its grid `{}` holds {}, and 32-bit floats are read; {instead}",
            grid.name,
            kind(grid.kind),
        ));
    }
    let read = match grid.codec {
        0 => dense(&Bytes(grid.bytes)),
        1 => dense(&Bytes(&inflated(grid)?)),
        2 => Err(
            "it is compressed with Blosc, and none or zip is read (`nanovdb_convert -z`)"
                .to_owned(),
        ),
        other => Err(format!(
            "it is compressed in a way that is not known ({other})"
        )),
    };
    let mut read = read?;
    if behind > 0 {
        read.notes.push(vol_file::behind(behind));
    }
    Ok(read)
}

/// All grids of a file, and how many bytes there are behind them.
fn stored<'a>(bytes: &Bytes<'a>) -> Result<(Vec<Stored<'a>>, usize), String> {
    // In the memory of a grid a checksum stands before the version.
    let is_32 = |at: usize| bytes.u32(at).is_ok_and(|word| word >> 21 == 32);
    if is_nanovdb(bytes.0) && !is_32(8) && is_32(16) {
        return Err(
            "it is the memory of a NanoVDB grid without the header of a file: `nanovdb::io::writeGrid` writes both"
                .to_owned(),
        );
    }
    let mut grids = Vec::new();
    let mut at = 0;
    while at < bytes.0.len() {
        if !is_nanovdb(&bytes.0[at..]) {
            if !grids.is_empty() {
                break;
            }
            return Err(format!("there is no `NanoVDB` at byte {at}"));
        }
        let version = bytes.u32(at + 8)? >> 21;
        if version != 32 {
            return Err(format!("it has version {version}, and 32 is read"));
        }
        let count = u16::from_le_bytes(bytes.array(at + 12)?);
        at += 16;
        let first = grids.len();
        let mut sizes = Vec::new();
        for _ in 0..count {
            let name = bytes.slice(at + 176, u64::from(bytes.u32(at + 136)?))?;
            let ends = name.iter().position(|c| *c == 0).unwrap_or(name.len());
            grids.push(Stored {
                name: String::from_utf8_lossy(&name[..ends]).into_owned(),
                kind: bytes.u32(at + 32)?,
                size: bytes.u64(at)?,
                codec: u16::from_le_bytes(bytes.array(at + 168)?),
                corners: [bytes.corner(at + 88)?, bytes.corner(at + 100)?],
                bytes: &[],
            });
            sizes.push(bytes.u64(at + 8)?);
            at += 176 + name.len();
        }
        for (grid, size) in grids[first..].iter_mut().zip(sizes) {
            // Programs differ in whether the 8 bytes with the compressed length are included.
            let size = match grid.codec {
                1 => {
                    at += 8;
                    bytes.u64(at - 8)?
                }
                _ => size,
            };
            grid.bytes = bytes.slice(at, size)?;
            at += grid.bytes.len();
        }
    }
    Ok((grids, bytes.0.len() - at))
}

/// A grid compressed with zlib.
fn inflated(grid: &Stored<'_>) -> Result<Vec<u8>, String> {
    let mut plain = Vec::new();
    let read = ZlibDecoder::new(grid.bytes)
        .take(grid.size)
        .read_to_end(&mut plain);
    read.map_err(|error| format!("its grid cannot be decompressed: {error}"))?;
    if plain.len() as u64 != grid.size {
        return Err(format!(
            "its grid has {} bytes, and claims {}",
            plain.len(),
            grid.size
        ));
    }
    Ok(plain)
}

/// All values in the box of a grid.
fn dense(grid: &Bytes<'_>) -> Result<VolFile, String> {
    let root = grid.node(GRID, grid.u64(GRID + 24)?)?;
    let [low, high] = [grid.corner(root)?, grid.corner(root + 12)?];
    let sides = [0, 1, 2].map(|i| i64::from(high[i]) - i64::from(low[i]) + 1);
    if sides.iter().any(|side| *side < 1) {
        return Err("its grid is empty".to_owned());
    }
    let count = sides
        .iter()
        .try_fold(1_u64, |n, side| n.checked_mul(*side as u64));
    let most = ALWAYS.max(grid.0.len() as u64 * PER_BYTE);
    if count.is_none_or(|count| count > most) {
        let [x, y, z] = sides;
        return Err(format!(
            "its box has {x} × {y} × {z} values, and at most {most} are made of {} bytes",
            grid.0.len()
        ));
    }
    let tree = Tree::read(grid, root)?;
    let size = UVec3::from_array(sides.map(|side| side as u32));
    let mut values = vec![0.0; size.as_usizevec3().element_product()];
    let [first, last]: [IVec3; 2] = [low >> 3, high >> 3];
    for z in first.z..=last.z {
        for y in first.y..=last.y {
            for x in first.x..=last.x {
                let block = IVec3::new(x, y, z) << 3;
                let found = tree.block(block)?;
                for i in 0..512 {
                    let at = block + IVec3::new(i >> 6, i >> 3 & 7, i & 7);
                    if at.cmpge(low).all() && at.cmple(high).all() {
                        let [x, y, z] = (at - low).as_usizevec3().to_array();
                        let place = (z * size.y as usize + y) * size.x as usize + x;
                        values[place] = match found {
                            Block::Even(value) => value,
                            Block::Leaf(leaf) => grid.f32(leaf + LEAF_VALUES + 4 * i as usize)?,
                        };
                    }
                }
            }
        }
    }
    let mut values = Values::One(values);
    let notes = refuse_bad(&mut values, size)?.into_iter().collect();
    // Rows of the matrix in double precision, and the translation.
    let map = 296 + 88;
    let rows = [
        grid.point(map)?,
        grid.point(map + 24)?,
        grid.point(map + 48)?,
    ];
    let matrix = DMat3::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose();
    let to_world = DAffine3::from_mat3_translation(matrix, grid.point(map + 144)?);
    if !to_world.is_finite() || to_world.matrix3.determinant() == 0.0 {
        return Err("its grid has no place in space: the matrix is not finite, or flat".to_owned());
    }
    let box_of_values =
        DAffine3::from_translation(low.as_dvec3() - 0.5) * DAffine3::from_scale(size.as_dvec3());
    Ok(VolFile {
        size,
        place: Some(to_world * box_of_values),
        values,
        beside: None,
        notes,
    })
}

/// The nodes of a grid.
struct Tree<'a, 'b> {
    grid: &'b Bytes<'a>,
    root: usize,
    background: f32,
    /// The root's entries, by the corner of their tiles over 4096.
    tiles: HashMap<IVec3, usize>,
}

/// 8³ values.
enum Block {
    /// All the same.
    Even(f32),
    /// Those of the leaf at this place.
    Leaf(usize),
}

impl<'a, 'b> Tree<'a, 'b> {
    fn read(grid: &'b Bytes<'a>, root: usize) -> Result<Self, String> {
        let count = grid.u32(root + 24)? as usize;
        let table = grid.slice(root + ROOT, count as u64 * ROOT_TILE as u64)?;
        let entries = table.as_chunks::<ROOT_TILE>().0.iter().enumerate();
        let corner = |entry: &[u8; ROOT_TILE]| {
            let bytes = entry.first_chunk().copied().unwrap_or_default();
            let key = u64::from_le_bytes(bytes);
            // 20 bits with a sign.
            let part = |shift: u32| ((key >> shift) as u32) << 12;
            IVec3::from_array([42, 21, 0].map(|shift| part(shift) as i32 >> 12))
        };
        Ok(Self {
            grid,
            root,
            background: grid.f32(root + 28)?,
            tiles: entries
                .map(|(i, entry)| (corner(entry), root + ROOT + i * ROOT_TILE))
                .collect(),
        })
    }

    /// The 8³ values from a corner that is a multiple of 8.
    fn block(&self, corner: IVec3) -> Result<Block, String> {
        let Some(entry) = self.tiles.get(&(corner >> 12_u32)) else {
            return Ok(Block::Even(self.background));
        };
        let child = self.grid.u64(entry + 8)?;
        if child == 0 {
            return self.grid.f32(entry + 20).map(Block::Even);
        }
        let mut node = self.grid.node(self.root, child)?;
        for level in [UPPER, LOWER] {
            let along = (1 << level.along) - 1;
            let [x, y, z] = ((corner >> level.tile) & along).as_usizevec3().to_array();
            let index = (((x << level.along) | y) << level.along) | z;
            let entry = node + level.table + 8 * index;
            let mask = self.grid.u64(node + level.children + index / 64 * 8)?;
            if mask >> (index % 64) & 1 == 0 {
                return self.grid.f32(entry).map(Block::Even);
            }
            node = self.grid.node(node, self.grid.u64(entry)?)?;
        }
        Ok(Block::Leaf(node))
    }
}

#[cfg(test)]
#[path = "tests/nanovdb.rs"]
mod tests;
