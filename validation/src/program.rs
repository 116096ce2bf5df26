//! Which program this is: what was rendered and decided by one build belongs together.

use std::sync::OnceLock;

/// The beginning of a hash over the file of the running program (16 hexadecimal digits): two builds that
/// differ in anything, the sources included, have different ones.
///
/// # Errors
/// If the file cannot be read.
pub fn fingerprint() -> Result<&'static str, String> {
    static FINGERPRINT: OnceLock<Result<String, String>> = OnceLock::new();
    let compute = || {
        let program = std::env::current_exe().and_then(std::fs::read);
        let program = program.map_err(|e| format!("the program itself cannot be read: {e}"))?;
        Ok(blake3::hash(&program).to_hex()[..16].to_owned())
    };
    let fingerprint = FINGERPRINT.get_or_init(compute).as_ref();
    fingerprint.map(String::as_str).map_err(Clone::clone)
}
