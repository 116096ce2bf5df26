//! Numbers of a buffer (glTF 2.0, §3.6.2): of all component types, normalised (§3.11), with strides, and sparse.
//!
//! What a file claims about counts is held against the bytes that there are before memory is asked for.

use super::buffers::View;
use super::reader::Reader;
use ::gltf::json::Index;
use ::gltf::json::accessor::sparse::Sparse;
use ::gltf::json::accessor::{
    Accessor, ComponentType, GenericComponentType, IndexComponentType, Type,
};
use ::gltf::json::validation::Checked;

/// The most elements that an accessor may have which has no bytes for them.
const MOST_ZEROS: u64 = 1 << 20;

/// Accessors may share bytes, but not so that a small file becomes a large scene: so many bytes may be read as numbers, and so many
/// times those of the buffers.
const MOST_DECODED: u64 = 1 << 24;
const MOST_TIMES: u64 = 256;

/// What an accessor may hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WantedAccessor {
    /// Vectors of which lengths.
    pub(crate) types: &'static [Type],
    /// Of which components; `true`: normalised.
    pub(crate) components: &'static [(ComponentType, bool)],
    /// The same in words.
    pub(crate) words: &'static str,
}

/// One number of a buffer.
type Decode = fn(&[u8], bool) -> f32;

impl Reader<'_> {
    /// Vectors of N numbers, the missing ones of shorter vectors 1; `None` after a mistake.
    pub(crate) fn vectors<const N: usize>(
        &mut self,
        index: Index<Accessor>,
        wanted: &WantedAccessor,
    ) -> Option<Vec<[f32; N]>> {
        let path = path_of(index);
        let accessor = self.root.get(index)?;
        let (components, component) = self.kind_of(index)?;
        let normalised = accessor.normalized;
        let fits = wanted.components.contains(&(component, normalised))
            && wanted.types.iter().any(|kind| size_of(*kind) == components);
        if !fits {
            let normalised = if normalised { "normalised " } else { "" };
            let found = format!("it holds {components} {normalised}numbers of {component:?}");
            return self.refuse(&path, found, wanted.words);
        }
        let (size, decode) = decoder(component);
        let used = components.min(N);
        let vectors = self.elements(index, components * size, [0.0; N], |bytes| {
            let mut vector = [1.0; N];
            for (number, bytes) in vector[..used].iter_mut().zip(bytes.chunks_exact(size)) {
                *number = decode(bytes, normalised);
            }
            vector
        })?;
        if let Some(i) = vectors
            .iter()
            .position(|v| v.iter().any(|x| !x.is_finite()))
        {
            self.error(&path, format!("element {i} is not finite"));
            return None;
        }
        Some(vectors)
    }

    /// Indices, all below `end`; `None` after a mistake.
    pub(crate) fn indices(&mut self, index: Index<Accessor>, end: usize) -> Option<Vec<u32>> {
        use ComponentType::{U8, U16, U32};
        let path = path_of(index);
        let (components, component) = self.kind_of(index)?;
        if components != 1 || ![U8, U16, U32].contains(&component) {
            let found = format!("it holds {components} numbers of {component:?}");
            return self.refuse(&path, found, "SCALAR of U8, U16 or U32");
        }
        let size = component.size();
        let indices = self.elements(index, size, 0, unsigned)?;
        if let Some(i) = indices.iter().position(|i| *i as usize >= end) {
            let message = format!(
                "element {i} is {}, and there are {end} vertices",
                indices[i]
            );
            self.error(&path, message);
            return None;
        }
        Some(indices)
    }

    /// How many numbers an element has, and what they are.
    pub(crate) fn kind_of(&self, index: Index<Accessor>) -> Option<(usize, ComponentType)> {
        let accessor = self.root.get(index)?;
        match (&accessor.type_, &accessor.component_type) {
            (Checked::Valid(kind), Checked::Valid(GenericComponentType(component))) => {
                Some((size_of(*kind), *component))
            }
            _ => None,
        }
    }

    /// The elements of an accessor, each of `size` bytes.
    fn elements<T: Copy>(
        &mut self,
        index: Index<Accessor>,
        size: usize,
        zero: T,
        decode: impl Fn(&[u8]) -> T,
    ) -> Option<Vec<T>> {
        let path = path_of(index);
        let accessor = self.root.get(index)?;
        let count = accessor.count.0;
        if count == 0 {
            self.error(&format!("{path}.count"), "an accessor is not empty");
            return None;
        }
        let mut elements = match accessor.buffer_view {
            Some(view) => {
                let view = self.view(view.value())?;
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                let stride = view.stride.unwrap_or(size);
                if stride < size {
                    let message = format!("its elements of {size} bytes overlap");
                    self.error(&path, message);
                    return None;
                }
                let slices = slices(&view, offset, count, size, stride);
                let Some(slices) = slices else {
                    let there = view.bytes().len();
                    let message = format!(
                        "{count} elements of {size} bytes from byte {offset} on, {stride} apart, go beyond the {there} bytes of \
                         its view"
                    );
                    self.error(&path, message);
                    return None;
                };
                self.count(&path, count.saturating_mul(size as u64))?;
                slices.map(&decode).collect()
            }
            None if count <= MOST_ZEROS => vec![zero; count as usize],
            None => {
                let message = format!("more than {MOST_ZEROS} elements have no bytes");
                self.error(&format!("{path}.count"), message);
                return None;
            }
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(&path, sparse, size, &mut elements, decode)?;
        }
        Some(elements)
    }

    /// Counts bytes that are read; `None` if they are too many.
    fn count(&mut self, path: &str, bytes: u64) -> Option<()> {
        self.decoded = self.decoded.saturating_add(bytes);
        let buffers = self.buffers.values().flatten();
        let there: u64 = buffers.map(|buffer| buffer.len() as u64).sum();
        if self.decoded > MOST_DECODED.max(there.saturating_mul(MOST_TIMES)) {
            let message = format!("the {there} bytes of the buffers are read too often");
            self.error(path, message);
            return None;
        }
        Some(())
    }

    /// Puts the values of a sparse accessor in their places.
    fn replace<T: Copy>(
        &mut self,
        path: &str,
        sparse: &Sparse,
        size: usize,
        elements: &mut [T],
        decode: impl Fn(&[u8]) -> T,
    ) -> Option<()> {
        let path = format!("{path}.sparse");
        let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type else {
            return None;
        };
        let places = self.view(sparse.indices.buffer_view.value())?;
        let values = self.view(sparse.values.buffer_view.value())?;
        let width = component.size();
        let count = sparse.count.0;
        let places = slices(&places, sparse.indices.byte_offset.0, count, width, width);
        let values = slices(&values, sparse.values.byte_offset.0, count, size, size);
        let (Some(places), Some(values)) = (places, values) else {
            let message = format!("{count} indices and values go beyond their views");
            self.error(&format!("{path}.count"), message);
            return None;
        };
        let end = elements.len();
        for (place, value) in places.map(unsigned).zip(values) {
            match elements.get_mut(place as usize) {
                Some(element) => *element = decode(value),
                None => {
                    let message = format!("there is no element {place} among {end}");
                    self.error(&format!("{path}.indices"), message);
                    return None;
                }
            }
        }
        Some(())
    }
}

