//! Colours as they are in a file, whose spectra are made anew at each look-up.
//!
//! That takes some tens of nanoseconds, and a quarter to a half of the memory of the spectra: for large pictures in which most
//! colours occur once.

use crate::coded::{At, Coded};
use etalon_spectrum::RgbCoefficients;

/// Three channels of a colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Recalled<S>(pub Coded<S>);

/// Up to so many bytes of spectra are kept, whatever the picture.
const ALWAYS: usize = 16 << 20;

/// Whether the spectra of `count` colours would take more than two fifths of the memory of the pixels, and much.
pub(crate) fn is_heavy<S>(count: usize, pixels: &Coded<S>) -> bool {
    let bytes = count * size_of::<[f32; 3]>();
    bytes > ALWAYS && bytes > pixels.bytes() / 5 * 2
}

impl<S: Copy + Into<usize>> At<[f32; 3]> for Recalled<S> {
    /// The coefficients of a pixel's spectrum.
    #[inline]
    fn at(&self, index: usize) -> [f32; 3] {
        RgbCoefficients::from_rgb(self.0.at(index)).0
    }
}
