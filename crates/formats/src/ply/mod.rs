//! The Stanford PLY format: text, and binary of both byte orders.
//!
//! Of the element `vertex` are read `x y z`, `nx ny nz`, a pair of texture coordinates
//! (`u v`, `s t`, `texture_u texture_v`, `texture_s texture_t`) and every further number as an
//! attribute; of `face` the corners (`vertex_indices` or `vertex_index`) and attributes. Polygons are cut
//! into triangles, which inherit the attributes of their face. Other elements and lists are
//! skipped.
//!
//! Attributes are grouped and named as in Mitsuba 3: see `attributes.rs`.

mod attributes;
mod columns;
mod header;
mod source;

use crate::mesh_error::{MeshError, Place};
use crate::polygon::triangulate;
use attributes::groups;
use columns::Columns;
use etalon_transport::{Attribute, MeshData};
use glam::{Vec2, Vec3};
use header::{Element, Header, Kind, Property};
use source::Source;

/// The most corners of one face.
const MOST_CORNERS: usize = 1 << 20;

/// The names of texture coordinates.
const UV_NAMES: [[&str; 2]; 4] = [
    ["u", "v"],
    ["s", "t"],
    ["texture_u", "texture_v"],
    ["texture_s", "texture_t"],
];

/// Reads the bytes of a PLY file.
pub fn parse(bytes: &[u8]) -> Result<MeshData, MeshError> {
    let header = Header::parse(bytes)?;
    let mut source = Source::new(bytes, &header);
    let mut mesh = MeshData::default();
    let mut seen_vertices = false;
    let mut seen_faces = false;
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" if !seen_vertices => {
                seen_vertices = true;
                vertices(element, &mut source, &mut mesh)?;
            }
            "face" if !seen_faces => {
                if !seen_vertices {
                    return Err(MeshError::new(
                        Place::Line(element.line),
                        "the element `face` stands before `vertex`",
                    ));
                }
                seen_faces = true;
                faces(element, &mut source, &mut mesh)?;
            }
            _ => skip(element, &mut source)?,
        }
    }
    if !seen_vertices || !seen_faces || mesh.triangles.is_empty() {
        return Err(MeshError::new(
            Place::Whole,
            "the file contains no faces of three or more corners",
        ));
    }
    Ok(mesh)
}

/// Reads past an element that nobody needs.
fn skip(element: &Element, source: &mut Source<'_>) -> Result<(), MeshError> {
    if let Some(stride) = element.stride().filter(|_| source.is_binary()) {
        source.rows(element, stride)?;
        return Ok(());
    }
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            skip_property(property, source)?;
        }
    }
    Ok(())
}

fn skip_property(property: &Property, source: &mut Source<'_>) -> Result<(), MeshError> {
    match property.kind {
        Kind::Number(number) => source.number(number).map(drop),
        Kind::List { count, item } => {
            let length = source.length(count)?;
            (0..length).try_for_each(|_| source.number(item).map(drop))
        }
    }
}

fn vertices(
    element: &Element,
    source: &mut Source<'_>,
    mesh: &mut MeshData,
) -> Result<(), MeshError> {
    if u32::try_from(element.count).is_err() {
        return Err(MeshError::new(
            Place::Line(element.line),
            format!("{} vertices are more than 32 bits can count", element.count),
        ));
    }
    let find = |names: &[&str]| -> Option<Vec<usize>> {
        names.iter().map(|name| element.find(name)).collect()
    };
    let Some(xyz) = find(&["x", "y", "z"]) else {
        return Err(MeshError::new(
            Place::Line(element.line),
            "the element `vertex` needs the properties `x`, `y` and `z`",
        ));
    };
    let columns = Columns::read(element, source)?;
    let normal = find(&["nx", "ny", "nz"]);
    let uv = UV_NAMES.iter().find_map(|names| find(names));
    mesh.positions = columns.vec3(&xyz, "position")?;
    let mut used = xyz;
    if let Some(normal) = normal {
        mesh.normals = columns.vec3(&normal, "normal")?;
        used.extend(normal);
    }
    if let Some(uv) = uv {
        let pairs = columns.gather(&uv, "texture coordinate")?;
        mesh.uvs = pairs.chunks_exact(2).map(Vec2::from_slice).collect();
        used.extend(uv);
    }
    add_attributes("vertex", element, &used, &columns, mesh)
}

