//! Complex refractive indices of named conductors, η − i k.

use crate::Spectrum;

/// η and k of the conductor `name`, as spectra; `None` without data.
pub fn lookup(name: &str) -> Option<(Spectrum, Spectrum)> {
    let _ = name;
    None
}

/// Names [`lookup`] knows.
pub fn names() -> impl Iterator<Item = &'static str> {
    std::iter::empty()
}
