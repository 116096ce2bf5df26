//! Images whose values mean something else than they do by themselves.
//!
//! ```text
//! exponent γ: (i/m)^γ of an integer i of at most m, in place of sRGB's decoding        invert: max(0, 1 − c)
//! ```

use crate::coded::{At, Coded};
use crate::picture::FilePixels;
use crate::pixels::Values;
use etalon_math::float::pow;
use etalon_params::Params;
use glam::UVec2;

/// What is done to the values of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recoding {
    exponent: Option<f64>,
    invert: bool,
}

impl Recoding {
    /// Reads `exponent` and `invert`.
    pub(crate) fn read(params: &Params<'_>) -> Self {
        let accepted = "a finite number above 0";
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let exponent = params.float_where("exponent", 1.0, accepted, positive);
        Self {
            exponent: params.has("exponent").then_some(exponent),
            invert: params.boolean_or("invert", false),
        }
    }

    /// Whether integers are not sRGB's.
    pub(crate) fn has_exponent(self) -> bool {
        self.exponent.is_some()
    }

    /// What tells it from others.
    pub(crate) fn key(self) -> [u64; 2] {
        [
            self.exponent.map_or(0, f64::to_bits),
            u64::from(self.invert),
        ]
    }

    /// The pixels by these rules; those of integers stand as they are in the file if there is an exponent.
    pub(crate) fn apply(self, pixels: FilePixels, size: UVec2) -> FilePixels {
        if self.exponent.is_none() && !self.invert {
            return pixels;
        }
        let inverted = |x: f32| if self.invert { (1.0 - x).max(0.0) } else { x };
        let integer = |x: f32| inverted(self.exponent.map_or(x, |e| pow(x, e as f32)));
        FilePixels::Floats(match pixels {
            FilePixels::Floats(Values::One(values)) => {
                Values::One(values.into_iter().map(inverted).collect())
            }
            FilePixels::Floats(Values::Three(values)) => {
                Values::Three(values.into_iter().map(|rgb| rgb.map(inverted)).collect())
            }
            FilePixels::Bytes(bytes) => values(&bytes, size, integer),
            FilePixels::Words(words) => values(&words, size, integer),
            FilePixels::Halves(halves) => values(&halves, size, inverted),
        })
    }
}

/// A function of values that are looked up.
fn values<S: Copy + Into<usize>>(coded: &Coded<S>, size: UVec2, of: impl Fn(f32) -> f32) -> Values {
    let texels = 0..size.x as usize * size.y as usize;
    match coded.channels {
        1 => Values::One(texels.map(|i| of(coded.at(i))).collect()),
        _ => Values::Three(
            texels
                .map(|i| {
                    let rgb: [f32; 3] = coded.at(i);
                    rgb.map(&of)
                })
                .collect(),
        ),
    }
}
