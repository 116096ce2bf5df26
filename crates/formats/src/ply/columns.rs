//! Properties of all elements of one kind, picked out column by column.

use super::header::{Element, Format, Kind, Number, Property};
use super::source::{Source, decode};
use crate::mesh_error::{MeshError, Place};
use glam::Vec3;

/// The numbers of all elements of one kind.
pub(super) struct Columns<'a> {
    count: usize,
    data: Data<'a>,
}

enum Data<'a> {
    /// Rows of a binary file.
    Rows {
        bytes: &'a [u8],
        /// Where they begin in the file.
        start: usize,
        stride: usize,
        /// Type and place in the row of each property.
        fields: Vec<(Number, usize)>,
        big: bool,
    },
    /// Decoded values, `width` per element.
    Values {
        values: Vec<f64>,
        width: usize,
        /// The position in the row of each property; lists have none.
        fields: Vec<Option<usize>>,
        /// The line of each element, if the file is text.
        first_line: Option<usize>,
    },
}

/// The positions of the elements of one kind in the file.
#[derive(Clone, Copy)]
pub(super) enum Places {
    /// As rows of bytes.
    Rows { start: usize, stride: usize },
    /// In lines from this one.
    Lines(usize),
    /// Not recorded.
    Unknown,
}

impl Places {
    /// Where one of them stands.
    pub(super) fn of(self, index: usize) -> Place {
        match self {
            Self::Rows { start, stride } => Place::Byte(start + index * stride),
            Self::Lines(first) => Place::Line(first + index),
            Self::Unknown => Place::Whole,
        }
    }
}

impl<'a> Columns<'a> {
    /// Reads all elements of one kind.
    pub(super) fn read(element: &Element, source: &mut Source<'a>) -> Result<Self, MeshError> {
        if let Some(stride) = element.stride().filter(|_| source.is_binary()) {
            let mut at = 0;
            let fields = element
                .properties
                .iter()
                .filter_map(|property| match property.kind {
                    Kind::Number(number) => {
                        at += number.size();
                        Some((number, at - number.size()))
                    }
                    Kind::List { .. } => None,
                })
                .collect();
            let (bytes, start) = source.rows(element, stride)?;
            return Ok(Self {
                count: element.count,
                data: Data::Rows {
                    bytes,
                    start,
                    stride,
                    fields,
                    big: source.format() == Format::BigEndian,
                },
            });
        }
        let mut width = 0;
        let fields = element
            .properties
            .iter()
            .map(|property| match property.kind {
                Kind::Number(_) => {
                    width += 1;
                    Some(width - 1)
                }
                Kind::List { .. } => None,
            })
            .collect();
        let smallest = element.properties.iter().map(Property::smallest).sum();
        let room = source.room_for(element.count, smallest, element.properties.len());
        let mut values = Vec::with_capacity(room * width);
        let first_line = (!source.is_binary()).then(|| source.line());
        for _ in 0..element.count {
            for property in &element.properties {
                match property.kind {
                    Kind::Number(number) => values.push(source.number(number)?),
                    Kind::List { .. } => super::skip_property(property, source)?,
                }
            }
        }
        Ok(Self {
            count: element.count,
            data: Data::Values {
                values,
                width,
                fields,
                first_line,
            },
        })
    }

    /// The numbers of faces, repeated for each of the triangles that a face was cut into:
    /// `values` has one number per face and property of `properties`, `owners` the number of
    /// triangles of each face.
    pub(super) fn from_faces(properties: &[usize], values: &[f64], owners: &[u32]) -> Self {
        let width = properties.len();
        let mut repeated = Vec::with_capacity(values.len());
        for (row, &triangles) in values.chunks_exact(width).zip(owners) {
            for _ in 0..triangles {
                repeated.extend_from_slice(row);
            }
        }
        let mut fields = vec![None; properties.iter().max().map_or(0, |last| last + 1)];
        for (position, &property) in properties.iter().enumerate() {
            fields[property] = Some(position);
        }
        Self {
            count: repeated.len() / width,
            data: Data::Values {
                values: repeated,
                width,
                fields,
                first_line: None,
            },
        }
    }

    /// Three properties of every element, as vectors.
    pub(super) fn vec3(&self, properties: &[usize]) -> Vec<Vec3> {
        let mut vectors = Vec::with_capacity(self.count);
        self.visit(properties, |row| {
            vectors.push(Vec3::new(row[0], row[1], row[2]));
        });
        vectors
    }

    /// Some properties of every element, one element after the other.
    pub(super) fn gather(&self, properties: &[usize]) -> Vec<f32> {
        let mut values = Vec::with_capacity(self.count * properties.len());
        self.visit(properties, |row| values.extend_from_slice(row));
        values
    }

    /// Where the elements stand.
    pub(super) fn places(&self) -> Places {
        match self.data {
            Data::Rows { start, stride, .. } => Places::Rows { start, stride },
            Data::Values {
                first_line: Some(line),
                ..
            } => Places::Lines(line),
            Data::Values { .. } => Places::Unknown,
        }
    }

    /// Calls `f` with the values of some properties of each element in turn.
    #[inline]
    fn visit(&self, properties: &[usize], mut f: impl FnMut(&[f32])) {
        let mut row = vec![0f32; properties.len()];
        match &self.data {
            Data::Rows {
                bytes,
                stride,
                fields,
                big,
                ..
            } => {
                let fields: Vec<(Number, usize)> = properties.iter().map(|&p| fields[p]).collect();
                for element in bytes.chunks_exact((*stride).max(1)) {
                    for (value, &(number, at)) in row.iter_mut().zip(&fields) {
                        *value = match (number, big, element[at..].first_chunk::<4>()) {
                            (Number::F32, false, Some(raw)) => f32::from_le_bytes(*raw),
                            _ => decode(number, &element[at..], *big) as f32,
                        };
                    }
                    f(&row);
                }
            }
            Data::Values {
                values,
                width,
                fields,
                ..
            } => {
                for element in values.chunks_exact((*width).max(1)) {
                    for (value, &p) in row.iter_mut().zip(properties) {
                        *value = fields[p].map_or(0.0, |at| element[at] as f32);
                    }
                    f(&row);
                }
            }
        }
    }
}
