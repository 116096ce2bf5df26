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

impl Attribute {
    /// Three channels of the vertex or face with this number: one channel counts three times, a channel that is missing
    /// as 0. Each stored number counts as the nearest in the range.
    #[inline]
    pub fn of(&self, index: usize, [low, high]: [f32; 2]) -> Vec3 {
        let values = &self.values[index * self.channels..];
        let stored = match self.channels {
            1 => Vec3::splat(values[0]),
            2 => Vec3::new(values[0], values[1], 0.0),
            _ => Vec3::new(values[0], values[1], values[2]),
        };
        stored.clamp(Vec3::splat(low), Vec3::splat(high))
    }
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
