//! What is in the files of a scene, as arrays.

use crate::dict::file_arrays::FileArray;
use crate::dict::mesh::parts;
use crate::errors::value_error;
use crate::listing::file_name;
use etalon_formats::FileAssets;
use etalon_geometry::mesh_format;
use etalon_images::{Raster, Samples, Volume, raster_file};
use etalon_params::{Node, Value};
use etalon_transport::{AssetError, Assets, MeshData};
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use std::path::Path;

/// A key with its array.
type Keyed<'py> = (String, Bound<'py, PyAny>);

/// The arrays of an object, if its file holds such.
pub(crate) fn of<'py>(
    py: Python<'py>,
    node: &Node,
    files: &FileAssets,
) -> PyResult<Vec<Keyed<'py>>> {
    let unreadable = |error: AssetError| value_error(error.message);
    let Some(name) = file_name(node) else {
        return Ok(Vec::new());
    };
    if let Some(format) = mesh_format(node) {
        let mesh = py.detach(|| files.mesh(format, name));
        return of_mesh(py, &mesh.map_err(unreadable)?);
    }
    let Some(kind) = FileArray::of(&node.plugin.value) else {
        return Ok(Vec::new());
    };
    let bytes = files.bytes(name).map_err(unreadable)?;
    let array = match kind {
        // What is none is of another kind, as a lamp's table is in place of a picture.
        FileArray::Picture => match raster_file::decode(&bytes, Path::new(name)) {
            Ok(raster) if raster.channels() != 2 => Some(of_raster(py, &raster, is_raw(node))?),
            _ => None,
        },
        FileArray::Volume => match Volume::decode(&bytes) {
            Ok(volume) => {
                let [x, y, z] = volume.size;
                let shape = [z, y, x, volume.channels];
                Some(shaped(py, volume.samples, &shape)?)
            }
            Err(_) => None,
        },
    };
    let key = kind.keys()[0].to_owned();
    Ok(array.map(|array| (key, array)).into_iter().collect())
}

fn of_mesh<'py>(py: Python<'py>, mesh: &MeshData) -> PyResult<Vec<Keyed<'py>>> {
    let triangles = mesh.triangles.as_flattened().to_vec();
    let faces = shaped(py, triangles, &[mesh.triangles.len(), 3])?;
    let mut arrays = vec![("faces".to_owned(), faces)];
    for (key, columns, numbers) in parts(mesh) {
        let rows = numbers.len() / columns;
        arrays.push((key.to_owned(), shaped(py, numbers, &[rows, columns])?));
    }
    Ok(arrays)
}

/// A picture of bytes as it is, another in linear floats.
fn of_raster<'py>(py: Python<'py>, raster: &Raster, raw: bool) -> PyResult<Bound<'py, PyAny>> {
    let shape = [raster.height(), raster.width(), raster.channels()];
    let floats = match raster.samples() {
        Samples::U8(bytes) => return shaped(py, bytes.clone(), &shape),
        _ if raw => raster.to_floats(),
        _ => raster.to_linear(),
    };
    shaped(py, floats, &shape)
}

fn is_raw(node: &Node) -> bool {
    let raw = node.property("raw");
    raw.is_some_and(|raw| matches!(raw.value, Value::Boolean(true)))
}

/// An array of this shape, which may have a last axis of 1.
fn shaped<'py, T: Element>(
    py: Python<'py>,
    numbers: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let shape = match shape {
        [before @ .., 1] => before,
        shape => shape,
    };
    Ok(PyArray1::from_vec(py, numbers).reshape(shape)?.into_any())
}
