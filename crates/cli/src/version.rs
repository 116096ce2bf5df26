//! `etalon --version --verbose`: what one should say of a build when reporting what it did.

use etalon_render::{VERSION, machine};
use std::ffi::OsString;

/// The commit that was built, if it was built from a repository.
const COMMIT: Option<&str> = option_env!("ETALON_COMMIT");

/// Whether the arguments are `--version` and `--verbose`, in either order.
pub fn is_asked_for(args: impl Iterator<Item = OsString>) -> bool {
    let args: Vec<OsString> = args.collect();
    let has = |names: &[&str]| args.iter().any(|arg| names.iter().any(|name| arg == name));
    args.len() == 2 && has(&["--version", "-V"]) && has(&["--verbose"])
}

/// Version, commit, machine and parts, a line each.
pub fn verbose() -> String {
    let profile = match cfg!(debug_assertions) {
        true => "with debug assertions",
        false => "optimised",
    };
    let lines = [
        ("commit", COMMIT.unwrap_or("unknown").to_owned()),
        ("target", env!("ETALON_TARGET").to_owned()),
        ("instructions", machine::level().to_owned()),
        ("build", profile.to_owned()),
        (
            "formats",
            "Mitsuba 3 and 0.6 XML, pbrt-v4, glTF 2.0".to_owned(),
        ),
    ];
    let mut text = format!("etalon {VERSION}\n");
    for (name, value) in lines {
        text += &format!("{name}: {value}\n");
    }
    if let Some(remark) = machine::remark() {
        text += &format!("note: {remark}\n");
    }
    text
}
