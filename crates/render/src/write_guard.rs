//! What stands between a command and the files of its user: nothing is written over what was read.
//!
//! A command says what it reads, and claims every file that it will write; only what was claimed is a
//! [`Destination`], and only a destination is written to.

use etalon_images::write_atomically;
use std::fmt::Display;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What a command reads, and what it will write.
#[derive(Clone, Debug, Default)]
pub struct WriteGuard {
    read: Vec<PathBuf>,
    claimed: Vec<PathBuf>,
}

/// A file that may be written: there is a place for it, and nothing was read from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination(PathBuf);

impl WriteGuard {
    /// That of a command which reads these files.
    pub fn of<P: Into<PathBuf>>(read: impl IntoIterator<Item = P>) -> Self {
        Self {
            read: read.into_iter().map(Into::into).collect(),
            claimed: Vec::new(),
        }
    }

    /// A file that the command will write.
    ///
    /// # Errors
    /// One sentence, if it cannot be created, or if the command already reads or writes it, under any name.
    pub fn claim(&mut self, path: &Path) -> Result<Destination, String> {
        check_place(path)?;
        if self.claimed.iter().any(|other| same(other, path)) {
            return Err(format!("{} would be written twice", path.display()));
        }
        self.refuse_one_of(&self.read, path)?;
        self.claimed.push(path.to_owned());
        Ok(Destination(path.to_owned()))
    }

    /// As [`WriteGuard::claim`], of an image that can only be an OpenEXR file.
    ///
    /// # Errors
    /// If its name says otherwise, and as there.
    pub fn claim_exr(&mut self, path: &Path) -> Result<Destination, String> {
        let extension = path.extension().unwrap_or_default();
        if extension.eq_ignore_ascii_case("exr") {
            return self.claim(path);
        }
        let path = path.display();
        Err(format!("cannot write {path}: the name must end in .exr"))
    }

    /// Further files, which turned out to be read after the claims: those that a scene names.
    ///
    /// # Errors
    /// One sentence, if one of them was claimed.
    pub fn reads(&mut self, inputs: &[PathBuf]) -> Result<(), String> {
        let mut claimed = self.claimed.iter();
        claimed.try_for_each(|path| self.refuse_one_of(inputs, path))?;
        self.read.extend_from_slice(inputs);
        Ok(())
    }

    fn refuse_one_of(&self, inputs: &[PathBuf], path: &Path) -> Result<(), String> {
        // A device or a pipe may well be both.
        let clash = inputs
            .iter()
            .find(|input| input.is_file() && same(input, path));
        match clash {
            Some(input) if input == path => Err(format!(
                "cannot write {}: it is read from; give the output another name",
                path.display()
            )),
            Some(input) => Err(format!(
                "cannot write {}: it is {}, which is read from; give the output another name",
                path.display(),
                input.display()
            )),
            None => Ok(()),
        }
    }
}

impl Destination {
    /// Its name.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a text, all of it or nothing.
    ///
    /// # Errors
    /// One sentence.
    pub fn write_text(&self, text: &str) -> Result<(), String> {
        write_atomically(&self.0, |file| file.write_all(text.as_bytes()))
            .map_err(|error| format!("cannot write {}: {error}", self.0.display()))
    }

    /// Lets a writer that puts whole files in their place do so.
    ///
    /// # Errors
    /// What the writer says.
    pub fn write_with<T, E: Display>(
        &self,
        write: impl FnOnce(&Path) -> Result<T, E>,
    ) -> Result<T, String> {
        write(&self.0).map_err(|error| error.to_string())
    }
}

/// Whether two names are of one file, be it through links of either kind.
fn same(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| fs::canonicalize(path).ok();
    a == b || place(a).is_some_and(|a| Some(a) == place(b)) || linked(a, b)
}

/// Whether two names are hard links to one file.
#[cfg(unix)]
fn linked(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let number = |path: &Path| fs::metadata(path).ok().map(|file| (file.dev(), file.ino()));
    number(a).is_some_and(|a| Some(a) == number(b))
}

#[cfg(not(unix))]
fn linked(_: &Path, _: &Path) -> bool {
    false
}

/// Refuses a place where no file can be made.
fn check_place(path: &Path) -> Result<(), String> {
    let refuse = |reason: &dyn Display| Err(format!("cannot write {}: {reason}", path.display()));
    if path.as_os_str() == "-" {
        return refuse(&"standard output is /dev/stdout, and a file of this name is ./-");
    }
    // The file that a symbolic link names is made where it leads.
    let path = match etalon_images::atomic_file::target(path) {
        Ok(target) => target,
        Err(error) => return refuse(&error),
    };
    if path.is_dir() {
        return refuse(&"it is a folder");
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if folder.is_some_and(|folder| !folder.is_dir()) {
        return refuse(&"there is no such folder");
    }
    // A device is written to as it is; a file is written beside its old self and takes its place.
    let place = fs::canonicalize(&path).unwrap_or(path);
    if place.exists() && !place.is_file() {
        return Ok(());
    }
    // Only trying tells whether a file can be made there, and whether its name is one that the disk can hold.
    if let Err(error) = fs::symlink_metadata(&place)
        && error.kind() != std::io::ErrorKind::NotFound
    {
        return refuse(&error);
    }
    let trial = place.with_file_name(format!(".etalon-{}.part", std::process::id()));
    let made = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&trial)
        .and_then(|_| fs::remove_file(&trial));
    made.or_else(|error| refuse(&error))
}
