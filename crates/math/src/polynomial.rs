//! Real roots of polynomials in double precision.

use crate::bracket::Bracket;

/// The real roots of a·t² + b·t + c = 0 in ascending order, without the cancellation of the
/// schoolbook formula (Press et al. 2007, section 5.6). `None` if there is no real root or the
/// equation has no unknown; a linear equation gives its one root twice.
#[inline]
pub fn quadratic(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    if a == 0.0 {
        if b == 0.0 {
            return None;
        }
        let t = -c / b;
        return Some((t, t));
    }
    let discriminant = b.mul_add(b, -4.0 * a * c);
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let q = -0.5 * (b + root.copysign(b));
    let (t0, t1) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    Some(if t0 <= t1 { (t0, t1) } else { (t1, t0) })
}

/// Real roots in ascending order, at most `N` of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roots<const N: usize> {
    roots: [f64; N],
    count: usize,
}

impl<const N: usize> Roots<N> {
    const NONE: Self = Self {
        roots: [0.0; N],
        count: 0,
    };

    fn push(&mut self, root: f64) {
        // Two pieces that meet in a root find it twice.
        let is_new = self.count == 0 || self.roots[self.count - 1] != root;
        if is_new && self.count < N {
            self.roots[self.count] = root;
            self.count += 1;
        }
    }

    /// The roots.
    pub fn as_slice(&self) -> &[f64] {
        &self.roots[..self.count]
    }
}

/// p(t) = Σ cᵢ tⁱ.
fn polynomial(c: &[f64], t: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, &c| sum.mul_add(t, c))
}

/// The root of a polynomial that is monotone from `low` to `high` and changes its sign there: Newton's steps, and
/// halving where they leave the bracket.
fn bracketed(c: &[f64], derivative: &[f64], [low, high]: [f64; 2]) -> f64 {
    let rising = polynomial(c, high) > polynomial(c, low);
    let mut bracket = Bracket::new(low, high);
    let mut t = bracket.middle();
    for _ in 0..100 {
        let value = polynomial(c, t);
        if value == 0.0 {
            return t;
        }
        bracket.cut(t, (value > 0.0) == rising);
        let next = bracket.within(t - value / polynomial(derivative, t));
        if next == t || (next - t).abs() <= 1e-15 * t.abs() {
            return next;
        }
        t = next;
    }
    t
}

/// The real roots of Σ cᵢ tⁱ, of a degree not above 4, between `low` and `high`. Between the roots of the derivative a
/// polynomial is monotone, so that each root is bracketed; a double root is found if rounding makes it two, or touches
/// zero.
pub fn quartic_roots(c: [f64; 5], low: f64, high: f64) -> Roots<4> {
    let mut derivatives = [c; 4];
    for k in 1..4 {
        let before = derivatives[k - 1];
        derivatives[k] = core::array::from_fn(|i| match before.get(i + 1) {
            Some(&next) => next * (i + 1) as f64,
            None => 0.0,
        });
    }
    // From the linear third derivative up.
    let mut roots = Roots::<4>::NONE;
    for k in (0..4).rev() {
        let (p, d) = (
            &derivatives[k],
            derivatives.get(k + 1).copied().unwrap_or_else(|| {
                let third = derivatives[3];
                [third[1], 0.0, 0.0, 0.0, 0.0]
            }),
        );
        let mut found = Roots::<4>::NONE;
        let mut ends = [high; 6];
        ends[0] = low;
        ends[1..=roots.count].copy_from_slice(roots.as_slice());
        for piece in ends[..roots.count + 2].windows(2) {
            let [a, b] = [piece[0], piece[1]];
            let [at_a, at_b] = [a, b].map(|t| polynomial(p, t));
            if at_a == 0.0 {
                found.push(a);
            }
            if at_a * at_b < 0.0 {
                found.push(bracketed(p, &d, [a, b]));
            }
        }
        if polynomial(p, high) == 0.0 {
            found.push(high);
        }
        roots = found;
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(2), ..ProptestConfig::with_cases(2000) })]
        #[test]
        fn recovers_four_roots(mut r in prop::array::uniform4(-4.0f64..4.0), scale in 0.1f64..10.0) {
            r.sort_by(f64::total_cmp);
            prop_assume!(r.windows(2).all(|w| w[1] - w[0] > 1e-2));
            let mut c = [scale, 0.0, 0.0, 0.0, 0.0];
            for root in r {
                for i in (0..5).rev() {
                    c[i] = if i > 0 { c[i - 1] } else { 0.0 } - root * c[i];
                }
            }
            let found = quartic_roots(c, -5.0, 5.0);
            prop_assert_eq!(found.as_slice().len(), 4);
            for (found, root) in found.as_slice().iter().zip(r) {
                prop_assert!((found - root).abs() < 1e-7, "{} {}", found, root);
            }
            // Only those within the interval.
            let inner = quartic_roots(c, r[0] + 1e-3, r[2] + 1e-3);
            prop_assert_eq!(inner.as_slice().len(), 2);
        }
    }

    #[test]
    fn fewer_roots_and_lower_degrees() {
        let roots = |c| quartic_roots(c, -10.0, 10.0).as_slice().to_vec();
        assert!(roots([1.0, 0.0, 0.0, 0.0, 1.0]).is_empty());
        assert_eq!(roots([-4.0, 0.0, 1.0, 0.0, 0.0]), [-2.0, 2.0]);
        assert_eq!(roots([-3.0, 1.0, 0.0, 0.0, 0.0]), [3.0]);
        assert!(roots([1.0, 0.0, 0.0, 0.0, 0.0]).is_empty());
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::with_cases(1000) })]
        #[test]
        fn recovers_known_roots(a in 0.1f64..10.0, r in -100.0f64..100.0, s in -100.0f64..100.0) {
            let (low, high) = if r < s { (r, s) } else { (s, r) };
            prop_assume!(high - low > 1e-3);
            let (t0, t1) = quadratic(a, -a * (r + s), a * r * s).expect("two real roots");
            prop_assert!((t0 - low).abs() < 1e-6 && (t1 - high).abs() < 1e-6);
        }
    }

    #[test]
    fn tiny_root_survives_cancellation() {
        let (t0, _) = quadratic(1.0, -1e9, 1.0).expect("two real roots");
        assert!((t0 * 1e9 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn degenerate_equations() {
        assert_eq!(quadratic(0.0, 0.0, 1.0), None);
        assert_eq!(quadratic(0.0, 2.0, -4.0), Some((2.0, 2.0)));
        assert_eq!(quadratic(1.0, 0.0, 1.0), None);
        assert_eq!(quadratic(1.0, 0.0, 0.0), Some((0.0, 0.0)));
    }
}
