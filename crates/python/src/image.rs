//! Pictures with their statistics.

use crate::errors::{image_error, place_error, read_error, value_error};
use crate::planes::{interleaved, picture, plane};
use etalon_film::{Metadata, Part, RenderFacts, RenderedImage, read_developed};
use etalon_images::{Error, png};
use etalon_render::judge::replicates;
use etalon_render::seeds::Seeds;
use etalon_render::target::Noise;
use etalon_render::write_guard::WriteGuard;
use etalon_statistics::{Estimate, Replicates};
use numpy::{PyArray1, PyArray2, PyArray3, PyArray4, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A picture with its standard errors and metadata.
#[pyclass(module = "etalon", frozen)]
pub(crate) struct Image {
    /// The picture.
    pub(crate) developed: Arc<RenderedImage>,
    /// Its file, if it was read.
    pub(crate) path: Option<PathBuf>,
    /// Its exact sums, if it is a part of an image that was made here.
    pub(crate) part: Option<Arc<Part>>,
    notes: Vec<String>,
}

impl Image {
    /// A picture from this file, or none, with remarks on how it was made.
    pub(crate) fn new(developed: RenderedImage, path: Option<PathBuf>, notes: Vec<String>) -> Self {
        Self {
            developed: Arc::new(developed),
            path,
            part: None,
            notes,
        }
    }

    /// The picture of some of an image's replicates.
    pub(crate) fn of_part(part: Arc<Part>, notes: Vec<String>) -> Self {
        let picture = part.picture();
        Self {
            part: Some(part),
            ..Self::new(picture, None, notes)
        }
    }

    /// Of a file.
    pub(crate) fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let developed = py.detach(|| read_developed(&path));
        let developed = developed.map_err(|error| read_error(&error))?;
        Ok(Self::new(developed, Some(path), Vec::new()))
    }

    fn width_and_height(&self) -> [usize; 2] {
        [self.developed.image.width(), self.developed.image.height()]
    }

    fn statistics(&self) -> PyResult<&Metadata> {
        let metadata = self.developed.metadata.as_ref();
        metadata
            .ok_or_else(|| value_error("the image was not written by Etalon: it has no statistics"))
    }
}

