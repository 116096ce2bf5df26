//! Files that a scene refers to.

use crate::MeshData;
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

/// Lookup of files along the scene's search path.
pub trait Assets: Sync {
    /// The bytes of a file.
    fn bytes(&self, path: &str) -> Result<Arc<Vec<u8>>, AssetError>;

    /// A mesh. Texture coordinates are as in the file (not flipped).
    fn mesh(&self, format: MeshFormat, path: &str) -> Result<MeshData, AssetError>;
}
