//! A fingerprint of the machine's arithmetic: what must be equal for two programs to compute
//! the same bits.
//!
//! It is a hash over the results of our elementary functions, fused multiply-adds, square
//! roots, divisions, conversions and small vector operations at a few hundred arguments, subnormal
//! ones among them. Files carry it; images or parts with different fingerprints were not
//! computed by the same arithmetic, and sums of theirs would not be reproducible.

use etalon_math::{float, float64};
use glam::{Vec4, Vec4Swizzles};
use std::hint::black_box;

/// The fingerprint of this program on this machine: 16 hexadecimal digits.
pub fn floating_point_fingerprint() -> String {
    let mut hash = Fnv::default();
    for i in 0..512u32 {
        // Arguments from 2⁻⁷ to 2⁸, of both signs, spread by the golden ratio.
        let spread = (f64::from(i) * 0.618_033_988_749_894_9).fract();
        let scale = f64::from_bits((1023 - 7 + u64::from(i % 15)) << 52);
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let wide = black_box(sign * scale * (1.0 + spread));
        double(&mut hash, wide);
        single(&mut hash, black_box(wide as f32));
    }
    let subnormal = black_box(f32::MIN_POSITIVE) * black_box(0.25);
    hash.add(subnormal.to_bits().into());
    hash.add((black_box(f64::MIN_POSITIVE) * black_box(0.25)).to_bits());
    format!("{:016x}", hash.0)
}

fn single(hash: &mut Fnv, x: f32) {
    let (sin, cos) = float::sin_cos(x);
    let (turn_sin, turn_cos) = float::sin_cos_turns(x);
    let magnitude = x.abs();
    let v = Vec4::new(x, magnitude.sqrt(), 1.0 / x, x.mul_add(x, -0.5));
    let results = [
        sin,
        cos,
        turn_sin,
        turn_cos,
        float::tan(x),
        float::asin(x),
        float::acos(x),
        float::atan(x),
        float::atan2(x, 0.7),
        float::atanh(turn_sin * 0.99),
        float::cosh(x * 0.1),
        float::exp(x * 0.1),
        float::ln(magnitude),
        float::log2(magnitude),
        float::pow(magnitude, 0.3),
        float::cbrt(x),
        float::erf(x),
        v.length(),
        v.dot(v.wzyx()),
        v.element_sum(),
        v.normalize().x,
    ];
    v.to_array()
        .into_iter()
        .chain(results)
        .for_each(|r| hash.add(r.to_bits().into()));
}

fn double(hash: &mut Fnv, x: f64) {
    let (sin, cos) = float64::sin_cos(x);
    let magnitude = x.abs();
    let results = [
        sin,
        cos,
        float64::tan(x),
        float64::atan2(x, 0.7),
        float64::exp(x * 0.1),
        float64::ln(magnitude),
        float64::log2(magnitude),
        float64::pow(magnitude, 0.3),
        float64::cbrt(x),
        float64::erf(x),
        magnitude.sqrt(),
        1.0 / x,
        x.mul_add(x, -0.5),
    ];
    results.into_iter().for_each(|r| hash.add(r.to_bits()));
}

/// The 64-bit hash of Fowler, Noll and Vo (1991), variant 1a.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn add(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fingerprint_is_the_same_every_time() {
        let fingerprint = floating_point_fingerprint();
        assert_eq!(fingerprint, floating_point_fingerprint());
        assert_eq!(fingerprint.len(), 16);
    }
}
