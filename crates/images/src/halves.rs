//! 16-bit floats (IEEE 754 binary16), by their bits.

use half::f16;
use std::sync::LazyLock;

static VALUES: LazyLock<Vec<f32>> = LazyLock::new(|| {
    (0..=u16::MAX)
        .map(|bits| f16::from_bits(bits).to_f32())
        .collect()
});

/// The value of every pattern of 16 bits.
#[must_use]
pub fn values() -> &'static [f32] {
    &VALUES
}

/// The same numbers with 32 bits.
pub(crate) fn to_floats(halves: &[u16]) -> Vec<f32> {
    let values = values();
    halves
        .iter()
        .map(|&bits| values[usize::from(bits)])
        .collect()
}

/// Floats as halves, if none loses anything.
pub(crate) fn of_floats(floats: &[f32]) -> Option<Vec<u16>> {
    let exactly = |&float: &f32| {
        let half = f16::from_f32(float);
        (half.to_f32().to_bits() == float.to_bits()).then(|| half.to_bits())
    };
    floats.iter().map(exactly).collect()
}
