//! Python's values as those of XML.

use super::object::named;
use crate::transform::Transform;
use etalon_params::{DMat4, DVec3};
use numpy::{AllowTypeChange, PyArrayLikeDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyList, PySet, PyString, PyTuple};

/// A value as it is written.
pub(super) enum Written {
    /// A tag with its `value`.
    Attribute(&'static str, String),
    /// The numbers of a matrix, row by row.
    Matrix(String),
}

/// What is wrong with a value: a sentence without the key.
pub(super) type Refusal = String;

/// The value of a property, or why nothing can have it; `is_plane`: whether a transform may be one of the plane.
pub(super) fn value(
    value: &Bound<'_, PyAny>,
    is_plane: bool,
) -> PyResult<Result<Written, Refusal>> {
    let plain = |tag, text| Ok(Ok(Written::Attribute(tag, text)));
    if let Ok(truth) = value.extract::<bool>() {
        return plain("boolean", truth.to_string());
    }
    if let Some(text) = text(value)? {
        return plain("string", text);
    }
    if let Some(integer) = integer(value) {
        return plain("integer", integer);
    }
    if let Some(number) = number(value) {
        return plain("float", format!("{number:?}"));
    }
    if let Ok(transform) = value.extract::<PyRef<'_, Transform>>() {
        return Ok(Ok(Written::Matrix(rows(&transform.0))));
    }
    let Some((shape, numbers)) = array(value) else {
        // As Mitsuba's transforms have it.
        return Ok(match value.getattr("matrix") {
            Ok(matrix) => transform(&matrix, is_plane),
            Err(_) => Err(format!("{} can be no value of a scene", named(value))),
        });
    };
    Ok(match (&shape[..], &numbers[..]) {
        ([3], _) if is_colour(value) => Ok(Written::Attribute("rgb", list(&numbers))),
        ([3], _) => Ok(Written::Attribute("vector", list(&numbers))),
        ([3, 3] | [4, 4], _) => transform(value, is_plane),
        _ => Err(format!(
            "an array of {} can be no value of a scene: points and vectors have 3 numbers, transforms 4 × 4",
            sizes(&shape)
        )),
    })
}

/// The text of a string or a path.
pub(super) fn text(value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Some(text.to_string()));
    }
    match value.hasattr("__fspath__")? {
        true => value.call_method0("__fspath__")?.extract().map(Some),
        false => Ok(None),
    }
}

/// The value of an `rgb`: three numbers, or one for all.
pub(super) fn rgb(value: &Bound<'_, PyAny>) -> Result<String, Refusal> {
    if let Some(number) = integer(value).or_else(|| number(value).map(|x| format!("{x:?}"))) {
        return Ok(number);
    }
    match array(value) {
        Some((shape, numbers)) if shape == [3] => Ok(list(&numbers)),
        found => Err(format!(
            "is three numbers or one, not {}",
            found_instead(found, value)
        )),
    }
}

/// The value of a `spectrum`: a number, or pairs of wavelength (nm) and value.
pub(super) fn spectrum(value: &Bound<'_, PyAny>) -> Result<String, Refusal> {
    if let Some(number) = integer(value).or_else(|| number(value).map(|x| format!("{x:?}"))) {
        return Ok(number);
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(text.to_string());
    }
    match array(value) {
        Some((shape, numbers)) if shape.len() == 2 && shape[1] == 2 => {
            let pairs = numbers.chunks_exact(2);
            let pairs = pairs.map(|pair| format!("{:?}:{:?}", pair[0], pair[1]));
            Ok(pairs.collect::<Vec<_>>().join(", "))
        }
        found => Err(format!(
            "is a number or pairs (wavelength, value), not {}",
            found_instead(found, value)
        )),
    }
}

fn found_instead(found: Option<(Vec<usize>, Vec<f64>)>, value: &Bound<'_, PyAny>) -> String {
    match found {
        Some((shape, _)) => format!("an array of {}", sizes(&shape)),
        None => named(value),
    }
}

/// An integer's digits, of Python or NumPy.
fn integer(value: &Bound<'_, PyAny>) -> Option<String> {
    if value.is_instance_of::<PyBool>() || has_axes(value) {
        return None;
    }
    let index = value.call_method0("__index__").ok()?;
    Some(index.str().ok()?.to_string())
}

