//! Meshes out: binary little-endian PLY, of names that [`super::parse`] and Mitsuba read.

use etalon_transport::{Attribute, MeshData};
use std::fmt::Write;

/// The file of a mesh: positions, normals, texture coordinates and attributes, the last with a property for each channel.
pub fn write(mesh: &MeshData) -> Vec<u8> {
    let of = |on: &'static str| move |attribute: &&Attribute| attribute.name.starts_with(on);
    let on_vertices: Vec<&Attribute> = mesh.attributes.iter().filter(of("vertex_")).collect();
    let on_faces: Vec<&Attribute> = mesh.attributes.iter().filter(of("face_")).collect();
    let mut header = String::from("ply\nformat binary_little_endian 1.0\n");
    // Writing into a string does not fail.
    let _ = writeln!(header, "element vertex {}", mesh.positions.len());
    let vertex = ["x", "y", "z"].into_iter();
    let normal = ["nx", "ny", "nz"]
        .into_iter()
        .filter(|_| !mesh.normals.is_empty());
    let uv = ["u", "v"].into_iter().filter(|_| !mesh.uvs.is_empty());
    for name in vertex.chain(normal).chain(uv) {
        let _ = writeln!(header, "property float {name}");
    }
    let declare = |header: &mut String, attributes: &[&Attribute], on: &str| {
        for attribute in attributes {
            let name = attribute.name.trim_start_matches(on);
            for channel in 0..attribute.channels {
                let _ = writeln!(header, "property float {name}_{channel}");
            }
        }
    };
    declare(&mut header, &on_vertices, "vertex_");
    let _ = writeln!(header, "element face {}", mesh.triangles.len());
    header += "property list uchar uint vertex_indices\n";
    declare(&mut header, &on_faces, "face_");
    header += "end_header\n";
    let mut bytes = header.into_bytes();
    let mut put = |numbers: &[f32]| numbers.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    let values = |attribute: &Attribute, index: usize| {
        let first = index * attribute.channels;
        attribute
            .values
            .get(first..first + attribute.channels)
            .map(<[f32]>::to_vec)
    };
    for (index, position) in mesh.positions.iter().enumerate() {
        put(&position.to_array());
        mesh.normals.get(index).inspect(|n| put(&n.to_array()));
        mesh.uvs.get(index).inspect(|uv| put(&uv.to_array()));
        for attribute in &on_vertices {
            put(&values(attribute, index).unwrap_or_default());
        }
    }
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        bytes.push(3);
        triangle
            .iter()
            .for_each(|corner| bytes.extend(corner.to_le_bytes()));
        for attribute in &on_faces {
            for value in values(attribute, index).unwrap_or_default() {
                bytes.extend(value.to_le_bytes());
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};

    #[test]
    fn what_is_written_is_read() {
        let attribute = |name: &str, channels: usize, count: usize| Attribute {
            name: name.to_owned(),
            channels,
            values: (0..channels * count).map(|i| i as f32).collect(),
        };
        let mesh = MeshData {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.1, -7.5, 3e-9)],
            normals: vec![Vec3::Z; 4],
            uvs: vec![Vec2::new(0.25, 0.75); 4],
            triangles: vec![[0, 1, 2], [1, 3, 2]],
            attributes: vec![
                attribute("vertex_warmth", 3, 4),
                attribute("face_age", 2, 2),
            ],
            ..MeshData::default()
        };
        assert_eq!(super::super::parse(&write(&mesh)), Ok(mesh));
        let bare = MeshData {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        };
        assert_eq!(super::super::parse(&write(&bare)), Ok(bare));
    }
}
