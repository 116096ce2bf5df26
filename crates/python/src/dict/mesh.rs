//! `mesh`: triangles in arrays, of the names that Mitsuba's meshes and files have.

use super::arrays::{as_array, floats};
use super::object::{Entry, Object};
use super::values::{Refusal, sizes};
use etalon_transport::{Attribute, MeshData};
use glam::{Vec2, Vec3};
use numpy::{
    AllowTypeChange, PyArrayDescrMethods, PyArrayLikeDyn, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;

const POSITIONS: [&str; 2] = ["vertices", "vertex_positions"];
const NORMALS: [&str; 2] = ["normals", "vertex_normals"];
const UVS: [&str; 2] = ["uv", "vertex_texcoords"];
const FACES: &str = "faces";

/// Whether a key is one of the arrays of a mesh; further ones are attributes, such as `vertex_color`.
pub(super) fn is_part(key: &str) -> bool {
    let named = [POSITIONS, NORMALS, UVS].concat();
    let is_attribute =
        key.starts_with("vertex_") || key.starts_with("face_") && key != "face_normals";
    key == FACES || named.contains(&key) || is_attribute
}

/// The arrays of a mesh, with their names and how many numbers are in a row; that of the faces is apart.
pub(crate) fn parts(mesh: &MeshData) -> Vec<(&str, usize, Vec<f32>)> {
    let positions = mesh.positions.iter().flat_map(|p| p.to_array());
    let mut parts = vec![(POSITIONS[0], 3, positions.collect())];
    if !mesh.normals.is_empty() {
        let normals = mesh.normals.iter().flat_map(|n| n.to_array());
        parts.push((NORMALS[0], 3, normals.collect()));
    }
    if !mesh.uvs.is_empty() {
        let uvs = mesh.uvs.iter().flat_map(|uv| uv.to_array());
        parts.push((UVS[0], 2, uvs.collect()));
    }
    let attributes = mesh.attributes.iter();
    parts.extend(attributes.map(|a| (a.name.as_str(), a.channels, a.values.clone())));
    parts
}

/// A mistake with its key.
type Mistake = (String, Refusal);

/// An array with its key.
pub(super) type Part<'py> = (String, Bound<'py, PyUntypedArray>);

/// The mesh of an object's arrays.
pub(super) fn of_object(object: &Object<'_>) -> PyResult<Result<MeshData, Mistake>> {
    let mut arrays = Vec::new();
    for (key, entry) in &object.entries {
        if let Entry::Value(value) = entry
            && is_part(key)
        {
            arrays.push((key.clone(), as_array(value)?));
        }
    }
    Ok(mesh(&arrays, None))
}

