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
    let sign = (u32::from(value.is_sign_negative()) as u16) << 15;
    if value.is_nan() {
        return sign | 0x7e00;
    }
    if value.is_infinite() {
        return sign | 0x7c00;
    }
    // Exact in double precision: exponents of single precision are far from its ends.
    let scaled = f64::from(value.abs()) * power_of_two(-exponent);
    let rounded = |unit: f64| (scaled / unit).round_ties_even();
    let smallest_normal = power_of_two(-14);
    if scaled < smallest_normal {
        // What rounds up to 1024 units is the smallest normal number, bit by bit.
        return sign | rounded(power_of_two(-24)) as u16;
    }
    let power = ((scaled.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    // 1024 to 2048 units: 2048 carries into the exponent, as it should.
    let units = rounded(power_of_two(power - 10)) as u32;
    let bits = (((power + 15) as u32) << 10) + (units - 1024);
    sign | bits.min(0x7c00) as u16
}

fn power_of_two(power: i32) -> f64 {
    f64::from_bits(((power + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_bit_patterns() {
        // IEEE 754-2019, 3.6; and the ends of the range.
        for (value, bits) in [
            (0.0, 0x0000),
            (-0.0, 0x8000),
            (1.0, 0x3c00),
            (-2.0, 0xc000),
            (65504.0, 0x7bff),
            (65520.0, 0x7c00),
            (0.333_333_34, 0x3555),
            (6.103_515_6e-5, 0x0400),
            (6.097_555e-5, 0x03ff),
            (5.960_464_5e-8, 0x0001),
            (2.0e-8, 0x0000),
            (f32::INFINITY, 0x7c00),
            (f32::NEG_INFINITY, 0xfc00),
            // Ties to even, and one that carries.
            (1.000_488_3, 0x3c00),
            (1.001_464_8, 0x3c02),
            (1.999_755_9, 0x4000),
        ] {
            assert_eq!(encode(value, 0), bits, "{value}");
        }
        assert_eq!(encode(f32::NAN, 0) & 0x7e00, 0x7e00);
    }

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
