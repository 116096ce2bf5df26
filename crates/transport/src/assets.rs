//! Files that a scene refers to.

use crate::MeshData;
use std::io::{BufRead, Cursor, Seek};
use std::sync::Arc;

/// Why an asset could not be had: one sentence that names the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct AssetError {
    /// The mistake.
    pub message: String,
    /// Advice.
    pub help: Option<String>,
}

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY.
    Ply,
    /// The vertices alone of a Stanford PLY, which needs no faces.
    PlyPoints,
    /// One mesh of those in a `.serialized` file of Mitsuba's.
    Serialized {
        /// Index of the mesh in its file, from 0.
        shape_index: u32,
    },
}

/// A file that is read from here and there.
pub trait OpenFile: BufRead + Seek {}

impl<T: BufRead + Seek> OpenFile for T {}

/// The bytes of a file that somebody holds, as an open file.
pub fn in_memory(bytes: Arc<Vec<u8>>) -> Box<dyn OpenFile> {
    struct Shared(Arc<Vec<u8>>);

    impl AsRef<[u8]> for Shared {
        fn as_ref(&self) -> &[u8] {
            &self.0
        }
    }

    Box::new(Cursor::new(Shared(bytes)))
}

/// Lookup of files along the scene's search path.
pub trait Assets: Sync {
    /// The bytes of a file.
    fn bytes(&self, path: &str) -> Result<Arc<Vec<u8>>, AssetError>;

    /// A file that may be large and whose bytes nobody needs all at once.
    fn open(&self, path: &str) -> Result<Box<dyn OpenFile>, AssetError>;

    /// A mesh. Texture coordinates are as in the file (not flipped).
    fn mesh(&self, format: MeshFormat, path: &str) -> Result<MeshData, AssetError>;
}
