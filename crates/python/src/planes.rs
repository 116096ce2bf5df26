//! Planes of pixels to NumPy's arrays, and back.

use crate::errors::value_error;
use etalon_images::Image;
use numpy::{
    AllowTypeChange, PyArray1, PyArray2, PyArray3, PyArrayLike3, PyArrayMethods,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

/// One plane of `width` × `height` samples as an array of height × width.
pub(crate) fn plane<'py>(
    py: Python<'py>,
    [width, height]: [usize; 2],
    samples: &[f32],
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    PyArray1::from_slice(py, samples).reshape([height, width])
}

/// Three planes as an array of height × width × 3.
pub(crate) fn interleaved<'py>(
    py: Python<'py>,
    [width, height]: [usize; 2],
    planes: [&[f32]; 3],
) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let pixels = 0..width * height;
    let samples = pixels.flat_map(|pixel| planes.map(|plane| plane[pixel]));
    PyArray1::from_vec(py, samples.collect()).reshape([height, width, 3])
}

/// The picture in an array of height × width × 3, with the channels R, G and B.
pub(crate) fn picture(array: &Bound<'_, PyAny>) -> PyResult<Image> {
    let array: PyArrayLike3<'_, f32, AllowTypeChange> = array.extract().map_err(|_| {
        value_error("a picture is an array of numbers of height × width × 3 (linear Rec. 709)")
    })?;
    let &[height, width, channels] = array.shape() else {
        return Err(value_error("a picture has three dimensions"));
    };
    if channels != 3 || width == 0 || height == 0 {
        return Err(value_error(format!(
            "a picture is an array of height × width × 3, not {height} × {width} × {channels}"
        )));
    }
    let pixels = array.as_array();
    let plane = |c: usize| {
        pixels
            .index_axis(numpy::ndarray::Axis(2), c)
            .iter()
            .copied()
            .collect()
    };
    Ok(Image::new(width, height)
        .with("R", plane(0))
        .with("G", plane(1))
        .with("B", plane(2)))
}
