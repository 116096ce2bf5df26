//! Half-precision floats (IEEE 754-2019, binary16): eleven significant bits in two bytes.
//!
//! A picture's plane is stored as `value · 2^-exponent` rounded to binary16, with one exponent for all
//! its numbers, so that the largest stays below 2¹⁵; scaling by a power of two loses nothing. A
//! number is off by 2⁻¹¹ of itself at most, unless it is 2²⁹ times smaller than the largest.

/// The exponent that brings the largest finite number to between 2¹⁴ and 2¹⁵; zero for none.
pub fn exponent(values: &[f32]) -> i32 {
    let finite = values.iter().filter(|x| x.is_finite());
    let largest = finite.fold(0.0_f32, |most, x| most.max(x.abs()));
    if largest > 0.0 {
        log2_floor(largest) - 14
    } else {
        0
    }
}

/// ⌊log₂ x⌋ of a positive finite number, from its bits.
fn log2_floor(x: f32) -> i32 {
    let bits = x.to_bits();
    match (bits >> 23) as i32 {
        // Subnormal: the highest bit that is set.
        0 => 31 - bits.leading_zeros() as i32 - 149,
        biased => biased - 127,
    }
}

/// `value · 2^-exponent` as binary16, rounded to nearest, ties to even.
pub fn encode(value: f32, exponent: i32) -> u16 {
    // Exact in double precision: exponents of single precision are far from its ends.
    let power = f64::from_bits(((1023 - exponent) as u64) << 52);
    half::f16::from_f64(f64::from(value) * power).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponent_brings_any_picture_into_range() {
        for largest in [1e-40_f32, 3e-12, 0.7, 1.0, 65504.0, 1e30, f32::MAX] {
            let values = [0.0, -largest, 0.5 * largest, f32::INFINITY, f32::NAN];
            let exponent = exponent(&values);
            let bits = encode(largest, exponent);
            assert!((0x7400..=0x7800).contains(&bits), "{largest}: {bits:04x}");
        }
        assert_eq!(exponent(&[]), 0);
        assert_eq!(exponent(&[0.0, f32::NAN]), 0);
    }
}