fn path_of(index: Index<Accessor>) -> String {
    format!("accessors[{index}]")
}

/// How many numbers an element has.
fn size_of(kind: Type) -> usize {
    kind.multiplicity()
}

/// The bytes of each element; `None` if they are not all within the view.
fn slices(
    view: &View,
    offset: u64,
    count: u64,
    size: usize,
    stride: usize,
) -> Option<impl Iterator<Item = &[u8]>> {
    let steps = count.saturating_sub(1).checked_mul(stride as u64)?;
    let end = offset.checked_add(steps)?.checked_add(size as u64)?;
    let bytes = view.bytes();
    if end > bytes.len() as u64 {
        return None;
    }
    let (offset, end) = (offset as usize, end as usize);
    let elements = bytes[offset..end].chunks(stride);
    Some(elements.map(move |element| &element[..size]))
}

/// An unsigned number of one, two or four bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    match *bytes {
        [a] => u32::from(a),
        [a, b] => u32::from(u16::from_le_bytes([a, b])),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
        _ => 0,
    }
}

/// How many bytes a number has, and how they are read.
fn decoder(component: ComponentType) -> (usize, Decode) {
    let decode: Decode = match component {
        ComponentType::I8 => |bytes, normalised| {
            let x = f32::from(bytes[0].cast_signed());
            if normalised { (x / 127.0).max(-1.0) } else { x }
        },
        ComponentType::U8 => |bytes, normalised| {
            let x = f32::from(bytes[0]);
            if normalised { x / 255.0 } else { x }
        },
        ComponentType::I16 => |bytes, normalised| {
            let x = f32::from(i16::from_le_bytes([bytes[0], bytes[1]]));
            if normalised {
                (x / 32767.0).max(-1.0)
            } else {
                x
            }
        },
        ComponentType::U16 => |bytes, normalised| {
            let x = f32::from(u16::from_le_bytes([bytes[0], bytes[1]]));
            if normalised { x / 65535.0 } else { x }
        },
        ComponentType::U32 => |bytes, _| unsigned(bytes) as f32,
        ComponentType::F32 => |bytes, _| f32::from_bits(unsigned(bytes)),
    };
    (component.size(), decode)
}
