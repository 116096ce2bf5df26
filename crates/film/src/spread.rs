//! The samples of a tile that count for every pixel under the filter.
//!
//! They are summed in a block of the tile's own, the tile and as many pixels around it as a sample
//! reaches, and added to the film when the tile ends. So no two threads write to one place while samples
//! are drawn, and since the sums are integers the result depends on neither threads nor tiles.
//!
//! A term is value × weight. The weight, f(cₓ − x) f(c_y − y) / (∫f)², is rounded to a multiple of 2⁻²⁴; the
//! product is exact then, in units of 2⁻⁶⁴: a value of at least 2⁻¹⁷ and below 2²² is an integer of 64 bits
//! in units of 2⁻⁴⁰, and a single multiplication gives it. Others take a slower path; below 2⁻¹⁷ products are
//! rounded to the nearest unit.

use crate::footprint::Footprint;
use etalon_math::lane::{F32x8, Int, Lane};
use etalon_statistics::{Fixed128, InvalidValue};
use glam::{IVec2, Vec2};

/// Weights are multiples of one over this.
const WEIGHT_UNIT: f32 = 16_777_216.0;

/// Sums of a tile's samples over the pixels that they reach.
#[derive(Debug)]
pub(crate) struct Spread {
    /// The first pixel of the block, within the crop, and the block's size.
    low: IVec2,
    size: IVec2,
    channels: usize,
    /// By row, column and channel.
    sums: Vec<Fixed128>,
    /// Weights of the current sample, by row and column of its footprint; rows are filled up to a `stride`.
    weights: Vec<i64>,
    columns: usize,
    stride: usize,
    /// The footprint's first number in `sums`.
    first: usize,
    /// The largest weight, in absolute value.
    most: f32,
    /// Weights along either axis; kept for reuse.
    across: Vec<f32>,
    down: Vec<f32>,
}

/// A number ready to be multiplied by weights.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Term {
    /// In units of 2⁻⁴⁰.
    Quick(i64),
    /// Mantissa × 2^(`shift` − 40).
    Slow { mantissa: i64, shift: i32 },
}

impl Term {
    /// # Errors
    /// [`InvalidValue`] where [`Fixed128`] refuses `x`.
    #[inline]
    pub(crate) fn new(x: f32) -> Result<Self, InvalidValue> {
        let bits = x.to_bits();
        let magnitude = i64::from(bits & 0x7f_ffff | 0x80_0000);
        let mantissa = if x < 0.0 { -magnitude } else { magnitude };
        // A normal number is mantissa · 2^(exponent − 150).
        let exponent = ((bits >> 23) & 0xff) as i32;
        let shift = exponent - 110;
        Ok(match shift {
            0..=38 => Self::Quick(mantissa << shift),
            // Zero, and numbers below the unit.
            _ if exponent == 0 => Self::Quick(0),
            _ => {
                Fixed128::from_f32(x)?;
                Self::Slow { mantissa, shift }
            }
        })
    }

    fn is_zero(self) -> bool {
        matches!(self, Self::Quick(0))
    }

    /// The product with a weight, in units of 2⁻⁶⁴.
    #[inline]
    fn times(self, weight: i64) -> i128 {
        match self {
            Self::Quick(value) => i128::from(value) * i128::from(weight),
            Self::Slow { mantissa, shift } => {
                let product = i128::from(mantissa * weight);
                match shift {
                    0.. => product << shift,
                    -62..0 => {
                        // To the nearest; away from zero of two that are as near.
                        let half = 1i128 << (-shift - 1);
                        let rounded = (product.abs() + half) >> -shift;
                        if product < 0 { -rounded } else { rounded }
                    }
                    _ => 0,
                }
            }
        }
    }
}

impl Spread {
    /// A block for the samples of the pixels in [`from`, `to`) of a crop of this size.
    pub(crate) fn new(
        footprint: &Footprint,
        [from, to]: [IVec2; 2],
        crop: IVec2,
        channels: usize,
    ) -> Self {
        let reach = IVec2::splat(footprint.reach() as i32);
        let low = (from - reach).max(IVec2::ZERO);
        let size = (to + reach).min(crop) - low;
        Self {
            low,
            size,
            channels,
            sums: vec![Fixed128::ZERO; (size.x * size.y) as usize * channels],
            weights: Vec::new(),
            columns: 0,
            stride: 1,
            first: 0,
            most: 0.0,
            across: Vec::new(),
            down: Vec::new(),
        }
    }

