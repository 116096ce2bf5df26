//! Writing a file so that it is either the old one or the whole new one, never a part.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Calls `write` with a buffered new file, then puts that file in the place of `path`.
///
/// The new file lies beside `path` under a temporary name until it is complete and on the disk;
/// renaming it is one step for every reader. If `write` fails, or the process is killed, `path`
/// is what it was (a killed process may leave the temporary file, `.NAME.PID-N.part`, where a long
/// NAME is cut). A
/// symbolic link stays one: the file it points to is replaced, or made if it does not exist yet.
/// Something that is not a regular file, such as a device or a pipe, cannot be replaced and is
/// written directly.
///
/// # Errors
/// Those of `write` and of the operating system.
pub fn write_atomically<T>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
) -> io::Result<T> {
    let path = &target(path)?;
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

/// Where symbolic links lead from `path`; what stands there need not exist.
///
/// # Errors
/// If there are more than 40 links, as in a circle.
pub fn target(path: &Path) -> io::Result<PathBuf> {
    if let Ok(real) = fs::canonicalize(path) {
        return Ok(real);
    }
    let mut path = path.to_owned();
    // A link to a pipe, such as /dev/stdout, leads to something without a path.
    if path.exists() {
        return Ok(path);
    }
    // As many as Linux follows.
    for _ in 0..40 {
        match fs::read_link(&path) {
            // A relative link counts from its own folder.
            Ok(link) => path = path.parent().unwrap_or(Path::new("")).join(link),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::new(
        ErrorKind::InvalidInput,
        "too many levels of symbolic links",
    ))
}

/// A new file in the folder of `path`, created exclusively.
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
        let temporary = path.with_file_name(hidden(name, &format!(".{process}-{attempt}.part")));
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

/// The bytes that a name may have.
const LONGEST: usize = 255;

/// A hidden name that ends so, with as much of `name` as there is room for.
fn hidden(name: &OsStr, suffix: &str) -> OsString {
    let mut hidden = OsString::from(".");
    if 1 + name.len() + suffix.len() <= LONGEST {
        hidden.push(name);
    } else {
        let mut most = LONGEST - 1 - suffix.len();
        let name = name.to_string_lossy();
        while !name.is_char_boundary(most) {
            most -= 1;
        }
        hidden.push(&name[..most]);
    }
    hidden.push(suffix);
    hidden
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    /// The link stays, also where its target is not there yet, through a second link, and where
    /// the target is named from the link's folder.
    #[test]
    fn links_are_written_through() {
        let folder = tempfile::tempdir().expect("a folder");
        let disk = folder.path().join("disk");
        fs::create_dir(&disk).expect("a folder");
        fs::write(disk.join("old"), "old").expect("written");
        let links = [
            ("absolute", disk.join("old")),
            ("relative", PathBuf::from("disk/old")),
            ("dangling", PathBuf::from("disk/new")),
            ("second", PathBuf::from("dangling")),
        ];
        for (name, to) in &links {
            symlink(to, folder.path().join(name)).expect("linked");
        }
        for (name, to) in &links {
            let link = folder.path().join(name);
            write_atomically(&link, |file| file.write_all(name.as_bytes())).expect("written");
            assert_eq!(&fs::read_link(&link).expect("still a link"), to);
            assert_eq!(fs::read_to_string(&link).expect("reads"), *name);
        }
        let read = |name| fs::read_to_string(disk.join(name)).expect("reads");
        assert_eq!(
            (read("old"), read("new")),
            ("relative".into(), "second".into())
        );
        // No temporary file is left in either folder.
        assert_eq!(fs::read_dir(&disk).expect("lists").count(), 2);
        assert_eq!(fs::read_dir(folder.path()).expect("lists").count(), 5);

        let nowhere = folder.path().join("nowhere");
        symlink("missing/file", &nowhere).expect("linked");
        write_atomically(&nowhere, |_| Ok(())).expect_err("no such folder");
        symlink("loop", folder.path().join("loop")).expect("linked");
        write_atomically(&folder.path().join("loop"), |_| Ok(())).expect_err("a circle");
        assert!(fs::read_link(&nowhere).is_ok());
    }

    /// A name of 255 bytes is legal, and its temporary one must be.
    #[test]
    fn long_names_are_written() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in [
            "a".repeat(251) + ".exr",
            "光".repeat(83) + "ab.exr",
            "光".repeat(85),
        ] {
            let path = folder.path().join(&name);
            write_atomically(&path, |file| file.write_all(b"x")).expect("written");
            assert_eq!(fs::read(&path).expect("reads"), b"x");
        }
        let longer = folder.path().join("a".repeat(256));
        write_atomically(&longer, |_| Ok(())).expect_err("too long");
        assert_eq!(fs::read_dir(folder.path()).expect("lists").count(), 3);
    }
}