/// Adds the properties that are not `used` as attributes.
fn add_attributes(
    prefix: &str,
    element: &Element,
    used: &[usize],
    columns: &Columns<'_>,
    mesh: &mut MeshData,
) -> Result<(), MeshError> {
    let free: Vec<(usize, &str)> = element
        .properties
        .iter()
        .enumerate()
        .filter(|(i, p)| !used.contains(i) && matches!(p.kind, Kind::Number(_)))
        .map(|(i, p)| (i, p.name.as_str()))
        .collect();
    for group in groups(&free) {
        let values = columns.gather(&group.properties, "attribute")?;
        mesh.attributes.push(Attribute {
            name: format!("{prefix}_{}", group.name),
            channels: group.properties.len(),
            values,
        });
    }
    Ok(())
}

fn faces(element: &Element, source: &mut Source<'_>, mesh: &mut MeshData) -> Result<(), MeshError> {
    let list = ["vertex_indices", "vertex_index"]
        .iter()
        .find_map(|name| element.find(name));
    let Some((list, Kind::List { count, item })) = list.map(|i| (i, element.properties[i].kind))
    else {
        return Err(MeshError::new(
            Place::Line(element.line),
            "the element `face` needs the list `vertex_indices`",
        ));
    };
    let mut reader = FaceReader {
        positions: std::mem::take(&mut mesh.positions),
        triangles: Vec::with_capacity(source.room_for(
            element.count,
            count.size() + 3 * item.size(),
            4,
        )),
        corners: Vec::new(),
        polygon: Vec::new(),
    };
    // The number of triangles of every face, needed where faces have attributes.
    let mut owners: Vec<u32> = Vec::new();
    let free: Vec<usize> = (0..element.properties.len())
        .filter(|&i| matches!(element.properties[i].kind, Kind::Number(_)))
        .collect();
    let mut values: Vec<f64> = Vec::new();
    for _ in 0..element.count {
        for (i, property) in element.properties.iter().enumerate() {
            if i == list {
                let before = reader.triangles.len();
                reader.face(source, count, item)?;
                if !free.is_empty() {
                    owners.push((reader.triangles.len() - before) as u32);
                }
            } else if let Kind::Number(number) = property.kind {
                values.push(source.number(number)?);
            } else {
                skip_property(property, source)?;
            }
        }
    }
    mesh.positions = reader.positions;
    mesh.triangles = reader.triangles;
    if !free.is_empty() {
        let columns = Columns::from_faces(&free, &values, &owners);
        add_attributes("face", element, &[list], &columns, mesh)?;
    }
    Ok(())
}

struct FaceReader {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    corners: Vec<u32>,
    polygon: Vec<Vec3>,
}

impl FaceReader {
    /// Reads one face and cuts it into triangles.
    #[inline]
    fn face(
        &mut self,
        source: &mut Source<'_>,
        count: header::Number,
        item: header::Number,
    ) -> Result<(), MeshError> {
        let length = source.length(count)?;
        if length == 3 {
            let triangle = [
                self.index(source, item)?,
                self.index(source, item)?,
                self.index(source, item)?,
            ];
            self.triangles.push(triangle);
            return Ok(());
        }
        if length > MOST_CORNERS {
            return Err(source.error(format!("a face with {length} corners")));
        }
        self.corners.clear();
        self.polygon.clear();
        for _ in 0..length {
            let index = self.index(source, item)?;
            self.corners.push(index);
            self.polygon.push(self.positions[index as usize]);
        }
        let (corners, triangles) = (&self.corners, &mut self.triangles);
        triangulate(&self.polygon, |t| triangles.push(t.map(|i| corners[i])));
        Ok(())
    }

    #[inline]
    fn index(&self, source: &mut Source<'_>, item: header::Number) -> Result<u32, MeshError> {
        let index = source.integer(item)?;
        if (0..self.positions.len() as i64).contains(&index) {
            return Ok(index as u32);
        }
        Err(source.error(format!(
            "the face refers to vertex {index}, but there are {}",
            self.positions.len()
        )))
    }
}

#[cfg(test)]
mod tests;
