//! How the error level α of a repeated test is spent as information accrues.
//!
//! A spending function α(t) grows from α(0) = 0 to α(1) = α, t the share of the planned information
//! (here of the replicates) that has been seen. What is spent at a look is gone; α is never
//! reused (Lan & DeMets 1983). All levels are two-sided:
//!
//! - O'Brien–Fleming type: 4 Φ̄(z_{α/4} / √t) — nearly nothing early, nearly all of α at the end;
//! - Pocock type: α ln(1 + (e − 1) t) — nearly equal critical values;
//! - power family: α t^ρ (Kim & DeMets 1987).

use crate::normal;

/// A spending function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spending {
    /// Hard to stop early; the last look costs little more than a single test.
    OBrienFleming,
    /// Equally hard to stop at each look.
    Pocock,
    /// α t^ρ, for ρ > 0; ρ = 3 resembles O'Brien & Fleming's, ρ = 1 Pocock's.
    Power(f64),
}

impl Spending {
    /// The part of `alpha` (two-sided) that is spent at the share `information` ∈ [0, 1]; more than 1
    /// spends all, less than 0 nothing.
    #[must_use]
    pub fn spent(self, alpha: f64, information: f64) -> f64 {
        if information >= 1.0 {
            return alpha;
        }
        if information <= 0.0 {
            return 0.0;
        }
        match self {
            Self::OBrienFleming => {
                let quarter = normal::upper_quantile(0.25 * alpha);
                4.0 * normal::sf(quarter / information.sqrt())
            }
            Self::Pocock => alpha * libm::log1p((std::f64::consts::E - 1.0) * information),
            Self::Power(rho) => alpha * libm::pow(information, rho),
        }
        .min(alpha)
    }

    /// Whether it is a spending function: ρ must be positive and finite.
    #[must_use]
    pub fn is_valid(self) -> bool {
        match self {
            Self::Power(rho) => rho > 0.0 && rho.is_finite(),
            Self::OBrienFleming | Self::Pocock => true,
        }
    }
}
