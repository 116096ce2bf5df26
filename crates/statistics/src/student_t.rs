//! Student's t distribution: upper tails and their inverse, for real degrees of freedom.
//!
//! Degrees of freedom above 10⁶, infinity included, are treated as the normal limit: the
//! difference is below 10⁻⁴ relative at a tail of 10⁻¹², while the incomplete beta function
//! loses more digits than that.

use crate::normal;
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::cell::RefCell;

/// Above this many degrees of freedom the normal distribution takes over.
const NORMAL: f64 = 1e6;

/// The probability that a t-distributed number exceeds `t`; NaN for a NaN or for degrees of
/// freedom that are not positive.
#[must_use]
pub fn sf(t: f64, degrees_of_freedom: f64) -> f64 {
    if t.is_nan() || !(degrees_of_freedom > 0.0) {
        f64::NAN
    } else if degrees_of_freedom > NORMAL {
        normal::sf(t)
    } else if t.is_infinite() {
        if t > 0.0 { 0.0 } else { 1.0 }
    } else {
        StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(f64::NAN, |student| student.sf(t))
    }
}

/// The probability that a t-distributed number is at least as far from zero as `t`.
#[must_use]
pub fn two_sided(t: f64, degrees_of_freedom: f64) -> f64 {
    2.0 * sf(t.abs(), degrees_of_freedom)
}

/// The number a t-distributed one exceeds with probability `tail`: +∞ for 0, −∞ for 1, NaN
/// outside [0, 1] or for degrees of freedom that are not positive.
#[must_use]
pub fn upper_quantile(tail: f64, degrees_of_freedom: f64) -> f64 {
    if !(0.0..=1.0).contains(&tail) || !(degrees_of_freedom > 0.0) {
        return f64::NAN;
    }
    if degrees_of_freedom > NORMAL {
        return normal::upper_quantile(tail);
    }
    if tail > 0.5 {
        return -upper_quantile(1.0 - tail, degrees_of_freedom);
    }
    if tail == 0.5 {
        return 0.0;
    }
    if tail == 0.0 {
        return f64::INFINITY;
    }
    remembered(tail, degrees_of_freedom)
}

/// How many quantiles a thread remembers.
const REMEMBERED: usize = 16;

/// [`solve`], or what it said before: of many samples of one size the same few quantiles are asked for.
fn remembered(tail: f64, degrees_of_freedom: f64) -> f64 {
    thread_local! {
        /// Tail, degrees of freedom and quantile, and the place of the next.
        static KNOWN: RefCell<(usize, [[f64; 3]; REMEMBERED])> = const { RefCell::new((0, [[f64::NAN; 3]; REMEMBERED])) };
    }
    KNOWN.with_borrow_mut(|(next, known)| {
        let asked = |[of, at, _]: &&[f64; 3]| *of == tail && *at == degrees_of_freedom;
        if let Some([.., quantile]) = known.iter().find(asked) {
            return *quantile;
        }
        let quantile = solve(tail, degrees_of_freedom);
        known[*next] = [tail, degrees_of_freedom, quantile];
        *next = (*next + 1) % REMEMBERED;
        quantile
    })
}

/// The quantile of a tail in (0, ½).
fn solve(tail: f64, degrees_of_freedom: f64) -> f64 {
    // The t distribution has the heavier tail, so the normal quantile is a lower bound.
    let mut low = normal::upper_quantile(tail);
    let mut high = 2.0 * low.max(0.5);
    while sf(high, degrees_of_freedom) > tail {
        low = high;
        high *= 2.0;
    }
    // Between the two, ln sf falls nearly straight along ln(1 + t²/n): false position on it,
    // with bisection whenever that does not halve the bracket.
    let target = libm::log(tail);
    let height = |t: f64| libm::log(sf(t, degrees_of_freedom)) - target;
    let (mut above, mut below) = (height(low), height(high));
    loop {
        let width = high - low;
        if width <= 4.0 * f64::EPSILON * high {
            return low + 0.5 * width;
        }
        let chord = (low + width * above / (above - below)).clamp(low, high);
        for t in [chord, 0.5 * (low + high)] {
            if t <= low || t >= high {
                continue;
            }
            let at = height(t);
            if at == 0.0 {
                return t;
            }
            if at > 0.0 {
                (low, above) = (t, at);
            } else {
                (high, below) = (t, at);
            }
            if high - low < 0.5 * width {
                break;
            }
        }
    }
}
