//! A triangle mesh as read from a file.

use glam::{Vec2, Vec3};

/// A named quantity on vertices or faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Full name, `vertex_…` or `face_…`.
    pub name: String,
    /// Number of channels (1 to 4).
    pub channels: usize,
    /// Values, `channels` per vertex or face.
    pub values: Vec<f32>,
}

/// An indexed triangle mesh, in the file's own space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Vertex normals: one per position or none.
    pub normals: Vec<Vec3>,
    /// Texture coordinates: one per position or none.
    pub uvs: Vec<Vec2>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Further quantities.
    pub attributes: Vec<Attribute>,
}
