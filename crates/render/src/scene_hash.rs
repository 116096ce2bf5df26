//! What tells one scene from another, as a hash.

use crate::load_options::LoadOptions;
use blake3::Hasher;
use etalon_film::Framing;
use etalon_formats::{Document, FileAssets};
use std::fs::File;
use std::io;
use std::path::Path;

/// A hash over everything that decides the scene: its files, the files it refers to, and what
/// the command line said.
pub(crate) fn scene_hash(
    document: &Document,
    assets: &FileAssets,
    options: &LoadOptions,
) -> String {
    let mut hasher = Hasher::new();
    for file in &document.files {
        add(&mut hasher, &file.bytes);
    }
    for path in assets.used() {
        // A file that cannot be read now could not be read before either.
        if add_file(&mut hasher, &path).is_err() {
            add(&mut hasher, &[]);
        }
    }
    let mut add = |bytes: &[u8]| add(&mut hasher, bytes);
    for (key, value) in &options.defines {
        add(key.as_bytes());
        add(value.as_bytes());
    }
    if let Some(name) = &options.integrator {
        add(name.as_bytes());
    }
    if let Some(kind) = options.light_chooser {
        add(kind.name().as_bytes());
    }
    if options.time != 0.0 {
        add(&options.time.to_le_bytes());
    }
    if let Some(sensor) = &options.sensor {
        add(format!("{sensor:?}").as_bytes());
    }
    if options.framing != Framing::default() {
        add(options.framing.to_string().as_bytes());
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

/// The hash of a scene in which something was changed that no file says.
pub fn changed(hash: &str, changes: &str) -> String {
    let mut hasher = Hasher::new();
    add(&mut hasher, hash.as_bytes());
    add(&mut hasher, changes.as_bytes());
    hasher.finalize().to_hex()[..16].to_owned()
}

/// A hash of some contents.
pub fn of_contents(contents: &[u8]) -> String {
    blake3::hash(contents).to_hex()[..16].to_owned()
}

fn add(hasher: &mut Hasher, bytes: &[u8]) {
    hasher.update(&(bytes.len() as u64).to_le_bytes());
    hasher.update(bytes);
}

/// As [`add`], without holding all of the file.
fn add_file(hasher: &mut Hasher, path: &Path) -> io::Result<()> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    hasher.update(&length.to_le_bytes());
    hasher.update_reader(file)?;
    Ok(())
}
