//! Scenes as dicts in the manner of Mitsuba 3.
//!
//! A dict is written as a text of Mitsuba's XML, an element in a line, with arrays as files beside it in memory, and read as any
//! other text: whatever XML can say, a dict can. [`Keys`] leads from the lines of messages back to the keys of the dict.

mod arrays;
mod changed_files;
pub(crate) mod changes;
mod elements;
pub(crate) mod file_arrays;
mod keys;
pub(crate) mod mesh;
mod mistakes;
mod object;
mod plugins;
mod values;

pub(crate) use keys::{Keys, NAME};
pub(crate) use values::{matrix, point};

use elements::Elements;
use etalon_formats::mitsuba::SceneInMemory;
use mistakes::Mistakes;
use object::{Ids, Object};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A dict as a text, with its arrays and the keys of its lines.
pub(crate) struct SceneDict {
    pub(crate) scene: SceneInMemory,
    pub(crate) keys: Keys,
}

impl SceneDict {
    /// Writes the text of a dict, with arrays or without.
    pub(crate) fn read(dict: &Bound<'_, PyDict>, with_arrays: bool) -> PyResult<Self> {
        let mut mistakes = Mistakes::default();
        let root = object::read(dict, String::new(), &mut Vec::new(), &mut mistakes)?;
        mistakes.raise()?;
        let scene = |root: &Object<'_>| root.kind == "scene";
        let Some(root) = root.filter(scene) else {
            let message = "the outermost dict is a scene";
            mistakes.add_with_help("type", message, "'type': 'scene'");
            return Err(mistakes.raise().expect_err("a mistake was added"));
        };
        let mut elements = Elements::new(Ids::of(&root), with_arrays);
        elements.scene(&root)?;
        elements.finish()
    }
}
