//! Questions with known answers to other renderers.

use crate::errors::{place_error, value_error};
use crate::progress_report::{ProgressReport, Watch};
use crate::watched::watched;
use etalon_conform::driver::{Driver, Programs};
use etalon_conform::mode::Mode;
use etalon_conform::page::page;
use etalon_conform::plan::Plan;
use etalon_conform::questions;
use etalon_conform::report::{Conclusion, Report};
use etalon_conform::runner::Runner;
use etalon_conform::suite::Suite;
use etalon_conform::tier::Tier;
use etalon_params::suggest::nearest;
use etalon_render::write_guard::WriteGuard;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::thread::available_parallelism;
use std::time::Duration;

/// What a renderer answered; true if it agrees in all that it can express.
#[pyclass(module = "etalon", frozen)]
pub(crate) struct Conformance {
    suite: Suite,
    report: Report,
}

#[pymethods]
impl Conformance {
    /// 'agrees', or the worst that was found: 'differs', 'broken' or 'undecided', which is never a pass.
    #[getter]
    fn verdict(&self) -> &'static str {
        match self.report.conclusion() {
            Conclusion::Agrees => "agrees",
            Conclusion::Differs => "differs",
            Conclusion::Broken => "broken",
            Conclusion::Undecided => "undecided",
        }
    }

    /// For each question 'agrees', 'differs', 'undecided', 'not supported' or 'broken'.
    #[getter]
    fn verdicts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = self.report.rows.iter();
        rows.map(|row| (&row.question, row.finding.verdict.word()))
            .into_py_dict(py)
    }

    /// Everything that was found, as the `report.json` of `etalon conform run` has it.
    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?
            .call_method1("loads", (self.report.to_json(),))
    }

    /// Writes a self-contained page (HTML).
    fn report(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = py.detach(|| {
            let file = WriteGuard::default().claim(&path)?;
            file.write_text(&page(&[self.suite.run_for_page(&self.report)]))
        });
        written.map_err(place_error)
    }

    fn __bool__(&self) -> bool {
        self.report.conclusion() == Conclusion::Agrees
    }

    fn __repr__(&self) -> String {
        let (count, title) = (self.report.rows.len(), &self.report.plan.title);
        format!(
            "<etalon.Conformance {}: {title}, questions: {count}>",
            self.verdict()
        )
    }

    /// The table that `etalon conform run` prints.
    fn __str__(&self) -> String {
        self.report.table()
    }
}

/// Asks a renderer questions with known answers.
///
/// driver: the path of a TOML file that says how to run it (docs/testing-a-renderer.md), or the name of a driver that comes with
/// Etalon. output: the folder for scenes and pictures; those that are there already are not rendered again.
/// questions: their names; all if None. tier: 'quick', 'standard' or 'full'. workers: pictures at a time, each with one thread;
/// as many as there are processors if None. limit: the longest that a picture may take (s).
/// python, etalon: the programs that drivers call so; this Python and the binary on the PATH if None.
///
/// Ctrl-C waits for the pictures that are being rendered. Raises ValueError for what cannot be run or written.
#[pyfunction]
#[pyo3(signature = (driver, output, *, questions=None, tier="standard", workers=None, limit=120, python=None, etalon=None))]
#[expect(clippy::too_many_arguments, reason = "Python has names for them")]
pub(crate) fn conform(
    py: Python<'_>,
    driver: PathBuf,
    output: PathBuf,
    questions: Option<Vec<String>>,
    tier: &str,
    workers: Option<NonZeroU32>,
    limit: u32,
    python: Option<PathBuf>,
    etalon: Option<PathBuf>,
) -> PyResult<Conformance> {
    let tier: Tier =
        (tier.parse()).map_err(|reason| value_error(format!("tier is {tier:?}: {reason}")))?;
    let plan = plan(questions.as_deref(), tier)?;
    let executable = || py.import("sys")?.getattr("executable")?.extract();
    let programs = Programs {
        python: python.map_or_else(executable, Ok)?,
        etalon: etalon.unwrap_or_else(|| "etalon".into()),
    };
    let ask = |watch: &Watch| {
        let driver = match driver.extension().is_some_and(|ending| ending == "toml") {
            true => Driver::read(&driver, &programs)?,
            false => {
                let name = driver.display().to_string();
                Driver::named(&name, &output.join("driver"), &programs)?
            }
        };
        let version = driver.version()?;
        let mut suite = Suite::create(&output, plan.of(&driver, version))?;
        let processors = available_parallelism().map_or(1, usize::from);
        let runner = Runner {
            workers: workers.map_or(processors, |count| count.get() as usize),
            limit: Duration::from_secs(limit.into()),
            done: &|_, _| {},
            stop: watch.stopped(),
        };
        let report = suite.run(&driver, &runner, |_, _| {})?;
        Ok::<_, String>(Conformance { suite, report })
    };
    watched(py, None, &ProgressReport::Silent, ask)?.map_err(value_error)
}

/// What is asked.
fn plan(names: Option<&[String]>, tier: Tier) -> PyResult<Plan> {
    for name in names.unwrap_or_default() {
        if questions::by_name(name).is_none() {
            let near = nearest(name, questions::ALL.iter().map(|question| question.name));
            let hint = near.map_or_else(
                || "`etalon conform list` names all".to_owned(),
                |near| format!("did you mean `{near}`?"),
            );
            return Err(value_error(format!(
                "there is no question `{name}`: {hint}"
            )));
        }
    }
    let fits = |name: &str| names.is_none_or(|names| names.iter().any(|other| other == name));
    let plan = Plan::new(1, tier, Mode::default(), fits);
    match plan.questions.is_empty() {
        true => Err(value_error(format!(
            "the tier {:?} asks none of these questions",
            tier.name()
        ))),
        false => Ok(plan),
    }
}
