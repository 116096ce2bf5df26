//! What was found about one estimator.

use etalon_render::estimators::Row;
use etalon_render::estimators::findings::Uncertain;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

/// What was found about one estimator; figures are of one picture of `spp` samples per pixel, at equal time.
#[pyclass(module = "etalon", frozen)]
pub(crate) struct Estimator(pub(crate) Row);

impl Estimator {
    /// The figures that have intervals.
    fn figures(&self) -> [(&'static str, Uncertain); 6] {
        let Row {
            equal_time: at,
            efficiency,
            gains,
            ..
        } = &self.0;
        let gain = gains.as_ref().map(|gains| gains.efficiency);
        [
            ("relative_mse", at.rel_mse),
            ("variance", at.variance),
            ("bias_squared", at.bias_squared),
            ("seconds", at.seconds),
            ("efficiency", *efficiency),
            ("gain", gain.unwrap_or_default()),
        ]
    }
}

#[pymethods]
impl Estimator {
    /// What tells it from the others, such as 'path' or 'path, sobol'.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Samples per pixel of one picture.
    #[getter]
    fn spp(&self) -> u32 {
        self.0.equal_time.samples_per_pixel
    }

    /// Independent pictures that were rendered at equal time.
    #[getter]
    fn pictures(&self) -> u32 {
        self.0.equal_time.replicates
    }

    /// The means of red, green and blue over the image and all pictures (linear Rec. 709, the scene's units of radiance).
    #[getter]
    fn mean(&self) -> (f64, f64, f64) {
        self.0.means.into()
    }

    /// The relative mean squared error, (x − r)² / (r² + 0.01) with the reference r, of one picture.
    #[getter]
    fn relative_mse(&self) -> Option<f64> {
        self.0.equal_time.rel_mse.value
    }

    /// The part of `relative_mse` that is variance.
    #[getter]
    fn variance(&self) -> Option<f64> {
        self.0.equal_time.variance.value
    }

    /// The part of `relative_mse` that is bias; an unbiased estimate, which may be negative.
    #[getter]
    fn bias_squared(&self) -> Option<f64> {
        self.0.equal_time.bias_squared.value
    }

    /// The time of one picture (s).
    #[getter]
    fn seconds(&self) -> Option<f64> {
        self.0.equal_time.seconds.value
    }

    /// 1 / (relative_mse · seconds), in s⁻¹.
    #[getter]
    fn efficiency(&self) -> Option<f64> {
        self.0.efficiency.value
    }

    /// How many times as efficient as the first estimator; None of the first.
    #[getter]
    fn gain(&self) -> Option<f64> {
        self.0
            .gains
            .as_ref()
            .and_then(|gains| gains.efficiency.value)
    }

    /// The intervals of 95 % of these figures, by name; None where there is none.
    #[getter]
    fn intervals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let figures = self.figures();
        figures
            .map(|(name, figure)| (name, figure.interval.map(<(f64, f64)>::from)))
            .into_py_dict(py)
    }

    /// For each channel the interval of the relative difference between this mean and the first estimator's; empty of the first.
    ///
    /// Intervals of all channels and estimators hold together with 95 %; None where no method reaches that.
    #[getter]
    fn differences<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let differences = self.0.differences.iter();
        differences
            .map(|d| (d.channel, d.interval.map(<(f64, f64)>::from)))
            .into_py_dict(py)
    }

    fn __repr__(&self) -> String {
        let figure =
            |value: Option<f64>| value.map_or_else(|| "unknown".to_owned(), |v| format!("{v:.3}"));
        format!(
            "<etalon.Estimator {}: efficiency {} / s, {} pictures of {} samples per pixel in {} s>",
            self.0.name,
            figure(self.efficiency()),
            self.pictures(),
            self.spp(),
            figure(self.seconds())
        )
    }
}
