//! Power, and the smallest effect a test can be relied on to see.
//!
//! A two-sided t-test at level α rejects β = 0 when |d/s| exceeds the critical value t. Where the
//! truth is β, d/s is noncentral t with δ = β/σ, σ the *true* standard error of d, so
//!
//! power = P(T > t | δ) + P(T > t | −δ),
//!
//! exactly, for normal errors. Effects here are in units of σ. With many hypotheses, α is each one's own share of the family's level.

use crate::noncentral_t;
use crate::normal;
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
