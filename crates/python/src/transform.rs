//! Affine transforms for the dicts of scenes.

use crate::dict::{matrix, point};
use crate::errors::value_error;
use etalon_formats::mitsuba::transform;
use etalon_params::{DMat4, DVec3};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyType;

type Numbers<'py> = Bound<'py, PyArray2<f64>>;

/// An affine transform, which acts on columns: `a @ b` is b and then a.
///
/// Transform() is the identity; its methods, as Mitsuba's, multiply from the right:
/// `Transform().translate([0, 0, 1]).rotate([0, 0, 1], 45)` rotates first. Transform(matrix) has these 4 × 4 numbers.
#[pyclass(module = "etalon", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct Transform(pub(crate) DMat4);

#[pymethods]
impl Transform {
    #[new]
    #[pyo3(signature = (matrix=None))]
    fn new(matrix: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let Some(value) = matrix else {
            return Ok(Self(DMat4::IDENTITY));
        };
        let numbers = self::matrix(value);
        let wrong = || value_error("a transform is an array of 4 × 4 numbers");
        numbers.map(Self).ok_or_else(wrong)
    }

    /// Moves by this vector (m).
    fn translate(&self, vector: &Bound<'_, PyAny>) -> PyResult<Self> {
        let vector = three(vector, "vector")?;
        Ok(Self(self.0 * DMat4::from_translation(vector)))
    }

    /// Scales by one factor, or by one along each axis.
    fn scale(&self, factors: &Bound<'_, PyAny>) -> PyResult<Self> {
        let one = factors.extract().map(DVec3::splat);
        let factors = one.or_else(|_| three(factors, "factors"))?;
        Ok(Self(self.0 * DMat4::from_scale(factors)))
    }

    /// Rotates about an axis by an angle (°), counter-clockwise seen against it.
    fn rotate(&self, axis: &Bound<'_, PyAny>, angle: f64) -> PyResult<Self> {
        let axis = three(axis, "axis")?;
        let axis = axis.try_normalize();
        let axis = axis.ok_or_else(|| value_error("the axis of a rotation has a length"))?;
        Ok(Self(self.0 * transform::rotate(axis, angle)))
    }

    /// The frame of a camera or shape at `origin` whose +z looks at `target`, with +y on the side of `up`.
    #[pyo3(signature = (origin, target, up=None))]
    fn look_at(
        &self,
        origin: &Bound<'_, PyAny>,
        target: &Bound<'_, PyAny>,
        up: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (origin, target) = (three(origin, "origin")?, three(target, "target")?);
        let up = up.map(|up| three(up, "up")).transpose()?;
        let frame = transform::look_at(origin, target, up);
        let wrong = || {
            value_error(
                "`origin` and `target` are the same point, or `up` is along what is between",
            )
        };
        Ok(Self(self.0 * frame.ok_or_else(wrong)?))
    }

    /// The transform that undoes it.
    fn inverse(&self) -> PyResult<Self> {
        let inverse = self.0.inverse();
        let wrong = || value_error("the transform flattens space: it cannot be undone");
        inverse
            .is_finite()
            .then_some(Self(inverse))
            .ok_or_else(wrong)
    }

    /// float64, 4 × 4.
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Numbers<'py>> {
        let rows = self.0.transpose().to_cols_array();
        PyArray1::from_slice(py, &rows).reshape([4, 4])
    }

    fn __matmul__(&self, other: &Self) -> Self {
        Self(self.0 * other.0)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0 == other.0
    }

    /// For copies and files.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyType>, (Numbers<'py>,))> {
        Ok((slf.get_type(), (slf.get().matrix(slf.py())?,)))
    }

    fn __repr__(&self) -> String {
        let rows = self.0.transpose().to_cols_array();
        let rows = rows.chunks(4).map(|row| format!("{row:?}"));
        format!(
            "etalon.Transform([{}])",
            rows.collect::<Vec<_>>().join(", ")
        )
    }
}

fn three(value: &Bound<'_, PyAny>, name: &str) -> PyResult<DVec3> {
    point(value).ok_or_else(|| value_error(format!("`{name}` is three numbers")))
}
