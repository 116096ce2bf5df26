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
    /// Vertices of which the last ones are copies, in their order: corners that differ only in
    /// their texture coordinates, and share a computed normal.
    pub copies: Vec<u32>,
    /// Whether the file itself asks for the triangles' own normals.
    pub face_normals: bool,
    /// Oddities of the file that did not prevent reading it: one sentence each, without the file's name.
    pub notes: Vec<String>,
}
