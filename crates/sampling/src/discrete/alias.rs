//! The alias method: a discrete choice in constant time (Walker 1977; Vose 1991).
//!
//! Each of n equally likely columns holds at most two outcomes, its own and its alias. The
//! place within the column decides between the two, and is returned, rescaled to [0, 1), to be
//! used again.

use super::{TableError, check_weights};

/// A discrete distribution.
#[derive(Clone, Debug)]
pub struct AliasTable {
    columns: Vec<Column>,
    total: f64,
}

#[derive(Clone, Copy, Debug)]
struct Column {
    /// The share of the column that is its own outcome; the rest is the alias's.
    own: f64,
    alias: u32,
    probability: f32,
}

/// The result of a choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Index of the entry.
    pub index: usize,
    /// Its probability.
    pub probability: f32,
    /// The random number rescaled for reuse: uniform in [0, 1) and independent of the choice.
    pub rest: f32,
}

impl AliasTable {
    /// The distribution with probabilities proportional to `weights`; at most 2³² − 1 of them.
    ///
    /// # Errors
    /// If there are none, too many, all are zero, or one is negative or not finite.
    pub fn new(weights: &[f64]) -> Result<Self, TableError> {
        check_weights(weights, 1)?;
        let n = weights.len();
        if u32::try_from(n).is_err() {
            return Err(TableError::WrongShape {
                entries: n,
                needed: u32::MAX as usize,
            });
        }
        // By the largest, so that the sum of finite weights is finite.
        let largest = weights.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return Err(TableError::Zero);
        }
        let scaled_total: f64 = weights.iter().map(|w| w / largest).sum();
        let probability = |i: usize| weights[i] / largest / scaled_total;
        let mut columns: Vec<Column> = (0..n)
            .map(|i| Column {
                own: probability(i) * n as f64,
                alias: i as u32,
                probability: probability(i) as f32,
            })
            .collect();

        let (mut poor, mut rich): (Vec<u32>, Vec<u32>) =
            (0..n as u32).partition(|&i| columns[i as usize].own < 1.0);
        while let (Some(&giver), Some(taker)) = (rich.last(), poor.pop()) {
            columns[taker as usize].alias = giver;
            let left = columns[giver as usize].own - (1.0 - columns[taker as usize].own);
            columns[giver as usize].own = left;
            if left < 1.0 {
                rich.pop();
                poor.push(giver);
            }
        }
        // What rounding leaves is full. An entry of weight zero cannot be left: it would have
        // needed all the rich to run out a whole column early.
        for i in rich.into_iter().chain(poor) {
            columns[i as usize].own = 1.0;
        }
        Ok(Self {
            columns,
            total: largest * scaled_total,
        })
    }

    /// Number of entries.
    #[inline]
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Never: a distribution has entries.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// The sum of the weights.
    #[inline]
    pub fn total(&self) -> f64 {
        self.total
    }

    /// The probability of entry `index`.
    #[inline]
    pub fn probability(&self, index: usize) -> f32 {
        self.columns[index].probability
    }

    /// Chooses with one random number in [0, 1).
    ///
    /// Random numbers have 24 bits: with n entries the probabilities met in practice deviate
    /// from the stated ones by up to n·2⁻²⁴ relative to a mean entry's (for 10,000 entries, 0.06 %)
    /// and `rest` keeps 24 − log₂ n bits. For larger tables see [`AliasTable::sample_fine`].
    #[inline]
    pub fn sample(&self, u: f32) -> Choice {
        self.choose(f64::from(u))
    }

    /// Chooses with two random numbers in [0, 1), as with one of 48 bits: exact for any table
    /// that fits into memory.
    #[inline]
    pub fn sample_fine(&self, u: glam::Vec2) -> Choice {
        const STEP: f64 = 1.0 / (1 << 24) as f64;
        self.choose(f64::from(u.x) + f64::from(u.y) * STEP)
    }

    #[inline]
    fn choose(&self, u: f64) -> Choice {
        if let [only] = self.columns.as_slice() {
            return Choice {
                index: 0,
                probability: only.probability,
                rest: (u as f32).min(etalon_math::float::ONE_MINUS_EPSILON),
            };
        }
        let scaled = u * self.columns.len() as f64;
        let column = (scaled as usize).min(self.columns.len() - 1);
        let place = scaled - column as f64;
        let Column { own, alias, .. } = self.columns[column];
        let (index, rest) = if place < own {
            (column, place / own)
        } else {
            (alias as usize, (place - own) / (1.0 - own))
        };
        Choice {
            index,
            probability: self.columns[index].probability,
            rest: (rest as f32).min(etalon_math::float::ONE_MINUS_EPSILON),
        }
    }
}
