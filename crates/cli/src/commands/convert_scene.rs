//! `etalon convert-scene`: a scene of any language that is read, as Mitsuba's XML.

use super::{answer, fail};
use crate::args::ConvertSceneArgs;
use crate::diagnose;
use etalon_formats::mitsuba::{WrittenScene, write};
use etalon_formats::{Document, ReadOptions, is_scene, read, scene_endings};
use etalon_images::write_atomically;
use etalon_render::write_guard::WriteGuard;
use std::cell::RefCell;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Writes the scene.
pub fn run(args: &ConvertSceneArgs) -> ExitCode {
    if !is_scene(&args.input) {
        let input = args.input.display();
        return fail(format!(
            "`{input}` is no scene: its name must end in one of {}",
            scene_endings()
        ));
    }
    let outcome = read(&args.input, &ReadOptions::default());
    diagnose::print(&outcome.diagnostics, &outcome.sources);
    let Some(document) = outcome.sound() else {
        return ExitCode::from(super::BAD_INPUT);
    };
    match convert(args, document) {
        Ok(text) => answer(&text, ExitCode::SUCCESS),
        Err(message) => fail(message),
    }
}

fn convert(args: &ConvertSceneArgs, document: &Document) -> Result<String, String> {
    let output = &args.output;
    if !output
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("xml"))
    {
        let output = output.display();
        return Err(format!(
            "cannot write `{output}`: the name must end in .xml"
        ));
    }
    let mut guard = WriteGuard::of([&args.input]);
    let destination = guard.claim(output)?;
    let folder = output.parent().unwrap_or(Path::new(""));
    let read: Vec<PathBuf> = document.files.iter().map(|f| f.path.clone()).collect();
    guard.reads(&read)?;
    let named = RefCell::new(Vec::new());
    let place = |name: &str| match document.search.find(name) {
        Some(path) => {
            let found = place_from(folder, &path);
            named.borrow_mut().push(path);
            found
        }
        // Whoever renders the scene says that it is not there.
        None => name.to_owned(),
    };
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let WrittenScene { xml, files } = write(document, &stem, &place);
    guard.reads(&named.take())?;
    let beside: Result<Vec<_>, String> = files
        .iter()
        .map(|(name, bytes)| Ok((guard.claim(&folder.join(name))?, bytes)))
        .collect();
    for (beside, bytes) in beside? {
        write_atomically(beside.path(), |file| file.write_all(bytes))
            .map_err(|error| format!("cannot write {}: {error}", beside.path().display()))?;
    }
    destination.write_text(&xml)?;
    Ok(match files.len() {
        0 => format!("{}\n", output.display()),
        count => format!("{} and {count} files beside it\n", output.display()),
    })
}

/// The name of a file as seen from a folder: relative if it is in it, else from the root.
fn place_from(folder: &Path, path: &Path) -> String {
    let whole = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = if folder == Path::new("") {
        Path::new(".")
    } else {
        folder
    };
    let (folder, path) = (whole(folder), whole(path));
    let seen = path.strip_prefix(&folder).unwrap_or(&path);
    seen.to_string_lossy().into_owned()
}
