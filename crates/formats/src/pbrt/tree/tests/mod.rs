//! Tests of the mapping: a text of pbrt against the XML that means the same.

mod changed;
mod entities;
mod evaluated;
mod forms;
mod grids;
mod hostile;
mod lights;
mod materials;
mod mistakes;
mod scenes;
mod settings;
mod shapes;
mod texture_values;
mod textures;
mod written;

use crate::same_tree::{assert_alike, children, numbers, shown, shown_value, xml};
use crate::{Document, ReadOptions, ReadOutcome, pbrt};
use etalon_params::{Node, SpectrumText, Value};

/// Reads a text of pbrt.
fn read(text: &str) -> ReadOutcome {
    pbrt::read_text("a.pbrt", text, &ReadOptions::default())
}

/// Reads what stands in a world.
fn world(text: &str) -> ReadOutcome {
    read(&format!("WorldBegin\n{text}"))
}

/// The document of a text without mistakes and notes.
fn sound(text: &str) -> Document {
    let outcome = read(text);
    assert_eq!(outcome.lines(), "");
    outcome.document.expect("a document")
}

/// Asserts that a pbrt text has, of the classes that the XML has, the same objects.
#[track_caller]
fn assert_same(pbrt: &str, mitsuba: &str) {
    let (found, expected) = (sound(pbrt), xml(mitsuba));
    assert_alike(&found, &expected);
}

/// The same of what stands in a world.
#[track_caller]
fn assert_same_world(pbrt: &str, mitsuba: &str) {
    assert_same(&format!("WorldBegin\n{pbrt}"), mitsuba);
}
