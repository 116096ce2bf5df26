//! The number of looks of a comparison, and the part of its level that each may spend.
//!
//! Every comparison is looked at once with its budget. Those that are undecided get half as many
//! replicates again, and more, until they are decided or the plan ends: a group-sequential test
//! whose levels are spent by Pocock's function over the planned replicates and never used twice.
//! Steps of a half cost little of the level and render less in excess than doubling. Only counts
//! decide how much is done, never a clock: the same program and seed give the same verdicts and
//! numbers on any machine under any load. Each look is decided at its own share of the level, so no
//! assumption is made on the dependence of the looks.

use etalon_statistics::{Boundaries, Spending};

/// What is said of a row by itself holds with this probability of error, over all its looks.
///
/// It is not what rows are decided by: their intervals are so wide that *all* of them hold together
/// with a probability of 1 − [`super::decision::ALPHA`].
pub const STATED: f64 = 0.01;

/// How many replicates a look asks for, in multiples of a budget's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Multiple {
    halves: u32,
}

impl Multiple {
    /// None.
    pub const ZERO: Self = Self::halves(0);
    /// The budget itself.
    pub const ONE: Self = Self::halves(2);

    const fn halves(halves: u32) -> Self {
        Self { halves }
    }

    /// How many halves of the budget that is.
    pub fn in_halves(self) -> u32 {
        self.halves
    }

    /// As many times a count of the budget, which is even (of replicates, of pictures).
    pub fn of(self, count: u32) -> u32 {
        count * self.halves / 2
    }

    /// As a number.
    pub fn factor(self) -> f64 {
        f64::from(self.halves) / 2.0
    }
}

/// Up to eight times the budget, in steps of a half.
pub const FINE_LOOKS: &[Multiple] = &[
    Multiple::ONE,
    Multiple::halves(3),
    Multiple::halves(4),
    Multiple::halves(6),
    Multiple::halves(8),
    Multiple::halves(12),
    Multiple::halves(16),
];

/// Up to sixty-four times the budget, in doublings.
pub const FULL_LOOKS: &[Multiple] = &[
    Multiple::ONE,
    Multiple::halves(4),
    Multiple::halves(8),
    Multiple::halves(16),
    Multiple::halves(32),
    Multiple::halves(64),
    Multiple::halves(128),
];

/// What each look may spend of `alpha`; they add up to it.
///
/// # Errors
/// If the looks do not grow.
pub fn granted(alpha: f64, looks: &[Multiple]) -> Result<Vec<f64>, String> {
    let mut boundaries = Boundaries::new(alpha, Spending::Pocock).ok_or("no level to spend")?;
    let last = looks.last().copied().unwrap_or(Multiple::ONE).factor();
    looks
        .iter()
        .map(|look| {
            let bound = boundaries.look(look.factor() / last);
            bound.map(|b| b.granted).map_err(|e| e.to_string())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_add_up_and_the_first_look_is_granted_a_fair_share() {
        for looks in [FINE_LOOKS, FULL_LOOKS] {
            let levels = granted(1e-5, looks).expect("growing looks");
            let sum: f64 = levels.iter().sum();
            assert!((sum - 1e-5).abs() < 1e-17, "{levels:?}");
            assert!(levels.iter().all(|level| *level > 2e-7), "{levels:?}");
        }
        // Mutant rejected: looks that shrink would spend twice.
        assert!(granted(1e-5, &[Multiple::halves(4), Multiple::ONE]).is_err());
    }
}
