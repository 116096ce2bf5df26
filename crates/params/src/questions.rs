//! What plugins ask for while they are read, from which the documentation of scenes is made.
//!
//! A plugin's parameters are nowhere but in the code that reads them. While [`record`] runs something, every question of
//! every [`crate::Params`] is noted with its kind and default; otherwise a question costs a look at a flag.

use crate::{Class, ParameterKind};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The documentation of a parameter, as recorded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Question {
    /// What its value must be.
    pub kind: ParameterKind,
    /// Its default; empty if that is not a single value.
    pub default: String,
    /// Which values of that kind are accepted; empty for all.
    pub accepted: String,
    /// Whether it was missing and required.
    pub required: bool,
}

/// Questions by class, plugin and parameter; a nested object has the parameter `<class>`.
pub type Questions = BTreeMap<(Class, String, String), Question>;

static RECORDING: AtomicBool = AtomicBool::new(false);
static NOTED: Mutex<Questions> = Mutex::new(BTreeMap::new());

/// Runs `read`, and returns the parameters read meanwhile by any plugin in any thread.
pub fn record<T>(read: impl FnOnce() -> T) -> (T, Questions) {
    RECORDING.store(true, Ordering::SeqCst);
    let result = read();
    RECORDING.store(false, Ordering::SeqCst);
    let mut noted = NOTED.lock().unwrap_or_else(|e| e.into_inner());
    (result, std::mem::take(&mut *noted))
}

/// Whether questions are noted.
pub(crate) fn is_recording() -> bool {
    RECORDING.load(Ordering::Relaxed)
}

/// Records a parameter; empty fields add nothing to what is already recorded.
pub(crate) fn note(class: Class, plugin: &str, name: &str, question: impl FnOnce() -> Question) {
    if !is_recording() {
        return;
    }
    let question = question();
    let mut noted = NOTED.lock().unwrap_or_else(|e| e.into_inner());
    let known = noted
        .entry((class, plugin.to_owned(), name.to_owned()))
        .or_default();
    if question.kind != ParameterKind::Unsaid {
        known.kind = question.kind;
    }
    for (known, new) in [
        (&mut known.default, question.default),
        (&mut known.accepted, question.accepted),
    ] {
        if !new.is_empty() {
            *known = new;
        }
    }
    known.required |= question.required;
}