/// A mesh of arrays, or of some in place of those of an `old` one.
///
/// Vertices that move lose their normals, which are computed again, unless there are new ones.
pub(super) fn mesh(arrays: &[Part<'_>], old: Option<&MeshData>) -> Result<MeshData, Mistake> {
    let given = |names: [&str; 2]| {
        let mut found = arrays
            .iter()
            .filter(move |(key, _)| names.contains(&key.as_str()));
        match (found.next(), found.next()) {
            (_, Some((second, _))) => {
                let message = format!("it is given twice, as `{}`, too", names[0]);
                Err((second.clone(), message))
            }
            (first, None) => Ok(first),
        }
    };
    let (positions, triangles) = (given(POSITIONS)?, given([FACES; 2])?);
    // With vertices and faces it is another mesh.
    let old = old.filter(|_| positions.is_none() || triangles.is_none());
    let mut mesh = old.cloned().unwrap_or_default();
    let missing = |key: &str, what: &str| Err((key.to_owned(), format!("a mesh needs {what}")));
    match positions {
        Some(array) => {
            let count = old.map(|old| (old.positions.len(), "vertices of the old faces"));
            mesh.positions = vectors(array, count)?;
            mesh.normals.clear();
        }
        None if old.is_none() => return missing(POSITIONS[0], "an array of N × 3 positions (m)"),
        None => {}
    }
    match triangles {
        Some(array) => {
            mesh.triangles = faces(array, mesh.positions.len())?;
            mesh.attributes
                .retain(|attribute| !attribute.name.starts_with("face_"));
        }
        None if old.is_none() => return missing(FACES, "an array of M × 3 indices of vertices"),
        None => {}
    }
    let vertices = (mesh.positions.len(), "vertices");
    if let Some(array) = given(NORMALS)? {
        mesh.normals = vectors(array, Some(vertices))?;
    }
    if let Some(array) = given(UVS)? {
        let uvs = rows::<2>(array, Some(vertices))?;
        mesh.uvs = uvs.into_iter().map(Vec2::from_array).collect();
    }
    let known = [&POSITIONS[..], &NORMALS, &UVS, &[FACES]].concat();
    for array in arrays
        .iter()
        .filter(|(key, _)| !known.contains(&key.as_str()))
    {
        let count = match array.0.starts_with("face_") {
            true => (mesh.triangles.len(), "faces"),
            false => vertices,
        };
        mesh.attributes
            .retain(|attribute| attribute.name != array.0);
        mesh.attributes.push(attribute(array, count)?);
    }
    Ok(mesh)
}

fn vectors(array: &Part<'_>, count: Option<(usize, &str)>) -> Result<Vec<Vec3>, Mistake> {
    let rows = rows::<3>(array, count)?;
    Ok(rows.into_iter().map(Vec3::from_array).collect())
}

/// The rows of an array, or of its numbers one after the other, as many as there must be.
fn rows<const N: usize>(
    (key, array): &Part<'_>,
    count: Option<(usize, &str)>,
) -> Result<Vec<[f32; N]>, Mistake> {
    let mistake = |reason: String| (key.clone(), reason);
    let fits = match *array.shape() {
        [_, columns] => columns == N,
        [numbers] => numbers % N == 0,
        _ => false,
    };
    if !fits {
        let found = sizes(array.shape());
        return Err(mistake(format!("it is an array of N × {N}, not {found}")));
    }
    let numbers = floats(array).map_err(mistake)?;
    if let Some(index) = numbers.iter().position(|x| !x.is_finite()) {
        let (row, number) = (index / N, numbers[index]);
        return Err(mistake(format!(
            "row {row} has the number {number}, which is not finite"
        )));
    }
    let rows = numbers.as_chunks::<N>().0.to_vec();
    match count {
        Some((count, of)) if count != rows.len() => {
            let found = rows.len();
            Err(mistake(format!("it has {found} rows for {count} {of}")))
        }
        _ => Ok(rows),
    }
}

/// Triangles whose corners are there.
fn faces((key, array): &Part<'_>, vertices: usize) -> Result<Vec<[u32; 3]>, Mistake> {
    let mistake = |reason: String| (key.clone(), reason);
    let fits = match *array.shape() {
        [_, columns] => columns == 3,
        [numbers] => numbers % 3 == 0,
        _ => false,
    };
    if !fits {
        let found = sizes(array.shape());
        return Err(mistake(format!("it is an array of M × 3, not {found}")));
    }
    let kind = array.dtype();
    let wrong = || mistake(format!("its numbers are {kind}, not integers"));
    if !matches!(kind.kind(), b'i' | b'u') {
        return Err(wrong());
    }
    let indices: PyArrayLikeDyn<'_, i64, AllowTypeChange> = array.extract().map_err(|_| wrong())?;
    let indices: Vec<i64> = indices.as_array().iter().copied().collect();
    let outside = |index: &i64| usize::try_from(*index).is_ok_and(|index| index < vertices);
    if let Some(at) = indices.iter().position(|index| !outside(index)) {
        let (face, index) = (at / 3, indices[at]);
        return Err(mistake(format!(
            "face {face} has the vertex {index}, but there are {vertices}"
        )));
    }
    let corners: Vec<u32> = indices.into_iter().map(|index| index as u32).collect();
    Ok(corners.as_chunks::<3>().0.to_vec())
}

fn attribute(array: &Part<'_>, count: (usize, &str)) -> Result<Attribute, Mistake> {
    let (key, numbers) = array;
    let flat = |channels, values: Vec<f32>| Attribute {
        name: key.clone(),
        channels,
        values,
    };
    match *numbers.shape() {
        [_] | [_, 1] => {
            rows::<1>(array, Some(count)).map(|rows| flat(1, rows.as_flattened().to_vec()))
        }
        _ => rows::<3>(array, Some(count)).map(|rows| flat(3, rows.as_flattened().to_vec())),
    }
}
