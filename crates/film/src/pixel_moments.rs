//! Sum and sum of squares of one channel of one pixel over finished replicates.
//!
//! What [`Moments`] is, without its count, which is the same for all pixels of a film: 48 bytes
//! instead of 64.

use etalon_statistics::{Fixed128, InvalidValue, Moments, U256};

/// 32-bit words of both sums.
pub(crate) const WORDS: usize = 12;

/// Exact sums; the owner knows the number of replicates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PixelMoments {
    sum: Fixed128,
    squares: U256,
}

impl PixelMoments {
    pub(crate) const ZERO: Self = Self {
        sum: Fixed128::ZERO,
        squares: U256::ZERO,
    };

    /// Adds the mean of a replicate; an error leaves everything as it was.
    pub(crate) fn push(&mut self, mean: Fixed128) -> Result<(), InvalidValue> {
        let mut one = Moments::ZERO;
        one.push(mean)?;
        let mut sum = self.sum;
        sum.merge(mean)?;
        let squares = self
            .squares
            .checked_add(one.squares())
            .ok_or(InvalidValue::OutOfRange)?;
        *self = Self { sum, squares };
        Ok(())
    }

    /// The moments of `count` replicates.
    pub(crate) fn of(&self, count: u32) -> Moments {
        Moments::from_parts(count, self.sum, self.squares)
            .expect("as many replicates were pushed as the film has finished")
    }

    /// Adds other replicates; an error leaves everything as it was.
    pub(crate) fn merge(&mut self, other: &Self) -> Result<(), InvalidValue> {
        let mut sum = self.sum;
        sum.merge(other.sum)?;
        let squares = self
            .squares
            .checked_add(other.squares)
            .ok_or(InvalidValue::OutOfRange)?;
        *self = Self { sum, squares };
        Ok(())
    }

    /// The words of the sum, then those of the squares, least significant first.
    pub(crate) fn words(&self) -> [u32; WORDS] {
        let (high, low) = self.squares.to_words();
        let mut words = [0; WORDS];
        let numbers = [self.sum.to_bits().cast_unsigned(), low, high];
        for (words, number) in words.chunks_exact_mut(4).zip(numbers) {
            for (place, word) in words.iter_mut().enumerate() {
                *word = (number >> (32 * place)) as u32;
            }
        }
        words
    }

    /// The sums with these words, if `count` replicates, each within the range of terms, can
    /// have them.
    pub(crate) fn from_words(words: [u32; WORDS], count: u32) -> Option<Self> {
        let number = |first: usize| {
            let words = words[first..first + 4].iter().rev();
            words.fold(0, |number, &word| number << 32 | u128::from(word))
        };
        let sum = Fixed128::from_bits(number(0).cast_signed());
        let squares = U256::from_words(number(8), number(4));
        // Each replicate is below 2⁴⁸, which is 2¹¹² in units of the sum.
        let none = count == 0 && words == [0; WORDS];
        let in_range = sum.to_bits().unsigned_abs() >> 112 < u128::from(count)
            && squares.to_words().0 >> 96 < u128::from(count)
            || none;
        Moments::from_parts(count, sum, squares)?;
        in_range.then_some(Self { sum, squares })
    }
}
