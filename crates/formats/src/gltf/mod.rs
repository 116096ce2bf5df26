//! Scenes of glTF 2.0 (Khronos, *glTF 2.0 Specification*, ISO/IEC 12113:2022), `.gltf` and `.glb`.
//!
//! A file passes through it in this order: `container` finds the JSON and the buffer within the file, the crate `gltf` reads and
//! validates the JSON (`check` says what of it is wrong, and where), `extensions` what it asks for; then `scene` walks over
//! the nodes and makes the description tree, the one that the reader of Mitsuba's XML makes. `accessors` and `buffers` read
//! numbers: a file's claims about sizes are held against its bytes before memory is asked for.
//!
//! What has no equal is an error where the file requires it, else a note; nothing is dropped silently.

mod accessors;
mod animation;
mod bounds;
mod buffers;
mod cameras;
mod check;
mod container;
mod emission;
mod extensions;
mod film;
mod images;
mod lights;
mod materials;
mod nodes;
mod normal_map;
mod opacity;
mod places;
mod pose;
mod primitives;
mod reader;
mod resource;
mod scene;
mod shapes;
mod surroundings;
#[cfg(test)]
mod tests;
mod textures;
mod topology;
mod volume;

use crate::document::{Document, ReadOptions, ReadOutcome, SourceFile};
use crate::{SearchPath, read_bounded};
use etalon_params::{Diagnostic, Diagnostics, Sources};
use places::Places;
use reader::Reader;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest file that is read.
const MOST_BYTES: u64 = u32::MAX as u64;

/// Reads the scene file at `path`. After a mistake there is no document.
pub fn read(path: &Path, options: &ReadOptions) -> ReadOutcome {
    let name = path.display().to_string();
    match read_bounded(path, MOST_BYTES) {
        Ok(bytes) => outcome(&name, path, bytes, options),
        Err(reason) => {
            let diagnostics = Diagnostics::new();
            let message = format!("cannot read `{name}`: {reason}");
            diagnostics.push(Diagnostic::error_nowhere(message));
            finished(Sources::default(), diagnostics, None)
        }
    }
}

/// The same of the bytes of a file; files that it names are looked for in the current folder.
pub fn read_bytes(name: &str, bytes: &[u8], options: &ReadOptions) -> ReadOutcome {
    outcome(name, Path::new(name), bytes.to_vec(), options)
}

fn outcome(name: &str, path: &Path, bytes: Vec<u8>, options: &ReadOptions) -> ReadOutcome {
    let diagnostics = Diagnostics::new();
    for (parameter, _) in &options.defines {
        let message =
            format!("scenes of glTF have no parameters: `{parameter}` cannot be set by `-D`");
        diagnostics.push(Diagnostic::error_nowhere(message));
    }
    let mut sources = Sources::default();
    let bytes = Arc::new(bytes);
    let parts = match container::split(&bytes) {
        Ok(parts) => parts,
        Err(reason) => {
            diagnostics.push(Diagnostic::error_nowhere(format!("`{name}`: {reason}")));
            return finished(sources, diagnostics, None);
        }
    };
    let file = sources.add(name, &*parts.json);
    let root = match check::parse(&parts.json, file) {
        Ok(root) => root,
        Err(mistake) => {
            diagnostics.push(mistake);
            return finished(sources, diagnostics, None);
        }
    };
    let places = Places::of(&parts.json);
    let mut search = SearchPath::new(path.parent().map(Path::to_owned));
    search.append(PathBuf::new());
    options.search.iter().for_each(|f| search.append(f.clone()));
    let reader = Reader::new(&root, (&parts.json, &places), file, &diagnostics, search);
    check::validate(&reader);
    extensions::judge(&reader);
    let document = (!diagnostics.has_errors()).then(|| {
        let mut reader = reader.with_binary(parts.binary);
        let root = scene::root(&mut reader, options, &mut sources);
        let main = SourceFile {
            path: path.to_owned(),
            bytes: Arc::clone(&bytes),
        };
        Document {
            root,
            search: reader.search,
            files: std::iter::once(main).chain(reader.files).collect(),
            parameters: Vec::new(),
            meshes: reader.meshes,
            embedded: reader.images,
        }
    });
    finished(sources, diagnostics, document)
}

fn finished(sources: Sources, diagnostics: Diagnostics, document: Option<Document>) -> ReadOutcome {
    let is_sound = !diagnostics.has_errors();
    ReadOutcome {
        sources,
        diagnostics: diagnostics.into_sorted(),
        document: document.filter(|_| is_sound),
        stand_ins: Vec::new(),
    }
}
