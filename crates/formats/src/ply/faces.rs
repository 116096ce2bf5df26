//! Faces and strips into triangles, and texture coordinates that stand at the corners of faces.

use super::add_attributes;
use super::columns::Columns;
use super::header::{Element, Kind, Number};
use super::source::Source;
use crate::mesh_error::{MeshError, Place};
use crate::polygon::triangulate;
use etalon_transport::MeshData;
use glam::{Vec2, Vec3};
use std::collections::HashMap;

/// The most corners of one face.
const MOST_CORNERS: usize = 1 << 20;

/// The names of a list of texture coordinates, two for each corner of a face.
const CORNER_UV_NAMES: [&str; 2] = ["texcoord", "texcoords"];

/// The list of corners of an element.
fn corner_list(element: &Element) -> Result<(usize, Number, Number), MeshError> {
    let list = ["vertex_indices", "vertex_index"]
        .iter()
        .find_map(|name| element.find(name));
    match list.map(|i| (i, element.properties[i].kind)) {
        Some((i, Kind::List { count, item })) => Ok((i, count, item)),
        _ => Err(MeshError::new(
            Place::Line(element.line),
            format!(
                "the element `{}` needs the list `vertex_indices`",
                element.name
            ),
        )),
    }
}

/// Reads the element `face`.
pub(super) fn faces(
    element: &Element,
    source: &mut Source<'_>,
    mesh: &mut MeshData,
) -> Result<(), MeshError> {
    let (list, count, item) = corner_list(element)?;
    let uv_list = CORNER_UV_NAMES
        .iter()
        .find_map(|name| element.find(name))
        .filter(|&i| matches!(element.properties[i].kind, Kind::List { .. }));
    let start = mesh.triangles.len();
    let mut reader = FaceReader {
        positions: std::mem::take(&mut mesh.positions),
        triangles: std::mem::take(&mut mesh.triangles),
        corners: Vec::new(),
        polygon: Vec::new(),
        local: uv_list.map(|_| Vec::new()),
    };
    let room = source.room_for(element.count, count.size() + 3 * item.size(), 4);
    reader.triangles.reserve(room);
    let mut corner_uvs = CornerUvs::default();
    // The number of triangles of every face, needed where faces have attributes.
    let mut owners: Vec<u32> = Vec::new();
    let free: Vec<usize> = (0..element.properties.len())
        .filter(|&i| matches!(element.properties[i].kind, Kind::Number(_)))
        .collect();
    let mut values: Vec<f64> = Vec::new();
    for _ in 0..element.count {
        for (i, property) in element.properties.iter().enumerate() {
            match property.kind {
                _ if i == list => {
                    let before = reader.triangles.len();
                    reader.face(source, count, item)?;
                    if !free.is_empty() {
                        owners.push((reader.triangles.len() - before) as u32);
                    }
                }
                Kind::List { count, item } if Some(i) == uv_list => {
                    corner_uvs.read(source, count, item)?;
                }
                Kind::Number(number) => values.push(source.number(number)?),
                Kind::List { .. } => super::skip_property(property, source)?,
            }
        }
        if let Some(local) = &mut reader.local {
            corner_uvs.finish_face(local, reader.corners.len(), source)?;
            local.clear();
        }
    }
    mesh.positions = reader.positions;
    mesh.triangles = reader.triangles;
    if !free.is_empty() {
        let columns = Columns::from_faces(&free, &values, &owners);
        add_attributes("face", element, &[list], &columns, mesh);
    }
    if corner_uvs.any {
        corner_uvs.give_to(mesh, start)?;
    }
    Ok(())
}

/// Reads the element `tristrips`: every further corner makes a triangle with the two before it, in
/// turns left and right, until a negative index begins a new strip.
pub(super) fn strips(
    element: &Element,
    source: &mut Source<'_>,
    mesh: &mut MeshData,
) -> Result<(), MeshError> {
    let (list, count, item) = corner_list(element)?;
    let vertices = mesh.positions.len() - mesh.copies.len();
    for _ in 0..element.count {
        for (i, property) in element.properties.iter().enumerate() {
            if i != list {
                super::skip_property(property, source)?;
                continue;
            }
            let mut last = [None; 2];
            let mut turned = false;
            for _ in 0..source.length(count)? {
                let index = source.integer(item)?;
                // In unsigned lists −1 is the number that no vertex can have.
                if index < 0 || index == i64::from(u32::MAX) {
                    (last, turned) = ([None; 2], false);
                    continue;
                }
                let index = checked(index, vertices, source)?;
                if let [Some(a), Some(b)] = last {
                    // Strips are glued together by triangles without area.
                    if a != b && b != index && index != a {
                        let triangle = if turned { [b, a, index] } else { [a, b, index] };
                        mesh.triangles.push(triangle);
                    }
                    turned = !turned;
                }
                last = [last[1], Some(index)];
            }
        }
    }
    Ok(())
}

