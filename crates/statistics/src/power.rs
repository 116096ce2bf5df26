//! Power, and the smallest effect a test can be relied on to see.
//!
//! A two-sided t-test at level α rejects β = 0 when |d/s| exceeds the critical value t. Where the
//! truth is β, d/s is noncentral t with δ = β/σ, σ the *true* standard error of d, so
//!
//! power = P(T > t | δ) + P(T > t | −δ),
//!
//! exactly, for normal errors. Equivalence within ±Δ is certified when |d| ≤ Δ − t·s, with t the
//! one-sided critical value; given s = σX that is an interval of a normal number, so
//!
//! power = E [Φ̄(−(Δ − β)/σ + tX) − Φ̄((Δ + β)/σ − tX)]₊
//!
//! over X = √(χ²ᵥ/ν) (Phillips 1990 by Owen's Q). Effects here are in units of σ. With many
//! hypotheses, α is each one's own share of the family's level.

use crate::noncentral_t;
use crate::normal;
use crate::scale_error;
use crate::student_t;

/// The probability that a two-sided t-test at level `alpha` rejects, where the true effect is
/// `noncentrality` true standard errors.
#[must_use]
pub fn two_sided(noncentrality: f64, degrees_of_freedom: f64, alpha: f64) -> f64 {
    let critical = student_t::upper_quantile(0.5 * alpha, degrees_of_freedom);
    beyond(critical, degrees_of_freedom, noncentrality)
}

/// The probability that |T| exceeds the critical value.
fn beyond(critical: f64, degrees_of_freedom: f64, noncentrality: f64) -> f64 {
    let tails = noncentral_t::sf(critical, degrees_of_freedom, noncentrality)
        + noncentral_t::sf(critical, degrees_of_freedom, -noncentrality);
    // Unlike `min`, this keeps a NaN.
    if tails > 1.0 { 1.0 } else { tails }
}

/// The smallest effect, in true standard errors, that a two-sided t-test at level `alpha` finds
/// with probability `power`; NaN unless 0 < `alpha` < `power` < 1.
#[must_use]
pub fn detectable(degrees_of_freedom: f64, alpha: f64, power: f64) -> f64 {
    if !(degrees_of_freedom > 0.0 && alpha > 0.0 && alpha < power && power < 1.0) {
        return f64::NAN;
    }
    let critical = student_t::upper_quantile(0.5 * alpha, degrees_of_freedom);
    increasing_root(critical, power, |effect| {
        beyond(critical, degrees_of_freedom, effect)
    })
}

/// The probability that equivalence within ±`margin` is certified at level `alpha`, where the
/// true difference is `effect`; both in true standard errors.
#[must_use]
pub fn equivalence(margin: f64, effect: f64, degrees_of_freedom: f64, alpha: f64) -> f64 {
    if !margin.is_finite() || !effect.is_finite() || !(degrees_of_freedom > 0.0) {
        return f64::NAN;
    }
    if !(margin > 0.0) {
        return 0.0;
    }
    let critical = student_t::upper_quantile(alpha, degrees_of_freedom);
    if !(critical > 0.0) {
        // At a level of one half or more the two rejections are not nested intervals.
        return f64::NAN;
    }
    let certified = |x: f64| {
        let reach = margin - critical * x;
        // The smaller tails, so that nothing cancels.
        let (low, high) = (-reach - effect, reach - effect);
        if low >= 0.0 {
            normal::sf(low) - normal::sf(high)
        } else if high <= 0.0 {
            normal::sf(-high) - normal::sf(-low)
        } else {
            1.0 - normal::sf(-low) - normal::sf(high)
        }
    };
    if degrees_of_freedom > 1e6 {
        return certified(1.0).max(0.0);
    }
    let edge = margin - effect.abs();
    let steep = [(edge - 9.0) / critical, (edge + 9.0) / critical];
    scale_error::mean(degrees_of_freedom, steep, margin / critical, certified).clamp(0.0, 1.0)
}

/// The smallest margin, in true standard errors, within which a true difference of `effect` is
/// certified with probability `power` at level `alpha`; NaN unless 0 < `alpha` < ½ and
/// 0 < `power` < 1.
#[must_use]
pub fn certifiable(effect: f64, degrees_of_freedom: f64, alpha: f64, power: f64) -> f64 {
    let sensible = alpha > 0.0 && alpha < 0.5 && power > 0.0 && power < 1.0;
    if !sensible || !(degrees_of_freedom > 0.0) || !effect.is_finite() {
        return f64::NAN;
    }
    let start = effect.abs() + student_t::upper_quantile(alpha, degrees_of_freedom);
    increasing_root(start, power, |margin| {
        equivalence(margin, effect, degrees_of_freedom, alpha)
    })
}

/// The fewest replicates for which a one-sample or paired t-test at level `alpha` finds an effect
/// of `effect` standard deviations *of one replicate* with probability `power`; `None` if even
/// `most` do not suffice, or for numbers out of range.
#[must_use]
pub fn replicates(effect: f64, alpha: f64, power: f64, most: u64) -> Option<u64> {
    fewest(most, power, |n| {
        two_sided(effect.abs() * n.sqrt(), n - 1.0, alpha)
    })
}

/// As [`replicates`], for Welch's test with this many replicates *on each side* and equal
/// variances.
#[must_use]
pub fn replicates_of_each(effect: f64, alpha: f64, power: f64, most: u64) -> Option<u64> {
    fewest(most, power, |n| {
        two_sided(effect.abs() * (0.5 * n).sqrt(), 2.0 * n - 2.0, alpha)
    })
}

/// The fewest n in 2..=`most` at which an increasing probability reaches `power`.
fn fewest(most: u64, power: f64, probability: impl Fn(f64) -> f64) -> Option<u64> {
    if most < 2 || !(probability(most as f64) >= power) {
        return None;
    }
    let (mut too_few, mut enough) = (1, most);
    while enough - too_few > 1 {
        let middle = too_few + (enough - too_few) / 2;
        if probability(middle as f64) >= power {
            enough = middle;
        } else {
            too_few = middle;
        }
    }
    Some(enough)
}

/// Where an increasing probability reaches `target`, from a first guess > 0, to twelve digits:
/// bracketed by doubling, then false position on the normal quantiles of the probability, which
/// grow almost evenly, with bisection whenever that does not halve the bracket.
fn increasing_root(guess: f64, target: f64, probability: impl Fn(f64) -> f64) -> f64 {
    let wanted = normal::upper_quantile(target);
    let height = |x: f64| wanted - normal::upper_quantile(probability(x));
    let (mut low, mut high) = (0.0, guess.max(1.0));
    let (mut below, mut above) = (f64::NEG_INFINITY, height(high));
    while above < 0.0 {
        (low, below) = (high, above);
        high *= 2.0;
        above = height(high);
    }
    while high - low > 1e-12 * high {
        let width = high - low;
        let chord = low + width * below / (below - above);
        for x in [chord, 0.5 * (low + high)] {
            // No chord where an end's quantile is infinite.
            if !(x > low && x < high) {
                continue;
            }
            let at = height(x);
            if at == 0.0 {
                return x;
            }
            if at < 0.0 {
                (low, below) = (x, at);
            } else {
                (high, above) = (x, at);
            }
            if high - low < 0.5 * width {
                break;
            }
        }
    }
    0.5 * (low + high)
}
