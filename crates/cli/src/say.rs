//! Standard output for results and standard error for remarks, which readers may close early.

use std::io::{ErrorKind, Write, stderr, stdout};

/// Writes a result to standard output. A reader that has seen enough is no failure.
///
/// # Errors
/// One sentence, if the result was lost otherwise: on a full disk, for example.
pub fn result(text: &str) -> Result<(), String> {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {error}"))
        }
        _ => Ok(()),
    }
}

/// Writes a remark to standard error. A write error is ignored.
pub fn remark(text: &str) {
    let _ = stderr().lock().write_all(text.as_bytes());
}
