//! Unsigned 256-bit integers: as much arithmetic as exact second moments need.

/// An unsigned 256-bit integer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct U256 {
    // The order of the fields is the order of significance: comparison is derived from it.
    high: u128,
    low: u128,
}

const LOW_HALF: u128 = u64::MAX as u128;

impl U256 {
    /// Nought.
    pub const ZERO: Self = Self { high: 0, low: 0 };

    /// The number `high` · 2¹²⁸ + `low`.
    #[must_use]
    pub const fn from_words(high: u128, low: u128) -> Self {
        Self { high, low }
    }

    /// The words `(high, low)` of the number `high` · 2¹²⁸ + `low`.
    #[must_use]
    pub const fn to_words(self) -> (u128, u128) {
        (self.high, self.low)
    }

    /// The product of two 128-bit numbers.
    #[must_use]
    pub const fn from_product(a: u128, b: u128) -> Self {
        let (a1, a0) = (a >> 64, a & LOW_HALF);
        let (b1, b0) = (b >> 64, b & LOW_HALF);
        let bottom = a0 * b0;
        // Each of these fits: (2⁶⁴−1)² + 2·(2⁶⁴−1) = 2¹²⁸ − 1.
        let middle = a1 * b0 + (bottom >> 64);
        let cross = a0 * b1 + (middle & LOW_HALF);
        Self {
            high: a1 * b1 + (middle >> 64) + (cross >> 64),
            low: (cross << 64) | (bottom & LOW_HALF),
        }
    }

    /// The sum, unless it needs more than 256 bits.
    #[must_use]
    pub const fn checked_add(self, other: Self) -> Option<Self> {
        let (low, carry) = self.low.overflowing_add(other.low);
        let Some(high) = self.high.checked_add(other.high) else {
            return None;
        };
        let Some(high) = high.checked_add(carry as u128) else {
            return None;
        };
        Some(Self { high, low })
    }

    /// The difference, unless it is negative.
    #[must_use]
    pub const fn checked_sub(self, other: Self) -> Option<Self> {
        let (low, borrow) = self.low.overflowing_sub(other.low);
        let Some(high) = self.high.checked_sub(other.high) else {
            return None;
        };
        let Some(high) = high.checked_sub(borrow as u128) else {
            return None;
        };
        Some(Self { high, low })
    }

    /// The product, unless it needs more than 256 bits.
    #[must_use]
    pub const fn checked_mul(self, factor: u128) -> Option<Self> {
        let low = Self::from_product(self.low, factor);
        let high = Self::from_product(self.high, factor);
        if high.high != 0 {
            return None;
        }
        Self {
            high: high.low,
            low: 0,
        }
        .checked_add(low)
    }

    /// Quotient and remainder.
    ///
    /// # Panics
    /// For a divisor of zero or above 2⁶⁴.
    #[must_use]
    pub fn divided_by(self, divisor: u128) -> (Self, u128) {
        assert!(
            divisor > 0 && divisor <= 1 << 64,
            "divisor {divisor} is not in 1..=2^64"
        );
        // School division, 64 bits at a time: the remainder is below 2⁶⁴, so each partial
        // dividend fits 128 bits.
        let mut rest = 0;
        let mut digit = |word: u128| {
            let partial = (rest << 64) | word;
            rest = partial % divisor;
            partial / divisor
        };
        let digits = [
            digit(self.high >> 64),
            digit(self.high & LOW_HALF),
            digit(self.low >> 64),
            digit(self.low & LOW_HALF),
        ];
        let quotient = Self {
            high: (digits[0] << 64) | digits[1],
            low: (digits[2] << 64) | digits[3],
        };
        (quotient, rest)
    }

    /// The nearest double, ties to even.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.to_f64_sticky(false)
    }

    /// The double nearest to a number that exceeds `self` by something between 0 and 1,
    /// exclusive, if `sticky` is set.
    #[must_use]
    pub(crate) fn to_f64_sticky(self, sticky: bool) -> f64 {
        if self.high == 0 {
            // Up to 2¹²⁷ there is room for a bit below the point. Above, the lowest bit lies far
            // beneath the rounding position and may serve.
            return if self.low >> 127 == 0 {
                ((self.low << 1) | u128::from(sticky)) as f64 * 0.5
            } else {
                (self.low | u128::from(sticky)) as f64
            };
        }
        let zeros = self.high.leading_zeros();
        let (top, lost) = if zeros == 0 {
            (self.high, self.low)
        } else {
            (
                (self.high << zeros) | (self.low >> (128 - zeros)),
                self.low << zeros,
            )
        };
        // The top 128 bits hold all that rounding looks at, save whether anything follows.
        let rounded = (top | u128::from(lost != 0 || sticky)) as f64;
        rounded * power_of_two(128 - zeros)
    }
}

/// 2^`exponent`, for exponents below 1024.
fn power_of_two(exponent: u32) -> f64 {
    f64::from_bits(u64::from(1023 + exponent) << 52)
}
