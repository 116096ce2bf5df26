//! Buffers: beside the scene, in a data URI, or in the `.glb` itself.

use super::reader::Reader;
use super::resource::Resource;
use crate::document::SourceFile;
use crate::read_bounded;
use std::ops::Range;
use std::sync::Arc;

/// The largest file that is read.
pub(crate) const MOST_BYTES: u64 = 16 << 30;

/// A part of a buffer.
#[derive(Clone, Debug)]
pub(crate) struct View {
    bytes: Arc<Vec<u8>>,
    range: Range<usize>,
    /// Bytes from one element to the next, if the elements are not packed.
    pub(crate) stride: Option<usize>,
}

impl View {
    /// Its bytes.
    pub(crate) fn bytes(&self) -> &[u8] {
        // That the range is within was seen when the view was made.
        self.bytes.get(self.range.clone()).unwrap_or_default()
    }
}

impl Reader<'_> {
    /// A view; `None` after a mistake.
    pub(crate) fn view(&mut self, index: usize) -> Option<View> {
        let view = self.root.buffer_views.get(index)?;
        let buffer = view.buffer.value();
        let bytes = self.buffer(buffer)?;
        let offset = view.byte_offset.map_or(0, |offset| offset.0);
        let end = offset.checked_add(view.byte_length.0);
        let size = self.root.buffers.get(buffer)?.byte_length.0;
        let size = size.min(bytes.len() as u64);
        let Some(end) = end.filter(|end| *end <= size) else {
            let message = format!("it goes beyond the {size} bytes of `buffers[{buffer}]`");
            self.error(&format!("bufferViews[{index}]"), message);
            return None;
        };
        Some(View {
            bytes,
            range: offset as usize..end as usize,
            stride: view.byte_stride.map(|stride| stride.0),
        })
    }

    fn buffer(&mut self, index: usize) -> Option<Arc<Vec<u8>>> {
        if let Some(found) = self.buffers.get(&index) {
            return found.clone();
        }
        let found = self.load_buffer(index);
        self.buffers.insert(index, found.clone());
        found
    }

    fn load_buffer(&mut self, index: usize) -> Option<Arc<Vec<u8>>> {
        let buffer = self.root.buffers.get(index)?;
        let path = format!("buffers[{index}]");
        let bytes = match &buffer.uri {
            Some(uri) => self.resource(&format!("{path}.uri"), uri, true)?,
            None => match self.binary.clone().filter(|_| index == 0) {
                Some(binary) => binary,
                None => {
                    let help = "a `uri`, or of the first buffer the binary chunk of a .glb";
                    return self.refuse(&path, "it has no data", help);
                }
            },
        };
        let (claimed, there) = (buffer.byte_length.0, bytes.len() as u64);
        if claimed > there {
            let message = format!("there are {there} bytes only");
            self.error(&format!("{path}.byteLength"), message);
            return None;
        }
        Some(bytes)
    }

    /// The bytes that a `uri` at a path names; a file becomes one of the description's if it `is_part` of it.
    pub(crate) fn resource(
        &mut self,
        path: &str,
        uri: &str,
        is_part: bool,
    ) -> Option<Arc<Vec<u8>>> {
        let name = match Resource::of(uri) {
            Ok(Resource::Bytes(bytes)) => return Some(Arc::new(bytes)),
            Ok(Resource::File(name)) => name,
            Err(reason) => {
                let accepted = "a file's name, or `data:…;base64,…`";
                return self.refuse(path, reason, accepted);
            }
        };
        let Some(found) = self.search.find(&name) else {
            let help = self.search.why_not(&name);
            return self.refuse(path, format!("the file `{name}` was not found"), help);
        };
        match read_bounded(&found, MOST_BYTES) {
            Ok(bytes) => {
                let bytes = Arc::new(bytes);
                if is_part {
                    let path = found;
                    let bytes = Arc::clone(&bytes);
                    self.files.push(SourceFile { path, bytes });
                }
                Some(bytes)
            }
            Err(reason) => {
                self.error(path, format!("cannot read `{name}`: {reason}"));
                None
            }
        }
    }
}
