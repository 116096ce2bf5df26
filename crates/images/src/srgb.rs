//! The sRGB transfer function (IEC 61966-2-1:1999), both ways.
//!
//! For a linear value l and its encoding e, both in [0, 1]:
//!
//! e = 12.92·l for l ≤ 0.0031308, else 1.055·l^(1/2.4) − 0.055,
//! l = e/12.92 for e ≤ 0.04045, else ((e + 0.055)/1.055)^2.4.

use etalon_math::float64;
use std::sync::LazyLock;

/// The encoding of a linear value. Values outside [0, 1] continue the same curves, negative
/// ones by symmetry.
#[must_use]
pub fn encode(linear: f32) -> f32 {
    let l = f64::from(linear.abs());
    let encoded = if l <= 0.003_130_8 {
        12.92 * l
    } else {
        1.055 * float64::pow(l, 1.0 / 2.4) - 0.055
    };
    (encoded as f32).copysign(linear)
}

/// The linear value of an encoding; the inverse of [`encode`].
#[must_use]
pub fn decode(encoded: f32) -> f32 {
    let e = f64::from(encoded.abs());
    let linear = if e <= 0.040_45 {
        e / 12.92
    } else {
        float64::pow((e + 0.055) / 1.055, 2.4)
    };
    (linear as f32).copysign(encoded)
}

/// The values of integers, up to the greatest, which is 1: as they are, and decoded.
struct Tables {
    plain: Vec<f32>,
    decoded: Vec<f32>,
}

impl Tables {
    fn up_to(greatest: u16) -> Self {
        let plain = (0..=greatest).map(|x| f32::from(x) / f32::from(greatest));
        let plain: Vec<f32> = plain.collect();
        let decoded = plain.iter().copied().map(decode).collect();
        Self { plain, decoded }
    }

    fn get(&self, encoded: bool) -> &[f32] {
        if encoded { &self.decoded } else { &self.plain }
    }
}

static OF_8_BITS: LazyLock<Tables> = LazyLock::new(|| Tables::up_to(255));
static OF_16_BITS: LazyLock<Tables> = LazyLock::new(|| Tables::up_to(65535));

/// The value of each 8-bit integer, linear if they are `encoded`, otherwise as it is.
#[must_use]
pub fn values_of_8_bits(encoded: bool) -> &'static [f32] {
    OF_8_BITS.get(encoded)
}

/// The same of 16 bits.
#[must_use]
pub fn values_of_16_bits(encoded: bool) -> &'static [f32] {
    OF_16_BITS.get(encoded)
}

/// The linear value of an 8-bit encoding.
#[must_use]
pub fn decode_u8(encoded: u8) -> f32 {
    values_of_8_bits(true)[usize::from(encoded)]
}

/// The 8-bit encoding nearest to a linear value: 0 below 0, 255 above 1, and 0 for NaN.
#[must_use]
pub fn encode_u8(linear: f32) -> u8 {
    // The cast saturates, and takes NaN to 0.
    (encode(linear) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_points() {
        // 18 % grey is 118 in sRGB; the middle of the encoding is 21.4 %.
        assert_eq!(encode_u8(0.18), 118);
        assert!((decode(0.5) - 0.214_041_14).abs() < 1e-7);
        assert_eq!((encode(0.0), encode(1.0)), (0.0, 1.0));
        assert_eq!((decode(0.0), decode(1.0)), (0.0, 1.0));
        assert_eq!(encode(-0.5), -encode(0.5));
    }

    #[test]
    fn every_byte_survives() {
        for byte in 0..=255 {
            assert_eq!(encode_u8(decode_u8(byte)), byte);
        }
        assert_eq!((encode_u8(-1.0), encode_u8(7.0)), (0, 255));
        assert_eq!((encode_u8(f32::NAN), encode_u8(f32::INFINITY)), (0, 255));
    }

    #[test]
    fn the_curve_is_increasing_and_undone_by_its_inverse() {
        let mut last = -1.0;
        for i in 0..=10_000 {
            let linear = i as f32 / 10_000.0;
            let encoded = encode(linear);
            assert!(encoded > last);
            assert!((decode(encoded) - linear).abs() <= 2e-7);
            last = encoded;
        }
    }
}
