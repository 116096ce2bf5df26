//! Wavefront OBJ, parsed by the crate `tobj`.
//!
//! Read are `v` (with colours, if every vertex has them), `vt`, `vn` and `f`; everything else
//! (groups, materials, smoothing, lines, curves) is passed over, as in Mitsuba. Corners that name
//! the same position, texture coordinate and normal become one vertex; only vertices that a face
//! uses are kept, in the order of their first use. Indices count from 1, or backwards from the
//! last one if negative. A `\` at a line's end continues it.
//!
//! A corner without a texture coordinate in a file that has some gets (0, 0); one without a normal
//! gets the area-weighted mean normal of its faces. Without any `vn` the mesh has no normals:
//! whether to make smooth ones is for the shape to decide.
//!
//! `tobj` turns the text into numbers and indices. Here is what it does not do: preparing the
//! statements (`statements`), sharing vertices (`corners`), cutting concave polygons, and saying
//! which line a mistake is in (`mistakes`, which runs only when something is wrong).

mod corners;
mod lines;
mod mistakes;
mod statements;

use crate::mesh_error::{MeshError, Place};
use crate::polygon::triangulate;
use corners::{Corner, Corners};
use etalon_transport::{Attribute, MeshData};
use glam::{Vec2, Vec3};
use statements::{Form, Statements};

/// Nothing shared, cut or left out: faces with separate indices, as written.
const AS_WRITTEN: tobj::LoadOptions = tobj::LoadOptions {
    single_index: false,
    triangulate: false,
    ignore_points: false,
    ignore_lines: false,
};

/// Reads the bytes of an OBJ file.
pub fn parse(bytes: &[u8]) -> Result<MeshData, MeshError> {
    read(bytes).map_err(|reason| match mistakes::first(bytes) {
        Err(mistake) => mistake,
        Ok(()) => MeshError::new(Place::Whole, reason),
    })
}

/// Reads a file, or gives the reason why not as far as it is known without looking for the line.
fn read(bytes: &[u8]) -> Result<MeshData, String> {
    let mut statements = Statements::new(bytes, None);
    let mut models = load(&mut statements);
    if statements.mixed_colours {
        statements = Statements::new(bytes, Some(false));
        models = load(&mut statements);
    }
    let models = models.map_err(|error| format!("the file is not well-formed: {error}"))?;
    let faces = models.first().map(|model| &model.mesh);
    mesh(faces.unwrap_or(&tobj::Mesh::default()), &statements.forms)
}

fn load(statements: &mut Statements<'_>) -> Result<Vec<tobj::Model>, tobj::LoadError> {
    // No statement that asks for materials gets this far.
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    tobj::load_obj_buf(statements, &AS_WRITTEN, no_materials).map(|(models, _)| models)
}

/// Vertices and triangles from faces with separate indices and the forms of their corners.
fn mesh(faces: &tobj::Mesh, forms: &[(Form, usize)]) -> Result<MeshData, String> {
    let positions = vec3s(&faces.positions);
    let normals = vec3s(&faces.normals);
    let uvs: Vec<Vec2> = faces
        .texcoords
        .as_chunks()
        .0
        .iter()
        .map(|&uv| uv.into())
        .collect();
    let (corners, vertices) = share(faces, forms)?;
    let used = |c: &Corner| positions[c.position as usize];
    if !corners.iter().all(|c| used(c).is_finite()) {
        return Err("a position in the file is not finite".into());
    }
    let mut triangles = Vec::with_capacity(vertices.len() / 3);
    let mut polygon = Vec::new();
    let mut rest = &vertices[..];
    let mut arities = faces.face_arities.iter();
    while !rest.is_empty() {
        // No arities are given if all faces are triangles.
        let arity = arities.next().map_or(3, |&arity| arity as usize);
        let (face, later) = rest.split_at_checked(arity).ok_or("a face is incomplete")?;
        polygon.clear();
        polygon.extend(
            face.iter()
                .map(|&v| positions[corners[v as usize].position as usize]),
        );
        triangulate(&polygon, |t| triangles.push(t.map(|i| face[i])));
        rest = later;
    }
    if triangles.is_empty() {
        return Err("the file contains no faces of three or more corners".into());
    }

    let mut mesh = MeshData {
        positions: corners.iter().map(used).collect(),
        triangles,
        ..MeshData::default()
    };
    if corners.iter().any(|c| c.uv != Corner::NONE) {
        let uv = |c: &Corner| uvs.get(c.uv as usize).copied().unwrap_or_default();
        mesh.uvs = corners.iter().map(uv).collect();
    }
    if corners.iter().any(|c| c.normal != Corner::NONE) {
        let normal = |c: &Corner| normals.get(c.normal as usize).copied();
        let given: Vec<Option<Vec3>> = corners.iter().map(normal).collect();
        // Those that are given but not finite stay so: the shape computes them, and says so.
        mesh.normals = complete_normals(&mesh, &given);
    }
    let colours = vec3s(&faces.vertex_color);
    if colours.len() == positions.len() {
        let colour = |c: &Corner| colours[c.position as usize].to_array();
        mesh.attributes.push(Attribute {
            name: "vertex_color".into(),
            channels: 3,
            values: corners.iter().flat_map(colour).collect(),
        });
    }
    Ok(mesh)
}

fn vec3s(numbers: &[f32]) -> Vec<Vec3> {
    numbers.as_chunks().0.iter().map(|&v| v.into()).collect()
}

/// The vertices, and for each corner of each face which one it is.
fn share(faces: &tobj::Mesh, forms: &[(Form, usize)]) -> Result<(Vec<Corner>, Vec<u32>), String> {
    let mut corners = Corners::default();
    let mut vertices = Vec::with_capacity(faces.indices.len());
    let mut forms = forms
        .iter()
        .flat_map(|&(form, count)| std::iter::repeat_n(form, count));
    for (i, &position) in faces.indices.iter().enumerate() {
        let form = forms.next().ok_or("a corner is cut in two")?;
        // Without any texture coordinate (or normal) the parser gives no indices of them at all.
        let index = |given: bool, list: &[u32]| match given {
            true => list.get(i).copied().ok_or("a face refers to nothing"),
            false => Ok(Corner::NONE),
        };
        vertices.push(corners.vertex(Corner {
            position,
            uv: index(form.uv, &faces.texcoord_indices)?,
            normal: index(form.normal, &faces.normal_indices)?,
        }));
    }
    match forms.next() {
        None => Ok((corners.list, vertices)),
        Some(_) => Err("a corner is missing".into()),
    }
}

/// The normals given, with means over the adjacent faces where none is given.
fn complete_normals(mesh: &MeshData, given: &[Option<Vec3>]) -> Vec<Vec3> {
    let mut normals: Vec<Vec3> = given.iter().map(|n| n.unwrap_or_default()).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        for corner in triangle.map(|i| i as usize) {
            if given[corner].is_none() {
                normals[corner] += (b - a).cross(c - a);
            }
        }
    }
    for (normal, given) in normals.iter_mut().zip(given) {
        if given.is_none() {
            *normal = normal.try_normalize().unwrap_or(Vec3::Z);
        }
    }
    normals
}

#[cfg(test)]
mod tests;
