//! Tests of the language as a whole.

mod accessors;
mod errors;
mod files;
mod hostile;
mod scenes;

use super::{ParseOptions, Parsed, parse_text};

/// Reads a text.
fn parsed(text: &str) -> Parsed {
    parse_text("a.pbrt", text, &ParseOptions::default())
}

/// Reads what stands in a world.
fn world(text: &str) -> Parsed {
    parsed(&format!("WorldBegin\n{text}"))
}

/// The scene of a world without mistakes and notes.
fn scene(text: &str) -> super::Scene {
    let parsed = parsed(text);
    assert_eq!(parsed.lines(), "");
    parsed.scene.expect("a scene without mistakes")
}
