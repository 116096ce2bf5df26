//! Arrays as files in memory: pictures and volumes.

use super::file_arrays::FileArray;
use super::object::named;
use super::values::{Refusal, sizes};
use etalon_images::exr::{self, Part};
use etalon_images::{Image, Volume, png};
use numpy::{
    AllowTypeChange, PyArrayDescrMethods, PyArrayLikeDyn, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use std::io::Cursor;

/// The file of an array, which may stand for this `old` one: a volume stays in its box.
pub(super) fn file(
    kind: FileArray,
    value: &Bound<'_, PyAny>,
    old: Option<&[u8]>,
) -> PyResult<Result<Vec<u8>, Refusal>> {
    let array = as_array(value)?;
    let made = match kind {
        FileArray::Picture => picture(&array),
        FileArray::Volume => volume(&array, old),
    };
    Ok(made.map_err(|reason| match array.shape() {
        [] => format!("{} is no array; {reason}", named(value)),
        _ => reason,
    }))
}

/// What NumPy takes a value for.
pub(super) fn as_array<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let array = value.py().import("numpy")?;
    Ok(array.call_method1("asarray", (value,))?.cast_into()?)
}

/// Its numbers as floats, in the order of rows.
pub(super) fn floats(array: &Bound<'_, PyUntypedArray>) -> Result<Vec<f32>, Refusal> {
    let found = || format!("its numbers are {}, which are no floats", array.dtype());
    if !matches!(array.dtype().kind(), b'f' | b'i' | b'u') {
        return Err(found());
    }
    let floats: PyArrayLikeDyn<'_, f32, AllowTypeChange> = array.extract().map_err(|_| found())?;
    Ok(floats.as_array().iter().copied().collect())
}

fn picture(array: &Bound<'_, PyUntypedArray>) -> Result<Vec<u8>, Refusal> {
    let (height, width, channels) = match *array.shape() {
        [height, width] => (height, width, 1),
        [height, width, channels @ (1 | 3 | 4)] => (height, width, channels),
        ref shape => {
            return Err(format!(
                "a picture is an array of height × width, or with 1, 3 or 4 channels, not {}",
                sizes(shape)
            ));
        }
    };
    if width == 0 || height == 0 {
        return Err(format!("a picture of {height} × {width} has no pixels"));
    }
    let kind = array.dtype();
    match (kind.kind(), kind.itemsize()) {
        (b'u', 1) => {
            let bytes: PyArrayLikeDyn<'_, u8> = array.extract().map_err(|e| format!("{e}"))?;
            let bytes: Vec<u8> = bytes.as_array().iter().copied().collect();
            png::encode_channels(&bytes, [width, height], channels).map_err(|e| e.to_string())
        }
        (b'f', _) => {
            let pixels = floats(array)?;
            let names: &[&str] = match channels {
                1 => &["Y"],
                _ => &["R", "G", "B", "A"][..channels],
            };
            let mut image = Image::new(width, height);
            for (channel, name) in names.iter().enumerate() {
                let plane = pixels.iter().skip(channel).step_by(channels);
                image.push(*name, plane.copied().collect());
            }
            let part = Part {
                name: None,
                image,
                offset: [0, 0],
            };
            let mut file = Cursor::new(Vec::new());
            exr::encode(&mut file, &[part], [width, height], "").map_err(|e| e.to_string())?;
            Ok(file.into_inner())
        }
        _ => Err(format!(
            "a picture is an array of floats (linear) or of uint8 (sRGB unless `raw`), not of {kind}"
        )),
    }
}

fn volume(array: &Bound<'_, PyUntypedArray>, old: Option<&[u8]>) -> Result<Vec<u8>, Refusal> {
    let (size, channels) = match *array.shape() {
        [z, y, x] => ([x, y, z], 1),
        [z, y, x, channels @ (1 | 3 | 6)] => ([x, y, z], channels),
        ref shape => {
            return Err(format!(
                "a volume is an array along z, y and x, or with 1, 3 or 6 channels, not {}",
                sizes(shape)
            ));
        }
    };
    if size.contains(&0) {
        return Err("a volume without points has no values".to_owned());
    }
    let bounds = match old.map(Volume::decode) {
        None => [[0.0; 3], [1.0; 3]],
        Some(Ok(old)) => old.bounds,
        Some(Err(_)) => return Err("only the values of `.vol` files can be replaced".to_owned()),
    };
    let volume = Volume {
        size,
        channels,
        bounds,
        samples: floats(array)?,
        behind: 0,
    };
    Ok(volume.encode())
}