/// An index as that of a vertex.
#[inline]
fn checked(index: i64, vertices: usize, source: &Source<'_>) -> Result<u32, MeshError> {
    if (0..vertices as i64).contains(&index) {
        return Ok(index as u32);
    }
    Err(source.error(format!(
        "the face refers to vertex {index}, but there are {vertices}"
    )))
}

struct FaceReader {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    corners: Vec<u32>,
    polygon: Vec<Vec3>,
    /// Which corners of the face its triangles have, if anybody wants to know.
    local: Option<Vec<[usize; 3]>>,
}

impl FaceReader {
    /// Reads one face and cuts it into triangles.
    #[inline]
    fn face(
        &mut self,
        source: &mut Source<'_>,
        count: Number,
        item: Number,
    ) -> Result<(), MeshError> {
        let length = source.length(count)?;
        if length == 3 && self.local.is_none() {
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
        let (corners, triangles, local) = (&self.corners, &mut self.triangles, &mut self.local);
        triangulate(&self.polygon, |t| {
            triangles.push(t.map(|i| corners[i]));
            if let Some(local) = local {
                local.push(t);
            }
        });
        Ok(())
    }

    #[inline]
    fn index(&self, source: &mut Source<'_>, item: Number) -> Result<u32, MeshError> {
        let index = source.integer(item)?;
        checked(index, self.positions.len(), source)
    }
}

/// Texture coordinates at the corners of triangles.
#[derive(Default)]
struct CornerUvs {
    /// Those of the face that is being read, number by number.
    face: Vec<f32>,
    of_triangles: Vec<[Vec2; 3]>,
    /// Whether any face had some.
    any: bool,
}

impl CornerUvs {
    fn read(
        &mut self,
        source: &mut Source<'_>,
        count: Number,
        item: Number,
    ) -> Result<(), MeshError> {
        let length = source.length(count)?;
        if length > 2 * MOST_CORNERS {
            return Err(source.error(format!("a face with {length} texture coordinates")));
        }
        self.face.clear();
        for _ in 0..length {
            self.face.push(source.number(item)? as f32);
        }
        Ok(())
    }

    /// Hands those of a face on to its triangles; 0, 0 if it has none.
    fn finish_face(
        &mut self,
        triangles: &[[usize; 3]],
        corners: usize,
        source: &Source<'_>,
    ) -> Result<(), MeshError> {
        let uvs = self.face.as_chunks::<2>().0;
        if !self.face.is_empty() {
            if self.face.len() != 2 * corners {
                return Err(source.error(format!(
                    "a face of {corners} corners has {} numbers of texture coordinates, not {}",
                    self.face.len(),
                    2 * corners
                )));
            }
            self.any = true;
        }
        let uv = |corner: usize| uvs.get(corner).map_or(Vec2::ZERO, |&uv| uv.into());
        self.of_triangles
            .extend(triangles.iter().map(|triangle| triangle.map(uv)));
        Ok(())
    }

    /// Gives them to the triangles from `start`. A vertex at which they differ is split.
    fn give_to(self, mesh: &mut MeshData, start: usize) -> Result<(), MeshError> {
        let bits = |uv: Vec2| uv.to_array().map(f32::to_bits);
        let count = mesh.positions.len();
        let mut first: Vec<Option<Vec2>> = vec![None; count];
        let mut others: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        let mut split = Vec::new();
        for (triangle, uvs) in mesh.triangles[start..].iter_mut().zip(&self.of_triangles) {
            for (corner, &uv) in triangle.iter_mut().zip(uvs) {
                let vertex = *corner;
                match &mut first[vertex as usize] {
                    none @ None => *none = Some(uv),
                    Some(first) if bits(*first) == bits(uv) => {}
                    Some(_) => {
                        let new = u32::try_from(count + split.len()).map_err(|_| {
                            let message = "more corners than 32 bits can count";
                            MeshError::new(Place::Whole, message)
                        })?;
                        *corner = *others.entry((vertex, bits(uv))).or_insert(new);
                        if *corner == new {
                            split.push(uv);
                            mesh.copies.push(vertex);
                        }
                    }
                }
            }
        }
        let at_vertices = std::mem::take(&mut mesh.uvs);
        let unused = |i: usize| at_vertices.get(i).copied().unwrap_or_default();
        let firsts = first.into_iter().enumerate();
        mesh.uvs = firsts.map(|(i, uv)| uv.unwrap_or(unused(i))).collect();
        mesh.uvs.extend(split);
        repeat(&mut mesh.positions, &mesh.copies, 1);
        if !mesh.normals.is_empty() {
            repeat(&mut mesh.normals, &mesh.copies, 1);
        }
        for attribute in &mut mesh.attributes {
            if attribute.name.starts_with("vertex_") {
                repeat(&mut attribute.values, &mesh.copies, attribute.channels);
            }
        }
        Ok(())
    }
}

/// Appends the values, `width` each, of some vertices.
fn repeat<T: Copy>(values: &mut Vec<T>, vertices: &[u32], width: usize) {
    values.reserve(vertices.len() * width);
    for &vertex in vertices {
        let at = vertex as usize * width;
        values.extend_from_within(at..at + width);
    }
}
