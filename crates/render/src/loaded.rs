//! A scene that was read, and why one could not be.

use etalon_integrators::AnyIntegrator;
use etalon_params::{Diagnostic, Node, Sources, Span};
use etalon_scene::Compiled;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Why a scene cannot be used: what is wrong, and the texts in which it stands.
#[derive(Debug)]
pub struct LoadError {
    /// The messages.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts that they point into.
    pub sources: Sources,
}

/// A scene ready to be rendered.
pub struct Loaded {
    /// The scene and what belongs to it.
    pub compiled: Arc<Compiled>,
    /// The estimator.
    pub integrator: AnyIntegrator,
    /// Its name, nested ones after a slash.
    pub integrator_name: String,
    /// What the scene's file says: its parameters, and its description.
    pub described: Description,
    /// Whether the integrator objects to nothing: it finds all light that there is.
    pub complete: bool,
    /// Remarks that do not prevent rendering.
    pub notes: Vec<Diagnostic>,
    /// The texts that the remarks point into.
    pub sources: Sources,
    /// The file as it was named.
    pub path: PathBuf,
    /// Hash over everything that was read.
    pub hash: String,
    /// Time to read files and compile the description, without `build_time`.
    pub load_time: Duration,
    /// Time to build the accelerator.
    pub build_time: Duration,
    /// The files that it was read from.
    pub inputs: Vec<PathBuf>,
    /// Where the film is described, for messages about its size.
    pub(crate) film_place: Span,
}

/// What a scene's file says.
pub struct Description {
    /// The `<scene>` node.
    pub root: Arc<Node>,
    /// Its `$parameters` in the order of the file, with the values that count.
    pub parameters: Vec<(String, String)>,
}
