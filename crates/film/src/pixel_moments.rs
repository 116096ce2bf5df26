//! Sum and sum of squares of one channel of one pixel over finished replicates.
//!
//! What [`Moments`] is, without its count, which is the same for all pixels of a film: 48 bytes
//! instead of 64.

use etalon_statistics::{Fault, Fixed128, Moments, U256};

/// Exact sums; the number of replicates is known to whoever holds them.
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
    pub(crate) fn push(&mut self, mean: Fixed128) -> Result<(), Fault> {
        let mut one = Moments::ZERO;
        one.push(mean)?;
        let mut sum = self.sum;
        sum.merge(mean)?;
        let squares = self
            .squares
            .checked_add(one.squares())
            .ok_or(Fault::OutOfRange)?;
        *self = Self { sum, squares };
        Ok(())
    }

    /// The moments of `count` replicates.
    pub(crate) fn of(&self, count: u32) -> Moments {
        Moments::from_parts(count, self.sum, self.squares)
            .expect("as many replicates were pushed as the film has finished")
    }
}