#[pymethods]
impl Image {
    /// The colour: float32, height × width × 3, linear Rec. 709 in the scene's units of radiance.
    fn numpy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let colour = self.developed.image.colour();
        let colour =
            colour.ok_or_else(|| value_error(format!("no colour among {:?}", self.channels())))?;
        interleaved(
            py,
            self.width_and_height(),
            colour.planes.each_ref().map(Cow::as_ref),
        )
    }

    /// The standard error of `numpy()`: float32, height × width × 3, in the same units.
    ///
    /// Of an image with the colour channels R, G, B, or Y alone; a confidence interval takes quantiles of t with
    /// `metadata['replicates'] - 1` degrees of freedom. Raises ValueError if there is a single replicate.
    fn standard_error<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let colours = self.developed.colours();
        let names = match colours[..] {
            ["R", "G", "B"] => ["R", "G", "B"],
            ["Y"] => ["Y"; 3],
            _ => {
                return Err(value_error(format!(
                    "the standard errors of {colours:?} are none of Rec. 709: see channel('standard_error.NAME')"
                )));
            }
        };
        let errors = names.map(|name| self.developed.standard_error(name));
        match errors {
            [Some(r), Some(g), Some(b)] => interleaved(py, self.width_and_height(), [r, g, b]),
            _ => Err(value_error(
                "the image has no standard errors: they need two replicates or more",
            )),
        }
    }

    /// One channel, by its name in the file: float32, height × width.
    fn channel<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let samples = self.developed.image.channel(name);
        let samples = samples.ok_or_else(|| {
            value_error(format!(
                "no channel {name:?}; there are {}",
                self.channels().join(", ")
            ))
        })?;
        plane(py, self.width_and_height(), samples)
    }

    /// The names of all channels, `standard_error.*` included.
    #[getter]
    fn channels(&self) -> Vec<&str> {
        let channels = self.developed.image.channels().iter();
        channels.map(|channel| channel.name.as_str()).collect()
    }

    /// Width and height (pixels).
    #[getter]
    fn size(&self) -> (usize, usize) {
        self.width_and_height().into()
    }

    /// What the renderer has to say about the picture.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// One figure for the noise: √ of the mean of s² / (m² + 0.01) over pixels and colours, with mean m and standard
    /// error s. None without standard errors.
    #[getter]
    fn mean_relative_standard_error(&self) -> Option<f64> {
        self.developed.mean_relative_standard_error()
    }

    /// One figure for the noise in which bright pixels decide, that `render(…, error=…)` aims at: √(Σ ⟨s²⟩ / Σ m²), with the mean m
    /// of a colour over the image, the mean ⟨s²⟩ over its pixels of the squared standard error, and sums over the colours.
    ///
    /// None without standard errors, or if the image is black.
    #[getter]
    fn relative_standard_error(&self) -> Option<f64> {
        Noise::of(&self.developed)?.relative()
    }

    /// What the file says of itself: version, scene, integrator, sampler, spp, replicates, seed, film, … Empty for
    /// pictures of other programs. The means of tiles are left to `tiles()`.
    #[getter]
    fn metadata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Some(metadata) = &self.developed.metadata else {
            return Ok(PyDict::new(py).into_any());
        };
        let mut facts = serde_json::to_value(metadata).map_err(value_error)?;
        facts
            .as_object_mut()
            .and_then(|facts| facts.remove("tile_means"));
        py.import("json")?
            .call_method1("loads", (facts.to_string(),))
    }

    /// The means of tiles of `side` × `side` pixels (16 or 64) with intervals of this confidence.
    ///
    /// float64, rows × columns × colours × 3: the mean over replicates, and the lower and upper end of its interval (t).
    /// A tile's pixels may be correlated; its interval is made of the spread of replicates, which are not.
    #[pyo3(signature = (side=16, confidence=0.99))]
    fn tiles<'py>(
        &self,
        py: Python<'py>,
        side: u32,
        confidence: f64,
    ) -> PyResult<Bound<'py, PyArray4<f64>>> {
        if !(confidence > 0.0 && confidence < 1.0) {
            return Err(value_error(format!(
                "confidence is {confidence}: it must lie between 0 and 1"
            )));
        }
        let metadata = self.statistics()?;
        let means = metadata.tiles(Some(side)).ok_or_else(|| {
            let sides = metadata.tile_means.iter().filter_map(|means| means.side());
            let sides: Vec<String> = sides.map(|side| side.to_string()).collect();
            value_error(format!(
                "no means of tiles of {side} pixels; there are {}",
                sides.join(", ")
            ))
        })?;
        let colours = metadata.colours();
        let shape = [
            means.rows() as usize,
            means.columns() as usize,
            colours.len(),
            3,
        ];
        let mut values = vec![0.0; shape.iter().product()];
        for (colour, name) in colours.iter().enumerate() {
            let (means, tiles) = replicates(metadata, name, Some(side)).map_err(value_error)?;
            let replicates = Replicates::new(&means, tiles).map_err(value_error)?;
            for tile in 0..tiles {
                let summary = replicates.summary(tile).map_err(value_error)?;
                let estimate = Estimate::mean(&summary);
                let interval = estimate.interval(confidence);
                let start = 3 * (tile * colours.len() + colour);
                values[start..start + 3].copy_from_slice(&[
                    estimate.value(),
                    interval.low,
                    interval.high,
                ]);
            }
        }
        PyArray1::from_vec(py, values).reshape(shape)
    }

    /// Writes an image with everything (.exr; the bytes that the binary writes), or a picture to look at (.png).
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let write: fn(&RenderedImage, &Path) -> Result<(), Error> = match extension.as_deref() {
            Some("exr") => RenderedImage::write_exr,
            Some("png") => |developed, path| png::write(path, &developed.image, 0.0).map(drop),
            _ => {
                let path = path.display();
                return Err(value_error(format!(
                    "cannot write {path}: the name must end in .exr or .png"
                )));
            }
        };
        WriteGuard::default().claim(&path).map_err(place_error)?;
        let written = py.detach(|| match (&self.part, extension.as_deref()) {
            (Some(part), Some("exr")) => part.write_exr(&path),
            _ => write(&self.developed, &path),
        });
        written.map_err(|error| image_error(&error))
    }

    /// Pictures of one scene with different seeds, by any renderer, as an image with standard errors.
    ///
    /// pictures: two arrays or more of height × width × 3, linear Rec. 709. Each must be of a seed of its own, and the
    /// seeds independent. spp: samples per pixel of each. program: who made them.
    #[staticmethod]
    #[pyo3(signature = (pictures, *, spp=1, program=""))]
    fn from_replicates(pictures: &Bound<'_, PyAny>, spp: u32, program: &str) -> PyResult<Self> {
        let mut seeds: Option<Seeds> = None;
        for (index, array) in pictures.try_iter()?.enumerate() {
            let refused = |reason| value_error(format!("picture {}: {reason}", index + 1));
            let picture = picture(&array?).map_err(refused)?;
            let seeds = match &mut seeds {
                Some(seeds) => seeds,
                none => {
                    let size = [picture.width(), picture.height()].map(|n| n as u32);
                    none.insert(Seeds::new(size).map_err(value_error)?)
                }
            };
            let added = seeds.add(&picture, spp.into());
            added.map_err(|reason| value_error(format!("picture {}: {reason}", index + 1)))?;
        }
        let seeds = seeds.filter(|seeds| seeds.count() >= 2).ok_or_else(|| {
            value_error("one picture has no standard error: give two or more, of different seeds")
        })?;
        let image = seeds.develop(RenderFacts {
            version: program.to_owned(),
            integrator: program.to_owned(),
            ..RenderFacts::default()
        });
        Ok(Self::new(image, None, Vec::new()))
    }

    /// What notebooks show.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        let file = py.detach(|| png::in_memory(&self.developed.image, 0.0));
        file.map(|file| PyBytes::new(py, &file))
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.width_and_height();
        let colours = self.developed.colours().join(" ");
        let error = match self.mean_relative_standard_error() {
            Some(error) => format!("mean relative standard error {:.2} %", 100.0 * error),
            None => "no standard error".to_owned(),
        };
        format!("<etalon.Image {width} × {height}, {colours}, {error}>")
    }
}

/// Reads an EXR file, of Etalon or another program.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, path: PathBuf) -> PyResult<Image> {
    Image::open(py, path)
}
