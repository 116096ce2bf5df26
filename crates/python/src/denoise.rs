//! Pictures with less noise.

use crate::comparison::ImageOrPath;
use crate::errors::value_error;
use crate::image::Image;
use etalon_render::denoise::{OpenImageDenoise, denoise as denoised};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Whose filter is taken.
#[derive(FromPyObject)]
pub(crate) enum Network {
    /// Intel's if the system has it, or none.
    OfSystem(bool),
    /// Intel's, in this folder or file.
    At(PathBuf),
}

impl Network {
    fn find(self) -> Result<Option<OpenImageDenoise>, String> {
        let place = match self {
            Self::OfSystem(false) => return Ok(None),
            Self::OfSystem(true) => None,
            Self::At(place) => Some(place),
        };
        OpenImageDenoise::find(place.as_deref()).map(Some)
    }
}

/// Denoises an image that was rendered with `features=True` (`etalon render --features`), or its file.
///
/// `standard_error()` of the result estimates its root mean square error, bias included. It is marked as denoised and has no
/// replicates: `compare` makes no verdict of it. oidn: True or a path to let Intel's Open Image Denoise 2 filter.
///
/// Raises ValueError if the image lacks the features, or the library is not found.
#[pyfunction]
#[pyo3(signature = (image, *, oidn=None))]
pub(crate) fn denoise(
    py: Python<'_>,
    image: ImageOrPath<'_>,
    oidn: Option<Network>,
) -> PyResult<Image> {
    let (picture, name) = image.named(py, "the image")?;
    let denoised = py.detach(|| {
        let network = oidn.map_or(Ok(None), Network::find)?;
        denoised(&picture, network.as_ref()).map_err(|reason| format!("{name}: {reason}"))
    });
    let denoised = denoised.map_err(value_error)?;
    Ok(Image::new(denoised, None, Vec::new()))
}
