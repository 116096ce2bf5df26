//! `mesh`: triangles in arrays, of the names that Mitsuba's meshes and files have.

use super::arrays::{as_array, floats};
use super::object::{Entry, Object};
use super::values::{Refusal, sizes};
use etalon_formats::ply;
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

/// A mistake with its key.
type Mistake = (String, Refusal);

/// The file of a mesh.
pub(super) fn file(object: &Object<'_>) -> PyResult<Result<Vec<u8>, Mistake>> {
    let mut arrays = Vec::new();
    for (key, entry) in &object.entries {
        if let Entry::Value(value) = entry
            && is_part(key)
        {
            arrays.push((key.as_str(), as_array(value)?));
        }
    }
    Ok(mesh(&arrays).map(|mesh| ply::write(&mesh)))
}

type Array<'a, 'py> = (&'a str, Bound<'py, PyUntypedArray>);

fn mesh(arrays: &[Array<'_, '_>]) -> Result<MeshData, Mistake> {
    let given = |names: [&str; 2]| {
        let mut found = arrays.iter().filter(move |(key, _)| names.contains(key));
        match (found.next(), found.next()) {
            (_, Some((second, _))) => {
                let message = format!("it is given twice, as `{}`, too", names[0]);
                Err(((*second).to_owned(), message))
            }
            (first, None) => Ok(first),
        }
    };
    let needed = |names: [&str; 2], what: &str| {
        let missing = || (names[0].to_owned(), format!("a mesh needs {what}"));
        given(names)?.ok_or_else(missing)
    };
    let positions = rows::<3>(needed(POSITIONS, "an array of N × 3 positions (m)")?, None)?;
    let vertices = Some((positions.len(), "vertices"));
    let faces = faces(
        needed([FACES; 2], "an array of M × 3 indices of vertices")?,
        positions.len(),
    )?;
    let optional = |names| given(names).map(Option::into_iter);
    let normals = optional(NORMALS)?.map(|array| rows::<3>(array, vertices));
    let uvs = optional(UVS)?.map(|array| rows::<2>(array, vertices));
    let mut mesh = MeshData {
        normals: normals
            .collect::<Result<Vec<_>, _>>()?
            .concat()
            .into_iter()
            .map(Vec3::from_array)
            .collect(),
        uvs: uvs
            .collect::<Result<Vec<_>, _>>()?
            .concat()
            .into_iter()
            .map(Vec2::from_array)
            .collect(),
        positions: positions.into_iter().map(Vec3::from_array).collect(),
        triangles: faces,
        ..MeshData::default()
    };
    let known = [&POSITIONS[..], &NORMALS, &UVS, &[FACES]].concat();
    for array in arrays.iter().filter(|(key, _)| !known.contains(key)) {
        let count = match array.0.starts_with("face_") {
            true => (mesh.triangles.len(), "faces"),
            false => (mesh.positions.len(), "vertices"),
        };
        mesh.attributes.push(attribute(array, count)?);
    }
    Ok(mesh)
}

/// The rows of an array, or of its numbers one after the other, as many as there must be.
fn rows<const N: usize>(
    (key, array): &Array<'_, '_>,
    count: Option<(usize, &str)>,
) -> Result<Vec<[f32; N]>, Mistake> {
    let mistake = |reason: String| ((*key).to_owned(), reason);
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
fn faces((key, array): &Array<'_, '_>, vertices: usize) -> Result<Vec<[u32; 3]>, Mistake> {
    let mistake = |reason: String| ((*key).to_owned(), reason);
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

fn attribute(array: &Array<'_, '_>, count: (usize, &str)) -> Result<Attribute, Mistake> {
    let (key, numbers) = array;
    let flat = |channels, values: Vec<f32>| Attribute {
        name: (*key).to_owned(),
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
