//! What goes wrong, as Python's exceptions.

use crate::dict::Keys;
use etalon_film::ReadError;
use etalon_images::Error;
use etalon_params::{Diagnostic, Severity, Sources};
use etalon_render::pipeline::LoadError;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::fmt::Display;
use std::io;

pyo3::create_exception!(
    etalon,
    SceneError,
    PyValueError,
    "A scene has mistakes.\n\nThe message has a line `file:line:column: error: …` for each, or `key.path: error: …` in a \
     dict; `diagnostics` is a list of dicts with severity, message, help, key, file, line and column (both from 1)."
);

/// A scene that could not be loaded.
pub(crate) fn scene_error(error: &LoadError, keys: &Keys) -> PyErr {
    of_diagnostics(&error.diagnostics, &error.sources, keys)
}

/// Messages about a scene, with its texts and the keys of its dict.
pub(crate) fn of_diagnostics(diagnostics: &[Diagnostic], sources: &Sources, keys: &Keys) -> PyErr {
    exception(sources, || {
        let said = diagnostics.iter();
        said.map(|d| (keys.one_line(d, sources), d, keys.of(d, sources)))
    })
}

/// Messages about a dict alone: each in one line, and with its key path.
pub(crate) fn of_keys<'a>(
    said: impl Iterator<Item = (String, &'a Diagnostic, &'a String)> + Clone,
) -> PyErr {
    exception(&Sources::default(), || {
        said.clone()
            .map(|(line, d, key)| (line, d, Some(key.as_str())))
    })
}

fn exception<'a, Said: Iterator<Item = (String, &'a Diagnostic, Option<&'a str>)>>(
    sources: &Sources,
    said: impl Fn() -> Said,
) -> PyErr {
    let lines: Vec<String> = said().map(|(line, ..)| line).collect();
    let error = SceneError::new_err(lines.join("\n"));
    let attached = Python::attach(|py| {
        let dicts = said().map(|(_, diagnostic, key)| as_dict(py, diagnostic, key, sources));
        let list = PyList::new(py, dicts.collect::<PyResult<Vec<_>>>()?)?;
        error.value(py).setattr("diagnostics", list)
    });
    attached.err().unwrap_or(error)
}

fn as_dict<'py>(
    py: Python<'py>,
    diagnostic: &Diagnostic,
    key: Option<&str>,
    sources: &Sources,
) -> PyResult<Bound<'py, PyDict>> {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Note => "note",
    };
    let file = diagnostic.span.map(|span| sources.name(span.file));
    let position = diagnostic.span.map(|span| sources.position(span));
    let dict = PyDict::new(py);
    dict.set_item("severity", severity)?;
    dict.set_item("message", &diagnostic.message)?;
    dict.set_item("help", &diagnostic.help)?;
    dict.set_item("key", key)?;
    dict.set_item("file", file)?;
    dict.set_item("line", position.map(|(line, _)| line))?;
    dict.set_item("column", position.map(|(_, column)| column))?;
    Ok(dict)
}

/// An argument that cannot be used.
pub(crate) fn value_error(reason: impl Display) -> PyErr {
    PyValueError::new_err(reason.to_string())
}

/// A picture that could not be read or written: of the operating system's kind if that refuses, else a `ValueError`.
pub(crate) fn image_error(error: &Error) -> PyErr {
    match error {
        Error::Read { source, .. } | Error::Write { source, .. } => {
            io::Error::new(source.kind(), error.to_string()).into()
        }
        other => value_error(other),
    }
}

/// An image that could not be read.
pub(crate) fn read_error(error: &ReadError) -> PyErr {
    match error {
        ReadError::Image(error) => image_error(error),
        other => value_error(other),
    }
}

/// A place where no file can be written.
pub(crate) fn place_error(reason: String) -> PyErr {
    PyOSError::new_err(reason)
}
