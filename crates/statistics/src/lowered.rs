//! The level at which a t-test of a skewed sample errs no more often than it may.
//!
//! Where skewness is against it, a t-test at one-sided level a errs more often: to first order a (1 + d(a))
//! times, d(a) = G₁ (2z² + 1) φ(z) / (6 √n a) with z at a (Hall 1992, section 2.6), and far out, where d is
//! G₁ z³ / (3 √n), a exp d(a) times (self-normalised sums: Jing, Shao & Wang 2003). The level a′ with
//!
//! ```text
//! a′ exp d(a′) = a
//! ```
//!
//! makes up for it. There is one only as long as the skewness of the mean is moderate, up to some
//! G₁/√n = 0.1 at a = 5·10⁻⁷: beyond, d grows faster than a′ falls, and nothing is said. Since exp d is more
//! than what samples of gamma distributions show, their true levels are at most a (see the test).

use crate::tails;

/// How often the bracket of the level is halved: more than a number's 53 digits.
const HALVINGS: usize = 60;

/// Where a factor of e⁻¹² does not make up for the skewness, none does: d(a′) has outgrown it.
const LOWEST: f64 = -12.0;

/// The one-sided level at which a t-test, of a mean with this standardised skewness G₁/√n, errs with
/// probability `alpha` at most; `None` where there is none.
#[must_use]
pub fn level(standardised: f64, alpha: f64) -> Option<f64> {
    // ln a′ + d(a′) − ln a: at a′ = a it is d ≥ 0, and it must reach 0 before d outgrows it.
    let excess =
        |lowered: f64| lowered + tails::distortion(standardised, alpha * libm::exp(lowered));
    let first = (1..=100)
        .map(|step| LOWEST * f64::from(step) / 100.0)
        .find(|&lowered| excess(lowered) <= 0.0)?;
    let (mut low, mut high) = (first, 0.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if excess(middle) <= 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(alpha * libm::exp(low))
}
