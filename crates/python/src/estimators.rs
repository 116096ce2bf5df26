//! Which estimator is better on a scene, and whether all have the same mean.

use crate::comparison::word;
use crate::errors::{place_error, scene_error, value_error};
use crate::estimator::Estimator;
use crate::progress_report::{ProgressReport, Watch};
use crate::scene::Scene;
use crate::watched::watched;
use etalon_render::estimators::{Failure, Findings, Options, Trial, page, table};
use etalon_render::write_guard::WriteGuard;
use etalon_statistics::Verdict;
use pyo3::exceptions::{PyKeyError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use std::num::NonZeroU32;
use std::path::PathBuf;

/// What came of comparing estimators; true if all have the same mean within the tolerance.
#[pyclass(module = "etalon", frozen, mapping)]
pub(crate) struct EstimatorComparison {
    findings: Findings,
    tolerance: f64,
    /// The call that measures the same again.
    call: String,
}

#[pymethods]
impl EstimatorComparison {
    /// 'equivalent' if the intervals of all differences between means lie within the tolerance, 'different' if one lies outside,
    /// and else 'inconclusive', which is never a pass.
    ///
    /// Differences are to the first estimator, of each channel, relative to its mean; their intervals of 95 % hold together.
    #[getter]
    fn verdict(&self) -> &'static str {
        word(self.findings.verdict(self.tolerance))
    }

    /// The names of the estimators, the first of which the others are compared to.
    fn keys(&self) -> Vec<&str> {
        let rows = self.findings.estimators.iter();
        rows.map(|row| row.name.as_str()).collect()
    }

    fn __getitem__(&self, name: &str) -> PyResult<Estimator> {
        let mut rows = self.findings.estimators.iter();
        let row = rows.find(|row| row.name == name);
        row.cloned().map(Estimator).ok_or_else(|| {
            let names = self.keys().join(", ");
            PyKeyError::new_err(format!("no estimator {name:?}; there are {names}"))
        })
    }

    fn __len__(&self) -> usize {
        self.findings.estimators.len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(self.keys().into_pyobject(py)?.try_iter()?.into_any())
    }

    /// What one should know before believing the figures.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.findings.remarks.clone()
    }

    /// Everything that was found, as docs/estimators-json.md has it.
    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = serde_json::to_string(&self.findings).map_err(value_error)?;
        py.import("json")?.call_method1("loads", (text,))
    }

    /// Writes a self-contained page (HTML).
    fn report(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = py.detach(|| {
            let file = WriteGuard::default().claim(&path)?;
            file.write_text(&page::page(&self.findings, &self.call))
        });
        written.map_err(place_error)
    }

    fn __bool__(&self) -> bool {
        self.findings.verdict(self.tolerance) == Verdict::Agrees
    }

    fn __repr__(&self) -> String {
        let names = self.keys().join(", ");
        format!("<etalon.EstimatorComparison {}: {names}>", self.verdict())
    }

    /// The tables that `etalon estimators` prints.
    fn __str__(&self) -> String {
        table::text(&self.findings)
    }
}

/// Compares estimators on a scene: their means, errors, times and efficiencies, each with its interval.
///
/// integrators, samplers, filters: names to combine; the scene's own if None. Two estimators or more.
/// seconds: the time for all rendering together (s). tolerance: the difference of means that would matter, relative.
/// reference: the file of a converged image to measure errors against; without one it is rendered by the first estimator.
/// seed, threads and progress: as for `render`.
///
/// Raises SceneError for what the scene cannot be rendered with, and ValueError if the time is not enough. Ctrl-C stops it.
#[pyfunction]
#[pyo3(signature = (scene, integrators=None, *, seconds, samplers=None, filters=None, tolerance=0.01,
    reference=None, seed=0, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "Python has names for them")]
pub(crate) fn estimators(
    py: Python<'_>,
    scene: PyRef<'_, Scene>,
    integrators: Option<Vec<String>>,
    seconds: f64,
    samplers: Option<Vec<String>>,
    filters: Option<Vec<String>>,
    tolerance: f64,
    reference: Option<PathBuf>,
    seed: u64,
    threads: Option<NonZeroU32>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<EstimatorComparison> {
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(value_error(format!(
            "tolerance is {tolerance}: it must lie between 0 and 1"
        )));
    }
    let report = ProgressReport::of(progress)?;
    let [integrators, samplers, filters] =
        [integrators, samplers, filters].map(Option::unwrap_or_default);
    let call = format!(
        "et.estimators(scene, {integrators:?}, seconds={seconds}, samplers={samplers:?}, filters={filters:?}, seed={seed})"
    );
    let options = Options {
        load: scene.options().clone(),
        integrators,
        samplers,
        filters,
        seconds,
        reference,
        seed,
        ..Options::default()
    };
    let scene: &Scene = &scene;
    let measure = |watch: &Watch| {
        let trial = Trial::prepare_loaded(&|load| scene.load_again(load), &options, watch)?;
        watch.expect(trial.samples());
        trial.run(watch)
    };
    let findings = watched(py, threads, &report, measure)?.map_err(|failure| match failure {
        Failure::Refused(refusal) => scene_error(&refusal, &scene.keys()),
        Failure::Impossible(reason) => value_error(reason),
        Failure::Cancelled => PyKeyboardInterrupt::new_err(()),
    })?;
    Ok(EstimatorComparison {
        findings,
        tolerance,
        call,
    })
}
