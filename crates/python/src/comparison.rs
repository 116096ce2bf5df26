//! Whether two images agree.

use crate::errors::{place_error, value_error};
use crate::image::Image;
use etalon_film::RenderedImage;
use etalon_render::compared::Compared;
use etalon_render::judge::Tolerances;
use etalon_render::write_guard::WriteGuard;
use etalon_statistics::Verdict;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use std::path::PathBuf;
use std::sync::Arc;

/// An image, or the file of one.
#[derive(FromPyObject)]
pub(crate) enum ImageOrPath<'py> {
    Image(PyRef<'py, Image>),
    Path(PathBuf),
}

impl ImageOrPath<'_> {
    /// The image with its name in messages, which is this one if it has no file.
    pub(crate) fn named(
        self,
        py: Python<'_>,
        name: &str,
    ) -> PyResult<(Arc<RenderedImage>, String)> {
        let of = |image: &Image| {
            let path = image.path.as_ref().map(|path| path.display().to_string());
            (
                Arc::clone(&image.developed),
                path.unwrap_or_else(|| name.to_owned()),
            )
        };
        match self {
            Self::Image(image) => Ok(of(&image)),
            Self::Path(path) => Image::open(py, path).map(|image| of(&image)),
        }
    }
}

/// What came of comparing two images; true if they are equivalent.
#[pyclass(module = "etalon", frozen)]
pub(crate) struct Comparison {
    compared: Compared,
    images: [Arc<RenderedImage>; 2],
    names: [String; 2],
}

impl Comparison {
    fn images(&self) -> [&RenderedImage; 2] {
        self.images.each_ref().map(Arc::as_ref)
    }
}

/// A verdict in the words of `etalon compare`.
pub(crate) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agrees => "equivalent",
        Verdict::Differs => "different",
        Verdict::Undecided => "inconclusive",
    }
}

#[pymethods]
impl Comparison {
    /// 'equivalent', 'different' or 'inconclusive'. The last is never a pass.
    #[getter]
    fn verdict(&self) -> &'static str {
        word(self.compared.verdict())
    }

    /// The interval of the relative bias of the image's mean, of the channel where it reaches farthest; None if the
    /// images cannot be judged.
    #[getter]
    fn interval(&self) -> Option<(f64, f64)> {
        match &self.compared {
            Compared::Identical => Some((0.0, 0.0)),
            Compared::Unfit(_) => None,
            Compared::Judged(judgement) => judgement.widest().map(|row| row.interval.into()),
        }
    }

    /// The p-value of "both are estimates of the very same picture", over all questions (Bonferroni); None if they
    /// cannot be judged.
    #[getter]
    fn p_value(&self) -> Option<f64> {
        match &self.compared {
            Compared::Identical => Some(1.0),
            Compared::Unfit(_) => None,
            Compared::Judged(judgement) => Some(judgement.p_exact),
        }
    }

    /// For each channel the p-value of "no bias at all" of the image's mean, not corrected.
    #[getter]
    fn p_values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = match &self.compared {
            Compared::Judged(judgement) => &judgement.images[..],
            _ => &[],
        };
        rows.iter()
            .map(|row| (&row.channel, row.p_exact))
            .into_py_dict(py)
    }

    /// How many times as many samples, in both images, would decide what is open; None if nothing is.
    #[getter]
    fn more_samples(&self) -> Option<f64> {
        match &self.compared {
            Compared::Judged(judgement) => judgement.more_samples(),
            _ => None,
        }
    }

    /// What one should know to read the verdict: why the images cannot be judged, a seed that both share, …
    #[getter]
    fn notes(&self) -> Vec<String> {
        match &self.compared {
            Compared::Unfit(reason) => vec![reason.clone()],
            compared => compared.remarks(self.images(), &self.names),
        }
    }

    /// Writes a self-contained page (HTML).
    fn report(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = py.detach(|| {
            let file = WriteGuard::of(&self.names).claim(&path)?;
            file.write_text(&self.compared.report(self.images(), &self.names))
        });
        written.map_err(place_error)
    }

    fn __bool__(&self) -> bool {
        self.compared.verdict() == Verdict::Agrees
    }

    fn __repr__(&self) -> String {
        let detail = match &self.compared {
            Compared::Identical => "the same numbers".to_owned(),
            Compared::Unfit(reason) => reason.clone(),
            Compared::Judged(judgement) => judgement.widest().map_or_else(String::new, |row| {
                let [low, high] = row.interval.map(|bias| 100.0 * bias);
                format!("bias of {} in [{low:+.3}, {high:+.3}] %", row.channel)
            }),
        };
        format!("<etalon.Comparison {}: {detail}>", self.verdict())
    }
}

/// Decides whether two images, or the files of two, are equivalent.
///
/// tolerance: the bias of an image's mean that would matter, relative to the channel's mean.
/// tile_tolerance: that of a tile of 16² or 64² pixels, relative to its own mean (plus `tolerance` of the image's).
/// alpha: the probability of calling equal images different, over everything that is asked.
///
/// Raises ValueError for images of different sizes, or with pixels that are no finite numbers.
#[pyfunction]
#[pyo3(signature = (a, b, tolerance=0.005, *, tile_tolerance=0.03, alpha=0.001))]
pub(crate) fn compare(
    py: Python<'_>,
    a: ImageOrPath<'_>,
    b: ImageOrPath<'_>,
    tolerance: f64,
    tile_tolerance: f64,
    alpha: f64,
) -> PyResult<Comparison> {
    for (name, value) in [
        ("tolerance", tolerance),
        ("tile_tolerance", tile_tolerance),
        ("alpha", alpha),
    ] {
        if !(value > 0.0 && value < 1.0) {
            return Err(value_error(format!(
                "{name} is {value}: it must lie between 0 and 1"
            )));
        }
    }
    let (first, first_name) = a.named(py, "the first image")?;
    let (second, second_name) = b.named(py, "the second image")?;
    let (images, names) = ([first, second], [first_name, second_name]);
    let rules = Tolerances {
        image_bound: tolerance,
        tile_bound: tile_tolerance,
        alpha,
        ..Tolerances::default()
    };
    let compared = py.detach(|| Compared::new(images.each_ref().map(Arc::as_ref), &names, rules));
    Ok(Comparison {
        compared: compared.map_err(value_error)?,
        images,
        names,
    })
}
