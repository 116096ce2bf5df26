//! Parts of an image, put together.

use crate::comparison::ImageOrPath;
use crate::errors::{read_error, value_error};
use crate::image::Image;
use etalon_film::Part;
use pyo3::prelude::*;
use std::sync::Arc;

/// A part with its name in messages.
type Named = (Arc<Part>, String);

/// Puts the parts of an image together, as `render(…, part=(k, n))` and `etalon render --part k/n` make them.
///
/// parts: images or files, in any order, each of other replicates of the same render. The result has the bits of a render that
/// was not split. partial: whether replicates may be missing; the result is a larger part then.
///
/// Raises ValueError for what is no part, parts of different renders or with common replicates, and missing replicates.
#[pyfunction]
#[pyo3(signature = (parts, *, partial=false))]
pub(crate) fn merge(py: Python<'_>, parts: &Bound<'_, PyAny>, partial: bool) -> PyResult<Image> {
    let mut merged: Option<Named> = None;
    for (index, image) in parts.try_iter()?.enumerate() {
        let (part, name) = part(py, image?.extract()?, index + 1)?;
        if part.replicates().is_empty() {
            return Err(value_error(format!(
                "{name} has no finished replicate: leave it out"
            )));
        }
        match &mut merged {
            None => merged = Some((part, name)),
            Some((whole, first)) => {
                py.detach(|| Arc::make_mut(whole).absorb(&part))
                    .map_err(|conflict| {
                        value_error(format!("{first} and {name} cannot be merged: {conflict}"))
                    })?
            }
        }
    }
    let (part, _) = merged.ok_or_else(|| value_error("there is nothing to merge"))?;
    match part.whole() {
        Some(whole) => Ok(Image::new(whole, None, Vec::new())),
        None if partial => Ok(Image::of_part(part, Vec::new())),
        None => Err(value_error(format!(
            "replicates are missing: {}; render them, or merge what there is with partial=True",
            part.missing()
        ))),
    }
}

/// The part that an image is, or that its file has.
fn part(py: Python<'_>, image: ImageOrPath<'_>, number: usize) -> PyResult<Named> {
    let path = match &image {
        ImageOrPath::Image(image) => match (&image.part, &image.path) {
            (Some(part), _) => return Ok((Arc::clone(part), format!("image {number}"))),
            (None, Some(path)) => path.clone(),
            (None, None) => {
                return Err(value_error(format!(
                    "image {number} is no part: parts are made by `render(…, part=(k, n))`"
                )));
            }
        },
        ImageOrPath::Path(path) => path.clone(),
    };
    let part = py.detach(|| Part::read(&path));
    let part = part.map_err(|error| read_error(&error))?;
    Ok((Arc::new(part), path.display().to_string()))
}
