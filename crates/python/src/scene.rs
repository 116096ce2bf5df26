//! Scenes: read, checked and compiled.

use crate::errors::scene_error;
use etalon_render::pipeline::{self, LoadError, LoadOptions, Loaded};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBool, PyDict};
use std::path::PathBuf;
use std::sync::Arc;

/// Where a scene comes from, to be read again with other options.
#[derive(Clone)]
enum Origin {
    File(PathBuf),
    Text(String),
}

impl Origin {
    fn load(&self, options: &LoadOptions) -> Result<Loaded, LoadError> {
        match self {
            Self::File(path) => pipeline::load(path, options),
            Self::Text(text) => pipeline::load_text(text, options),
        }
    }
}

/// A scene that is ready to be rendered, as made by `load_file` and `load_string`.
#[pyclass(module = "etalon", frozen)]
pub(crate) struct Scene {
    origin: Origin,
    options: LoadOptions,
    loaded: Arc<Loaded>,
}

impl Scene {
    fn load(py: Python<'_>, origin: Origin, defines: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let options = LoadOptions {
            defines: defines.map(as_text).transpose()?.unwrap_or_default(),
            ..LoadOptions::default()
        };
        let loaded = py.detach(|| origin.load(&options));
        Ok(Self {
            origin,
            options,
            loaded: Arc::new(loaded.map_err(|error| scene_error(&error))?),
        })
    }

    /// The scene as it is, or read and compiled again if its options are to be others.
    pub(crate) fn with(
        &self,
        py: Python<'_>,
        change: Option<impl FnOnce(&mut LoadOptions)>,
    ) -> PyResult<Arc<Loaded>> {
        let Some(change) = change else {
            return Ok(Arc::clone(&self.loaded));
        };
        let mut options = self.options.clone();
        change(&mut options);
        let loaded = py.detach(|| self.origin.load(&options));
        loaded.map(Arc::new).map_err(|error| scene_error(&error))
    }
}

#[pymethods]
impl Scene {
    /// The integrator's name, nested ones after a slash, such as 'path' or 'aov/path'.
    #[getter]
    fn integrator(&self) -> &str {
        &self.loaded.integrator_name
    }

    /// Width and height of what is rendered (pixels).
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.loaded.compiled.film.crop_size.into()
    }

    /// Remarks about the scene that do not prevent rendering, each `file:line:column: note: …`.
    #[getter]
    fn notes(&self) -> Vec<String> {
        let notes = self.loaded.notes.iter();
        notes
            .map(|note| note.one_line(&self.loaded.sources))
            .collect()
    }

    /// The scene's `$parameters` with the values that count, as texts, in the order of the file.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.loaded.described.parameters.clone().into_py_dict(py)
    }

    fn __repr__(&self) -> String {
        let (width, height) = self.size();
        let path = self.loaded.path.display();
        format!(
            "<etalon.Scene {path}, {width} × {height}, {}>",
            self.integrator()
        )
    }
}

/// Reads a scene of Mitsuba's XML, pbrt-v4 or glTF, as the ending of its file tells.
///
/// `defines` are values of its `$parameters`, such as `resx=64`. Raises `SceneError` with every mistake in it.
#[pyfunction]
#[pyo3(signature = (path, **defines))]
pub(crate) fn load_file(
    py: Python<'_>,
    path: PathBuf,
    defines: Option<&Bound<'_, PyDict>>,
) -> PyResult<Scene> {
    // What is not there is no mistake in a scene.
    std::fs::metadata(&path).map_err(|error| {
        PyErr::from(std::io::Error::new(
            error.kind(),
            format!("cannot read {}: {error}", path.display()),
        ))
    })?;
    Scene::load(py, Origin::File(path), defines)
}

/// Reads a scene from a text of Mitsuba's XML, called `<string>` in messages.
///
/// Relative files are looked for in the current folder. See `load_file` for `defines` and errors.
#[pyfunction]
#[pyo3(signature = (xml, **defines))]
pub(crate) fn load_string(
    py: Python<'_>,
    xml: String,
    defines: Option<&Bound<'_, PyDict>>,
) -> PyResult<Scene> {
    Scene::load(py, Origin::Text(xml), defines)
}

/// Values as they would stand in the scene: `True` is `true`.
fn as_text(defines: &Bound<'_, PyDict>) -> PyResult<Vec<(String, String)>> {
    let text = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let text = value.str()?.to_cow()?.into_owned();
        let is_bool = value.is_instance_of::<PyBool>();
        Ok((
            key.extract()?,
            if is_bool { text.to_lowercase() } else { text },
        ))
    };
    defines.iter().map(text).collect()
}
