//! Pictures: beside the scene, or within it.

use super::buffers::MOST_BYTES;
use super::reader::Reader;
use super::resource::Resource;
use crate::document::embedded_name;
use crate::read_bounded;
use std::sync::Arc;

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

impl Reader<'_> {
    /// The name by which a picture is asked for; `None` after a mistake.
    pub(crate) fn picture(&mut self, index: usize) -> Option<String> {
        if let Some(found) = self.pictures.get(&index) {
            return found.clone();
        }
        let found = self.load_picture(index);
        self.pictures.insert(index, found.clone());
        found
    }

    fn load_picture(&mut self, index: usize) -> Option<String> {
        let image = self.root.images.get(index)?;
        let path = format!("images[{index}]");
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), None) => match Resource::of(uri) {
                // Who reads the texture looks for the file.
                Ok(Resource::File(name)) => return Some(name),
                _ => self.resource(&format!("{path}.uri"), uri, false)?,
            },
            (None, Some(view)) => Arc::new(self.view(view.value())?.bytes().to_vec()),
            _ => return self.refuse(&path, "it has no data", "a `uri`, or a `bufferView`"),
        };
        self.images.insert(index, bytes);
        Some(embedded_name(index))
    }

    /// Whether a picture has alpha; false if it cannot be read, which is reported elsewhere.
    pub(crate) fn has_alpha(&mut self, index: usize) -> bool {
        let named = self.picture(index);
        match self.images.get(&index) {
            Some(bytes) => shows_alpha(bytes),
            None => {
                let file = named.and_then(|name| self.search.find(&name));
                let bytes = file.and_then(|file| read_bounded(&file, MOST_BYTES).ok());
                bytes.is_some_and(|bytes| shows_alpha(&bytes))
            }
        }
    }
}

/// Whether the bytes are those of a picture with alpha: of a PNG by its colour type, or by a chunk `tRNS` (PNG, third edition, §11.2.1 and
/// §11.3.1.1). JPEG has none.
fn shows_alpha(bytes: &[u8]) -> bool {
    if !bytes.starts_with(PNG) {
        return false;
    }
    if matches!(bytes.get(25), Some(4 | 6)) {
        return true;
    }
    let mut at = PNG.len();
    while let Some(head) = bytes.get(at..at + 8) {
        match &head[4..] {
            b"tRNS" => return true,
            b"IDAT" => return false,
            _ => {}
        }
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]);
        // A chunk ends with a sum of four bytes.
        at = at.saturating_add(length as usize).saturating_add(12);
    }
    false
}
