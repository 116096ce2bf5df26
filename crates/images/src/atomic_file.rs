//! Writing a file so that it is either the old one or the whole new one, never a part.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Calls `write` with a buffered new file, then puts that file in the place of `path`.
///
/// The new file lies beside `path` under a temporary name until it is complete and on the disk;
/// renaming it is one step for every reader. If `write` fails, or the process is killed, `path`
/// is what it was (a killed process may leave the temporary file, `.NAME.PID-N.part`). A
/// symbolic link stays one: the file it points to is replaced. Something that is not a regular
/// file, such as a device or a pipe, cannot be replaced and is written directly.
///
/// # Errors
/// Whatever `write` or the operating system report.
pub fn write_atomically<T>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
) -> io::Result<T> {
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
        let mut device = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        let value = write(&mut device)?;
        device.flush()?;
        return Ok(value);
    }
    let (temporary, file) = create_beside(path)?;
    let written = (|| {
        let mut buffered = BufWriter::with_capacity(1 << 16, file);
        let value = write(&mut buffered)?;
        buffered.flush()?;
        let file = buffered
            .into_inner()
            .map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        drop(file);
        fs::rename(&temporary, path)?;
        Ok(value)
    })();
    if written.is_err() {
        // The first error is the one worth reporting; the file may not even be there any more.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// A new file in the folder of `path` that nobody else has open.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    let Some(name) = path.file_name() else {
        return Err(io::Error::new(
            ErrorKind::InvalidInput,
            "the path names no file",
        ));
    };
    if path.is_dir() {
        return Err(io::Error::new(
            ErrorKind::IsADirectory,
            "the path names a directory",
        ));
    }
    let process = std::process::id();
    for attempt in 0..1000 {
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{process}-{attempt}.part"));
        let temporary = path.with_file_name(hidden);
        match OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&temporary)
        {
            Ok(file) => return Ok((temporary, file)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::new(
        ErrorKind::AlreadyExists,
        "no free temporary name beside the file",
    ))
}
