//! The container of the RGL material database: named arrays of numbers (Dupuy and Jakob 2018).
//!
//! ```text
//! "tensor_file\0"   version: u8 × 2 = 1, 0   count: u32
//! per field   length of name: u16, name   dimensions: u16   type: u8   offset: u64   shape: u64 × dimensions
//! the arrays, each at its offset from the beginning of the file, row by row
//! ```
//!
//! Everything is little-endian. Of the types, `u8` (1) and `f32` (10) occur in tables of BRDFs, `f64` (11) in those of
//! skies.

use crate::BrdfTableError;

/// How a file of this kind begins.
pub const MAGIC: &[u8; 12] = b"tensor_file\0";

const UINT8: u8 = 1;
const FLOAT32: u8 = 10;
const FLOAT64: u8 = 11;

/// Bytes of the types 1 to 11: unsigned and signed integers of 8, 16, 32, 64 bits, floats of 16, 32, 64.
const SIZES: [usize; 11] = [1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8];

/// The arrays of a file, as they lie in its bytes.
#[derive(Clone, Debug)]
pub struct TensorFile<'a> {
    fields: Vec<Field<'a>>,
}

#[derive(Clone, Debug)]
struct Field<'a> {
    name: &'a str,
    kind: u8,
    shape: Vec<usize>,
    bytes: &'a [u8],
}

/// An array of single-precision numbers, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    /// Entries along each dimension, the last varying fastest.
    pub shape: Vec<usize>,
    /// The numbers.
    pub data: Vec<f32>,
}

/// Takes little-endian numbers off the front of a file.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], BrdfTableError> {
        let end = self.at.checked_add(count);
        let taken = end.and_then(|end| self.bytes.get(self.at..end));
        let taken = taken.ok_or_else(|| {
            BrdfTableError::new(format!(
                "the file ends at byte {}, in the list of its fields",
                self.bytes.len()
            ))
        })?;
        self.at += count;
        Ok(taken)
    }

    /// An unsigned number of `size` bytes.
    fn number(&mut self, size: usize) -> Result<u64, BrdfTableError> {
        let bytes = self.take(size)?;
        Ok(bytes
            .iter()
            .rev()
            .fold(0, |sum, &byte| sum << 8 | u64::from(byte)))
    }
}

