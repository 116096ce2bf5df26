//! Scenes: read, checked and compiled.

use crate::array_values;
use crate::dict::{Keys, SceneDict, changes};
use crate::errors::scene_error;
use crate::listing::{Listing, join, to_python};
use crate::origin::{Origin, Text};
use etalon_render::pipeline::{LoadError, LoadOptions, Loaded};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBool, PyDict};
use std::path::PathBuf;
use std::sync::Arc;

/// A scene that is ready to be rendered, as made by `load_file`, `load_string` and `load_dict`.
#[pyclass(module = "etalon", frozen)]
pub(crate) struct Scene {
    origin: Origin,
    options: LoadOptions,
    loaded: Arc<Loaded>,
}

impl Scene {
    fn load(py: Python<'_>, text: Text, defines: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let options = LoadOptions {
            defines: defines.map(as_text).transpose()?.unwrap_or_default(),
            ..LoadOptions::default()
        };
        Self::compile(py, Origin::new(text), options)
    }

    fn compile(py: Python<'_>, origin: Origin, options: LoadOptions) -> PyResult<Self> {
        let loaded = py.detach(|| origin.load(&options, &options));
        let loaded = loaded.map_err(|error| scene_error(&error, &origin.keys()))?;
        Ok(Self {
            origin,
            options,
            loaded: Arc::new(loaded),
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
        let loaded = py.detach(|| self.load_again(&options));
        let loaded = loaded.map_err(|error| scene_error(&error, &self.keys()))?;
        Ok(Arc::new(loaded))
    }

    /// The scene read and compiled with other options.
    pub(crate) fn load_again(&self, options: &LoadOptions) -> Result<Loaded, LoadError> {
        self.origin.load(options, &self.options)
    }

    /// The options that it was compiled with.
    pub(crate) fn options(&self) -> &LoadOptions {
        &self.options
    }

    /// The keys of its dict, if it has one.
    pub(crate) fn keys(&self) -> Keys {
        self.origin.keys()
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

    /// Remarks about the scene that do not prevent rendering, each `file:line:column: note: …` or `key.path: note: …`.
    #[getter]
    fn notes(&self) -> Vec<String> {
        let (notes, keys) = (self.loaded.notes.iter(), self.keys());
        notes
            .map(|note| keys.one_line(note, &self.loaded.sources))
            .collect()
    }

    /// The scene's `$parameters` with the values that count, as texts, in the order of the file.
    #[getter]
    fn defines<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.loaded.described.parameters.clone().into_py_dict(py)
    }

    /// The values of the scene's plugins, by paths of keys such as 'ball.bsdf.reflectance', as far as they are given.
    ///
    /// A key is a name, or else an `id`, or else a type ('sphere', 'sphere_2', …). Numbers, texts, and arrays: 3 for points,
    /// vectors and colours, n × 2 for spectra (nm, value), 4 × 4 for transforms.
    ///
    /// arrays: whether what is in files is there, too, as copies: `data` of pictures and volumes, and of meshes `vertices`, `faces`,
    /// `normals`, `uv` and attributes, all as in `load_dict`.
    #[pyo3(signature = (*, arrays=false))]
    fn parameters<'py>(&self, py: Python<'py>, arrays: bool) -> PyResult<Bound<'py, PyDict>> {
        let listing = Listing::of(&self.loaded.described.root);
        let dict = PyDict::new(py);
        for (path, value) in listing.values() {
            dict.set_item(path, to_python(py, value)?)?;
        }
        if arrays {
            let files = py.detach(|| self.origin.files(&self.options));
            for (path, node) in listing.objects() {
                for (key, array) in array_values::of(py, node, &files)? {
                    dict.set_item(join(path, &key), array)?;
                }
            }
        }
        Ok(dict)
    }

    /// The scene with other values: a dict from paths as `parameters()` has them, or of parameters that are not given yet.
    ///
    /// This scene stays as it is. What is read for the first change, files included, stays in memory for further ones. A value
    /// is as in `load_dict`; three numbers in place of a colour, number or texture are a colour; arrays, such as 'wall.vertices'
    /// or 'wall.bsdf.reflectance.data', are in place of those in files. Vertices that move get new normals, unless these are given.
    fn with_parameters(&self, py: Python<'_>, parameters: &Bound<'_, PyDict>) -> PyResult<Self> {
        let listing = Listing::of(&self.loaded.described.root);
        let files = || py.detach(|| self.origin.files(&self.options));
        let changes = changes::read(parameters, &listing, &files)?;
        Self::compile(py, self.origin.with(changes), self.options.clone())
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
    Scene::load(py, Text::File(path), defines)
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
    Scene::load(py, Text::Xml(xml), defines)
}

/// Reads a scene from a dict in Mitsuba 3's manner, called `<dict>` in messages without a key path.
///
/// dict: {'type': 'scene', …}. Its keys are names: a dict within is an object with the plugin of its `type`; {'type': 'ref',
/// 'id': …} is another object, by its `id`, its key or its path of keys; {'type': 'rgb', 'value': [r, g, b]} and
/// {'type': 'spectrum', 'value': a number or pairs (nm, value)} are colours; three numbers are a point or vector; a
/// `Transform` or 4 × 4 numbers are a transform; {'type': 'animation', 'keys': pairs (time, value)} changes in time.
/// Relative files are looked for in the current folder.
///
/// Arrays, which are copied: `data` of a `bitmap` or `envmap` is height × width, or × 1, 3 or 4 channels, floats (linear) or
/// uint8 (sRGB unless `raw`); `data` of a `gridvolume` or `sdfgrid` is z × y × x, or × 1, 3 or 6 channels; a `mesh` has
/// `vertices` (N × 3, m), `faces` (M × 3, indices from 0) and possibly `normals` (N × 3), `uv` (N × 2) and attributes
/// `vertex_…` and `face_…` (1 or 3 numbers each).
///
/// Raises `SceneError` with every mistake, each with its path of keys.
#[pyfunction]
pub(crate) fn load_dict(py: Python<'_>, dict: &Bound<'_, PyDict>) -> PyResult<Scene> {
    let dict = SceneDict::read(dict, true)?;
    Scene::load(py, Text::Dict(dict), None)
}

/// The text of Mitsuba's XML that a dict stands for; `load_dict` says what is in one.
///
/// Raises `SceneError` if it has arrays, which no text can hold, or values that cannot be written.
#[pyfunction]
pub(crate) fn dict_to_xml(dict: &Bound<'_, PyDict>) -> PyResult<String> {
    Ok(SceneDict::read(dict, false)?.scene.text)
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
