//! Scene files of pbrt-v4.
//!
//! [`parse`] turns a file, with everything it includes, into a [`Scene`]: entities such as shapes, lights and materials, each with
//! the graphics state at its place, in which all names are resolved. It knows the language (tokens, parameter lists, directives, blocks,
//! transforms), the types of entities and the options; what parameters an entity takes is for those to say who read it with
//! [`Scene::parameters`]. Everything keeps its place, and reading goes on after a mistake, so that one run reports all of them.
//!
//! A file passes through it in this order: `source_text` makes it a text, `tokens` its tokens, `statement` a directive with its
//! arguments, of which `parameter_syntax` reads the parameters; `directive` lists what is then done, and `finish` looks at the
//! whole. [`read`] goes on from there: `tree` turns the entities into the description tree.
//!
//! It is stricter than pbrt, which overlooks some mistakes: parameters that nobody asked for or that are given twice, unknown
//! coordinate systems, and parameters of textures. It is more tolerant in one point: names may be used before they are defined, as
//! nothing is ambiguous about that, and objects may contain instances.

mod arrays;
mod ctm;
mod definitions;
mod directive;
mod finish;
mod include;
mod kinds;
mod mistakes;
mod number;
mod open_block;
mod options;
mod order;
mod parameter;
mod parameter_syntax;
mod parameters;
mod placement;
mod quoted;
mod reader;
mod scene;
mod settings;
mod source_text;
mod spectrum_value;
mod state;
mod statement;
#[cfg(test)]
mod tests;
mod tokens;
mod tree;
mod value_syntax;
mod world;

use crate::document::{ReadOptions, ReadOutcome};
use etalon_params::{Diagnostic, Diagnostics, Severity, Sources};
pub use options::Options;
pub use parameter::{ColorSpace, Parameter, ParameterList, ParameterType, Values};
pub use parameters::Parameters;
pub use placement::Placement;
use reader::Reader;
pub use scene::{
    Camera, Entity, Instance, Light, Material, MaterialId, Medium, MediumId, Object, ObjectId,
    Scene, Shape, Texture, TextureId, TextureKind,
};
pub use spectrum_value::{FloatOrSpectrum, FloatOrTexture, SpectrumOrTexture, SpectrumValue};
use std::path::{Path, PathBuf};

/// What may be said about a scene from outside of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParseOptions {
    /// Further folders to look for files in, after the scene's own and the current one.
    pub search: Vec<PathBuf>,
}

/// What came of reading a scene.
#[derive(Debug)]
pub struct Parsed {
    /// The texts that all positions refer to.
    pub sources: Sources,
    /// Mistakes and notes, in the order of the files; last those that have no place.
    pub diagnostics: Vec<Diagnostic>,
    /// The scene. After mistakes it may still be there, with stand-ins and without what was broken, so that further mistakes can be
    /// looked for in it; it must not be rendered.
    pub scene: Option<Scene>,
}

impl Parsed {
    /// Whether there was any mistake.
    pub fn has_errors(&self) -> bool {
        let mut severities = self.diagnostics.iter().map(|d| d.severity);
        severities.any(|severity| severity == Severity::Error)
    }

    /// The scene if there was no mistake.
    pub fn sound(&self) -> Option<&Scene> {
        self.scene.as_ref().filter(|_| !self.has_errors())
    }

    /// The diagnostics, each on a line of its own.
    pub fn lines(&self) -> String {
        let lines = self.diagnostics.iter().map(|d| d.one_line(&self.sources));
        lines.collect::<Vec<String>>().join("\n")
    }
}

/// Reads the scene file at `path`, as [`parse`] does, and turns it into the description tree, as [`crate::mitsuba::read`] does with
/// Mitsuba's files. After a mistake there is no document, as most entities depend on others.
pub fn read(path: &Path, options: &ReadOptions) -> ReadOutcome {
    let search = options.search.clone();
    mapped(parse(path, &ParseOptions { search }), options)
}

/// The same of a text; files that it names are looked for in the current folder first.
pub fn read_text(name: &str, text: &str, options: &ReadOptions) -> ReadOutcome {
    let search = options.search.clone();
    mapped(parse_text(name, text, &ParseOptions { search }), options)
}

fn mapped(parsed: Parsed, options: &ReadOptions) -> ReadOutcome {
    let diagnostics = Diagnostics::new();
    let mut sources = parsed.sources.clone();
    let integrator = options.integrator.as_ref();
    let integrator = integrator.map(|name| sources.add("--integrator", name.as_str()));
    for (name, _) in &options.defines {
        let message = format!("scenes of pbrt have no parameters: `{name}` cannot be set by `-D`");
        diagnostics.push(Diagnostic::error_nowhere(message));
    }
    let document = parsed
        .sound()
        .map(|scene| tree::document(scene, options, integrator, &diagnostics));
    parsed
        .diagnostics
        .into_iter()
        .for_each(|d| diagnostics.push(d));
    let is_sound = !diagnostics.has_errors();
    ReadOutcome {
        sources,
        diagnostics: diagnostics.into_sorted(),
        document: document.filter(|_| is_sound),
        stand_ins: Vec::new(),
    }
}

/// Reads the scene file at `path`, which may be compressed with gzip.
pub fn parse(path: &Path, options: &ParseOptions) -> Parsed {
    parsed(options, |reader| include::main(reader, path))
}

/// Reads a scene from a text; files that it names are looked for in the current folder first.
pub fn parse_text(name: &str, text: &str, options: &ParseOptions) -> Parsed {
    parsed(options, |reader| include::text(reader, name, text))
}

fn parsed(options: &ParseOptions, read: impl FnOnce(&mut Reader<'_>)) -> Parsed {
    let mut reader = Reader::new(options);
    read(&mut reader);
    let (sources, diagnostics, scene) = finish::finish(reader);
    Parsed {
        sources,
        diagnostics,
        scene,
    }
}
