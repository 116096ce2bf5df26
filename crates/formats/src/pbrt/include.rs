//! The files of a scene: its main one, and those that `Include` and `Import` name.
//!
//! An included file is read as if its text stood in place of the directive. An imported one, which pbrt reads in parallel, begins
//! with the state at its place and leaves none behind; here it is read at its place as well.
//!
//! pbrt looks for files in the folder of the main file, then in the current one, wherever the file stands that names them. Files that
//! are not there are looked for beside the one that names them, too.

use super::number::excerpt;
use super::open_block;
use super::reader::Reader;
use super::source_text;
use super::statement::Statement;
use crate::SearchPath;
use etalon_params::{Diagnostic, FileId, Span, Spanned};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How deep files may include files.
const MOST_NESTED_FILES: usize = 64;

/// How many files are read, counting those again that are included again.
const MOST_FILES: usize = 1 << 14;

/// How many bytes are read altogether, counting files as often as they are included.
const MOST_BYTES: u64 = 16 << 30;

/// The files that were read, and those that are being read.
#[derive(Debug, Default)]
pub(crate) struct Files {
    /// All files, in the order of reading.
    pub(crate) paths: Vec<PathBuf>,
    /// The folders of the main file and of the user.
    pub(crate) search: SearchPath,
    /// The folders of included files.
    pub(crate) included_folders: Vec<PathBuf>,
    known: HashMap<PathBuf, FileId>,
    /// The files that are being read, outermost first.
    chain: Vec<Opened>,
    count: usize,
    bytes: u64,
    /// How many of the files that are being read are imported.
    imports: usize,
}

/// A file that is being read.
#[derive(Debug)]
struct Opened {
    /// Its canonical path.
    path: PathBuf,
    /// The name in the directive that led to it.
    from: Option<Span>,
}

impl Files {
    /// Whether what is read now is part of an imported file.
    pub(crate) fn is_importing(&self) -> bool {
        self.imports > 0
    }

    /// The file for a name.
    fn find(&self, name: &str) -> Option<PathBuf> {
        self.search.find(name).or_else(|| {
            let folder = self.chain.last()?.path.parent()?;
            SearchPath::new([folder.to_owned()]).find(name)
        })
    }
}

/// Reads the main file.
pub(crate) fn main(reader: &mut Reader<'_>, path: &Path) {
    let beside = path.parent().map(Path::to_owned).unwrap_or_default();
    let folders = [beside, PathBuf::new()].into_iter();
    reader.files.search = SearchPath::new(folders.chain(reader.options.search.iter().cloned()));
    let real = canonical(path);
    let found = match path.is_dir() {
        true => Err("it is a folder".to_owned()),
        false => open(reader, path, &real),
    };
    match found {
        Ok((file, text)) => read(reader, real, None, file, &text),
        Err(why) => {
            let message = format!("cannot read `{}`: {why}", path.display());
            reader.mistakes.give_up(Diagnostic::error_nowhere(message));
        }
    }
}

/// Reads a text in place of the main file.
pub(crate) fn text(reader: &mut Reader<'_>, name: &str, text: &str) {
    let folders = std::iter::once(PathBuf::new());
    reader.files.search = SearchPath::new(folders.chain(reader.options.search.iter().cloned()));
    if text.len() as u64 > source_text::MOST_BYTES {
        let message = format!("`{name}` has more than {} bytes", source_text::MOST_BYTES);
        reader.mistakes.give_up(Diagnostic::error_nowhere(message));
        return;
    }
    let file = reader.sources.add(name, text);
    reader.text(file, text);
}

pub(crate) fn include(reader: &mut Reader<'_>, statement: Statement) {
    named(reader, &statement.name(0));
}

pub(crate) fn import(reader: &mut Reader<'_>, statement: Statement) {
    let state = reader.state.clone();
    let floor = std::mem::replace(&mut reader.floor, reader.blocks.len());
    let replaced = reader.coordinate_systems.replaced.len();
    reader.files.imports += 1;
    named(reader, &statement.name(0));
    reader.files.imports -= 1;
    open_block::close_all(reader);
    reader.floor = floor;
    reader.state = state;
    let systems = &mut reader.coordinate_systems;
    for (name, before) in systems.replaced.split_off(replaced).into_iter().rev() {
        match before {
            Some(placement) => systems.placements.insert(name, placement),
            None => systems.placements.remove(&name),
        };
    }
}

/// Reads the file of a name.
fn named(reader: &mut Reader<'_>, name: &Spanned<String>) {
    let shown = excerpt(&name.value);
    let Some(path) = reader.files.find(&name.value) else {
        let message = format!("the file `{shown}` was not found");
        let help = reader.files.search.why_not(&name.value);
        reader.report(Diagnostic::error(name.span, message).help(help));
        return;
    };
    let real = canonical(&path);
    let files = &reader.files;
    let circle = files.chain.iter().position(|opened| opened.path == real);
    if let Some(first) = circle {
        let chain = files.chain[first..].iter().map(|opened| &opened.path);
        let names: Vec<String> = chain.chain([&real]).map(|path| file_name(path)).collect();
        let message = format!("files include each other: {}", names.join(" → "));
        let from = files.chain.iter().filter_map(|opened| opened.from);
        let mistake = from.fold(Diagnostic::error(name.span, message), |mistake, span| {
            mistake.related(span, "included from here")
        });
        reader.report(mistake);
        return;
    }
    if files.chain.len() > MOST_NESTED_FILES {
        let message = format!("files are included more than {MOST_NESTED_FILES} levels deep");
        reader.report(Diagnostic::error(name.span, message));
        return;
    }
    match open(reader, &path, &real) {
        Ok((file, text)) => {
            let excess = if reader.files.count > MOST_FILES {
                Some(format!("the scene includes more than {MOST_FILES} files"))
            } else if reader.files.bytes > MOST_BYTES {
                Some(format!("the scene has more than {MOST_BYTES} bytes"))
            } else {
                None
            };
            if let Some(message) = excess {
                reader
                    .mistakes
                    .give_up(Diagnostic::error(name.span, message));
                return;
            }
            read(reader, real, Some(name.span), file, &text);
        }
        Err(why) => {
            let message = format!("cannot read the file `{shown}`: {why}");
            reader.report(Diagnostic::error(name.span, message));
        }
    }
}

/// Reads the directives of a file that was opened.
fn read(reader: &mut Reader<'_>, path: PathBuf, from: Option<Span>, file: FileId, text: &str) {
    reader.files.chain.push(Opened { path, from });
    reader.text(file, text);
    reader.files.chain.pop();
}

/// The text of a file, which is read from the disk only once. `real` is its canonical path.
fn open(reader: &mut Reader<'_>, path: &Path, real: &Path) -> Result<(FileId, Arc<str>), String> {
    let known = reader.files.known.get(real).copied();
    let (file, text) = match known {
        Some(file) => (file, reader.sources.text(file).clone()),
        None => {
            let text: Arc<str> = source_text::read(path)?.into();
            let name = path.display().to_string();
            let file = reader.sources.add(name, text.clone());
            let files = &mut reader.files;
            files.known.insert(real.to_owned(), file);
            files.paths.push(path.to_owned());
            // The main file's folder is searched anyway.
            let folder = path.parent().filter(|_| files.paths.len() > 1);
            if let Some(folder) = folder
                && files
                    .included_folders
                    .last()
                    .is_none_or(|last| last != folder)
            {
                files.included_folders.push(folder.to_owned());
            }
            (file, text)
        }
    };
    reader.files.count += 1;
    reader.files.bytes += text.len() as u64;
    Ok((file, text))
}

fn canonical(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}