impl<'a> TensorFile<'a> {
    /// The fields of a file; none is copied.
    ///
    /// # Errors
    /// If the file is of another kind, or ends before the last array that it announces.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, BrdfTableError> {
        let mut cursor = Cursor { bytes, at: 0 };
        if cursor.take(MAGIC.len())? != MAGIC {
            return Err(BrdfTableError::new(
                "the file does not begin with `tensor_file`",
            ));
        }
        let version = cursor.take(2)?;
        if version != [1, 0] {
            let (major, minor) = (version[0], version[1]);
            return Err(BrdfTableError::new(format!(
                "version {major}.{minor} of the format is unknown; 1.0 is read"
            )));
        }
        let count = cursor.number(4)?;
        let mut fields = Vec::new();
        for _ in 0..count {
            fields.push(Self::field(&mut cursor)?);
        }
        Ok(Self { fields })
    }

    fn field(cursor: &mut Cursor<'a>) -> Result<Field<'a>, BrdfTableError> {
        let length = cursor.number(2)? as usize;
        let at = cursor.at;
        let name = std::str::from_utf8(cursor.take(length)?);
        let name = name.map_err(|_| {
            BrdfTableError::new(format!("the name of the field at byte {at} is no text"))
        })?;
        let dimensions = cursor.number(2)?;
        let kind = cursor.number(1)? as u8;
        let offset = cursor.number(8)?;
        let mut shape = Vec::new();
        let size = SIZES.get(usize::from(kind).wrapping_sub(1));
        let mut length = size.copied().ok_or_else(|| {
            BrdfTableError::new(format!("the field `{name}` has the unknown type {kind}"))
        })? as u64;
        for _ in 0..dimensions {
            let entries = cursor.number(8)?;
            length = length.saturating_mul(entries);
            shape.push(usize::try_from(entries).unwrap_or(usize::MAX));
        }
        let end = offset.saturating_add(length);
        let all = cursor.bytes;
        if end > all.len() as u64 {
            return Err(BrdfTableError::new(format!(
                "the field `{name}` ends at byte {end}, and the file at {}",
                all.len()
            )));
        }
        Ok(Field {
            name,
            kind,
            shape,
            bytes: &all[offset as usize..end as usize],
        })
    }

    /// Whether there is a field of this name.
    pub fn has(&self, name: &str) -> bool {
        self.fields.iter().any(|field| field.name == name)
    }

    /// The fields in words: a line for each.
    pub fn summary(&self) -> String {
        let lines = self.fields.iter().map(|field| {
            let sides: Vec<String> = field.shape.iter().map(usize::to_string).collect();
            let text = match (field.name, field.kind, core::str::from_utf8(field.bytes)) {
                ("description", UINT8, Ok(text)) => format!(": {}", text.trim()),
                _ => String::new(),
            };
            format!("  {:<20} {}{text}\n", field.name, sides.join(" × "))
        });
        lines.collect()
    }

    fn find(&self, name: &str, kinds: &[u8]) -> Result<&Field<'a>, BrdfTableError> {
        let Some(field) = self.fields.iter().find(|field| field.name == name) else {
            let names: Vec<&str> = self.fields.iter().map(|field| field.name).collect();
            return Err(BrdfTableError::new(format!(
                "the field `{name}` is missing; there are: {}",
                names.join(", ")
            )));
        };
        if !kinds.contains(&field.kind) {
            return Err(BrdfTableError::new(format!(
                "the field `{name}` has type {}, not {}",
                field.kind, kinds[0]
            )));
        }
        Ok(field)
    }

    /// The bytes of a field of type `u8`.
    ///
    /// # Errors
    /// If there is none of the name, or it has another type.
    pub fn bytes(&self, name: &str) -> Result<&'a [u8], BrdfTableError> {
        Ok(self.find(name, &[UINT8])?.bytes)
    }

    /// A field of type `f32`, or `f64` narrowed to it, with `dimensions` dimensions, none of them empty.
    ///
    /// # Errors
    /// If there is none of the name, it has another type or number of dimensions, is empty, or
    /// has an entry that is not finite.
    pub fn tensor(&self, name: &str, dimensions: usize) -> Result<Tensor, BrdfTableError> {
        let field = self.find(name, &[FLOAT32, FLOAT64])?;
        if field.shape.len() != dimensions || field.shape.contains(&0) {
            return Err(BrdfTableError::new(format!(
                "the field `{name}` has shape {:?}, not {dimensions} dimensions of at least one",
                field.shape
            )));
        }
        let data: Vec<f32> = if field.kind == FLOAT64 {
            let number = |b: &[u8]| f64::from_le_bytes(std::array::from_fn(|i| b[i])) as f32;
            field.bytes.chunks_exact(8).map(number).collect()
        } else {
            let number = |b: &[u8]| f32::from_le_bytes(std::array::from_fn(|i| b[i]));
            field.bytes.chunks_exact(4).map(number).collect()
        };
        if let Some(index) = data.iter().position(|value| !value.is_finite()) {
            return Err(BrdfTableError::new(format!(
                "entry {index} of the field `{name}` is {}",
                data[index]
            )));
        }
        Ok(Tensor {
            shape: field.shape.clone(),
            data,
        })
    }

    /// A field of type `f32` with one dimension and increasing entries.
    ///
    /// # Errors
    /// As [`TensorFile::tensor`], or if the entries do not increase.
    pub fn abscissae(&self, name: &str) -> Result<Vec<f32>, BrdfTableError> {
        let values = self.tensor(name, 1)?.data;
        match values.windows(2).position(|pair| pair[0] >= pair[1]) {
            Some(index) => Err(BrdfTableError::new(format!(
                "the entries of the field `{name}` must increase: {} comes before {}",
                values[index],
                values[index + 1]
            ))),
            None => Ok(values),
        }
    }
}

/// An array to be written.
#[derive(Clone, Copy, Debug)]
pub enum Array<'a> {
    /// Bytes, in one dimension.
    Bytes(&'a [u8]),
    /// Numbers with their shape.
    Floats(&'a [f32], &'a [usize]),
}

/// The bytes of a file with these fields.
pub fn write(fields: &[(&str, Array<'_>)]) -> Vec<u8> {
    let shape = |array: &Array<'_>| match array {
        Array::Bytes(bytes) => vec![bytes.len()],
        Array::Floats(_, shape) => shape.to_vec(),
    };
    let header: usize = (fields.iter())
        .map(|(name, array)| 13 + name.len() + 8 * shape(array).len())
        .sum();
    let mut out = MAGIC.to_vec();
    out.extend([1, 0]);
    out.extend((fields.len() as u32).to_le_bytes());
    let mut offset = (out.len() + header) as u64;
    let mut body = Vec::new();
    for (name, array) in fields {
        let shape = shape(array);
        let start = body.len();
        let kind = match array {
            Array::Bytes(bytes) => {
                body.extend_from_slice(bytes);
                UINT8
            }
            Array::Floats(values, _) => {
                body.extend(values.iter().flat_map(|value| value.to_le_bytes()));
                FLOAT32
            }
        };
        out.extend((name.len() as u16).to_le_bytes());
        out.extend(name.as_bytes());
        out.extend((shape.len() as u16).to_le_bytes());
        out.push(kind);
        out.extend(offset.to_le_bytes());
        for entries in shape {
            out.extend((entries as u64).to_le_bytes());
        }
        offset += (body.len() - start) as u64;
    }
    out.extend(body);
    out
}
