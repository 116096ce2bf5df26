//! Real roots of polynomials in double precision.

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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
