//! Irregular and yet reproducible: Halton's sequence (1960), in double precision.

/// Digits of `index` in `base`, mirrored about the point: in [0, 1).
pub(crate) fn radical_inverse(base: u32, index: u32) -> f64 {
    let (mut value, mut digit, mut rest) = (0.0, 1.0, index);
    while rest > 0 {
        digit /= f64::from(base);
        value += f64::from(rest % base) * digit;
        rest /= base;
    }
    value
}

/// The `index`-th number of the dimension `dimension` (at most 10).
pub(crate) fn halton(dimension: usize, index: u32) -> f64 {
    const PRIMES: [u32; 10] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29];
    radical_inverse(PRIMES[dimension], index + 1)
}