/// A number of Python or NumPy.
fn number(value: &Bound<'_, PyAny>) -> Option<f64> {
    let is_scalar = || value.hasattr("ndim").is_ok_and(|has| has) && !has_axes(value);
    let is_number = value.is_instance_of::<PyFloat>() || is_scalar();
    is_number.then(|| value.extract().ok()).flatten()
}

fn has_axes(value: &Bound<'_, PyAny>) -> bool {
    let axes = value
        .getattr("ndim")
        .and_then(|axes| axes.extract::<usize>());
    axes.is_ok_and(|axes| axes > 0)
}

/// Shape and numbers of an array, or of lists of lists, or of what NumPy takes for one.
fn array(value: &Bound<'_, PyAny>) -> Option<(Vec<usize>, Vec<f64>)> {
    // NumPy would make a number of None, and numbers of texts.
    let is_list = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
    let has_text =
        || {
            let mut parts = value.try_iter().ok()?;
            Some(parts.any(|part| {
                part.is_ok_and(|part| part.is_instance_of::<PyString>() || part.is_none())
            }))
        };
    if value.is_none() || value.is_instance_of::<PySet>() || (is_list && has_text() == Some(true)) {
        return None;
    }
    let array: PyArrayLikeDyn<'_, f64, AllowTypeChange> = value.extract().ok()?;
    let numbers = array.as_array().iter().copied().collect();
    Some((array.shape().to_vec(), numbers)).filter(|(shape, _)| !shape.is_empty())
}

/// The shape of an array; none of a single number, or of anything else.
pub(super) fn shape(value: &Bound<'_, PyAny>) -> Option<Vec<usize>> {
    array(value).map(|(shape, _)| shape)
}

/// A transform of 4 × 4 numbers or, for textures, of 3 × 3.
fn transform(value: &Bound<'_, PyAny>, is_plane: bool) -> Result<Written, Refusal> {
    let (shape, n) = array(value).unwrap_or_default();
    match &shape[..] {
        [4, 4] => Ok(Written::Matrix(list(&n))),
        // A map of the plane: z does not matter.
        [3, 3] if is_plane => {
            let [a, b, x, c, d, y, e, f, w] = core::array::from_fn(|i| n[i]);
            let rows = [a, b, 0.0, x, c, d, 0.0, y, 0.0, 0.0, 1.0, 0.0, e, f, 0.0, w];
            Ok(Written::Matrix(list(&rows)))
        }
        [3, 3] => Err("a transform has 4 × 4 numbers; only `to_uv` may have 3 × 3".to_owned()),
        [] => Err(format!(
            "{} can be no transform of 4 × 4 numbers",
            named(value)
        )),
        shape => Err(format!(
            "a transform has 4 × 4 numbers, not {}",
            sizes(shape)
        )),
    }
}

/// Whether it is one of Mitsuba's colours.
fn is_colour(value: &Bound<'_, PyAny>) -> bool {
    let name = value.get_type().name();
    name.is_ok_and(|name| name.to_string().starts_with("Color3"))
}

/// A point or vector for operations of a transform.
pub(crate) fn point(value: &Bound<'_, PyAny>) -> Option<DVec3> {
    let (shape, numbers) = array(value)?;
    (shape == [3]).then(|| DVec3::from_slice(&numbers))
}

/// A matrix of 4 × 4 numbers.
pub(crate) fn matrix(value: &Bound<'_, PyAny>) -> Option<DMat4> {
    let (shape, numbers) = array(value)?;
    let numbers = numbers.try_into().ok().filter(|_| shape == [4, 4])?;
    Some(DMat4::from_cols_array(&numbers).transpose())
}

fn rows(matrix: &DMat4) -> String {
    list(&matrix.transpose().to_cols_array())
}

fn list(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|x| format!("{x:?}")).collect();
    numbers.join(" ")
}

/// A shape as `4 × 3`.
pub(super) fn sizes(shape: &[usize]) -> String {
    if shape.is_empty() {
        return "a single value".to_owned();
    }
    let sizes: Vec<String> = shape.iter().map(usize::to_string).collect();
    sizes.join(" × ")
}