    /// What follows is found by a sample of `pixel` (counted within the crop, or around it) that lies so
    /// far from the pixel's centre.
    #[inline]
    pub(crate) fn place(&mut self, footprint: &Footprint, pixel: IVec2, offset: Vec2) {
        let own = pixel - self.low;
        let end = self.size - 1 - own;
        let left = footprint.along(offset.x, [-own.x, end.x], &mut self.across);
        let top = footprint.along(offset.y, [-own.y, end.y], &mut self.down);
        self.columns = self.across.len();
        let most = |taps: &[f32]| taps.iter().fold(0.0f32, |most, tap| most.max(tap.abs()));
        self.most = most(&self.across) * most(&self.down);
        if self.columns == 0 || self.down.is_empty() {
            self.columns = 0;
            return;
        }
        let corner = own + IVec2::new(left, top);
        self.first = (corner.y * self.size.x + corner.x) as usize * self.channels;
        self.stride = self.columns.next_multiple_of(F32x8::WIDTH);
        self.across.resize(self.stride, 0.0);
        self.weights.resize(self.stride * self.down.len(), 0);
        let weights = self.weights.chunks_exact_mut(self.stride);
        for (down, row) in self.down.iter().zip(weights) {
            let down = down * WEIGHT_UNIT;
            let across = self.across.chunks_exact(F32x8::WIDTH);
            for (across, weights) in across.zip(row.chunks_exact_mut(F32x8::WIDTH)) {
                if !footprint.is_flat() {
                    for (weight, across) in weights.iter_mut().zip(across) {
                        *weight = (across * down).round_ties_even() as i64;
                    }
                    continue;
                }
                let rounded = (F32x8::load(across) * down).round_ties_even();
                let mut whole = [0; F32x8::WIDTH];
                rounded.to_int().store(&mut whole);
                for (weight, whole) in weights.iter_mut().zip(whole) {
                    *weight = i64::from(whole.cast_signed());
                }
            }
        }
    }

    /// The largest weight of the current sample, in absolute value.
    pub(crate) fn most(&self) -> f32 {
        self.most
    }

    /// Adds values of the current sample to channels from `channel` on.
    #[inline]
    pub(crate) fn add<const N: usize>(&mut self, channel: usize, terms: [Term; N]) {
        if self.columns == 0 || terms.iter().all(|term| term.is_zero()) {
            return;
        }
        if let Some(values) = quick(terms) {
            self.each(channel, |sums: &mut [Fixed128; N], weight| {
                for (sum, value) in sums.iter_mut().zip(values) {
                    let term = i128::from(value) * i128::from(weight);
                    *sum = Fixed128::from_bits(sum.to_bits().wrapping_add(term));
                }
            });
        } else {
            self.each(channel, |sums: &mut [Fixed128; N], weight| {
                for (sum, term) in sums.iter_mut().zip(terms) {
                    // Sound values cannot leave the range of 2⁶³ in one tile; if others do, the film refuses the
                    // saturated sum in the end.
                    *sum = Fixed128::from_bits(sum.to_bits().saturating_add(term.times(weight)));
                }
            });
        }
    }

    #[inline]
    fn each<const N: usize>(
        &mut self,
        channel: usize,
        mut add: impl FnMut(&mut [Fixed128; N], i64),
    ) {
        let stride = self.size.x as usize * self.channels;
        for (row, weights) in self.weights.chunks_exact(self.stride).enumerate() {
            let line = &mut self.sums[self.first + row * stride..];
            let weights = &weights[..self.columns];
            for (pixel, weight) in line.chunks_exact_mut(self.channels).zip(weights) {
                if let Some(sums) = pixel[channel..].first_chunk_mut() {
                    add(sums, *weight);
                }
            }
        }
    }

    /// Gives the sums of every pixel of the block that has some, counted within the crop, to be emptied.
    pub(crate) fn deliver(&mut self, mut take: impl FnMut(IVec2, &mut [Fixed128])) {
        let (low, width) = (self.low, self.size.x);
        let pixels = self.sums.chunks_exact_mut(self.channels);
        for (index, sums) in (0..).zip(pixels) {
            if sums.iter().any(|sum| *sum != Fixed128::ZERO) {
                take(low + IVec2::new(index % width, index / width), sums);
            }
        }
    }
}

/// The integers of terms that all have one.
#[inline]
fn quick<const N: usize>(terms: [Term; N]) -> Option<[i64; N]> {
    let mut values = [0; N];
    for (value, term) in values.iter_mut().zip(terms) {
        let Term::Quick(own) = term else {
            return None;
        };
        *value = own;
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mutant: a shift that is off by one for small or for large numbers.
    #[test]
    fn products_are_right_at_all_sizes() {
        let unit = 1.0 / 18_446_744_073_709_551_616.0;
        for exponent in -70..48 {
            for value in [1.0f32, 1.5, 1.999_999_9, -1.25] {
                let value = value * 2.0f32.powi(exponent);
                let term = Term::new(value).expect("finite");
                for weight in [0.0f32, 1.0, 0.3, -0.07, 1.0 / WEIGHT_UNIT, 6.5] {
                    let fixed = (weight * WEIGHT_UNIT).round_ties_even() as i64;
                    let product = term.times(fixed) as f64 * unit;
                    let exact = f64::from(value) * (fixed as f64 / f64::from(WEIGHT_UNIT));
                    let error = (product - exact).abs();
                    assert!(error <= 0.5 * unit, "{value} × {weight}: {product}");
                }
            }
        }
        assert!(Term::new(0.0).expect("finite").is_zero());
        assert_eq!(Term::new(f32::NAN).err(), Some(InvalidValue::NotANumber));
        assert_eq!(Term::new(f32::INFINITY).err(), Some(InvalidValue::Infinite));
        assert_eq!(
            Term::new(2.0f32.powi(48)).err(),
            Some(InvalidValue::OutOfRange)
        );
    }
}
