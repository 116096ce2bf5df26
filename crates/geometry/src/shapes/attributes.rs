//! The attributes of a shape, which the texture `mesh_attribute` reads.

use crate::shapes::Shape;
use crate::shapes::mesh::Mesh;
use etalon_transport::Attribute;
use glam::{Vec2, Vec3};

impl Shape {
    /// What it stores.
    pub fn attributes(&self) -> &[Attribute] {
        match self {
            Self::Ellipsoids(cloud) => cloud.attributes(),
            _ => self.mesh().map_or(&[], Mesh::attributes),
        }
    }

    /// The attribute `name` at a point of a primitive, as three channels; each stored number counts as the nearest in
    /// the range.
    pub(crate) fn attribute(
        &self,
        name: &str,
        primitive: u32,
        parameters: Vec2,
        range: [f32; 2],
    ) -> Option<Vec3> {
        if let Some(mesh) = self.mesh() {
            return mesh.attribute(name, primitive, parameters, range);
        }
        let attribute = self.attributes().iter().find(|a| a.name == name)?;
        Some(attribute.of(primitive as usize, range))
    }
}
