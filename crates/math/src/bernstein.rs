//! Polynomials in Bernstein form, and every place where one changes its sign.
//!
//! ```text
//! f(s) = Σᵢ C(n, i) bᵢ sⁱ (1−s)ⁿ⁻ⁱ,   0 ≤ s ≤ 1
//! ```
//!
//! f has at most as many zeros in (0, 1) as its coefficients have changes of sign, and differs from that by an even
//! number (Descartes's rule of signs in this basis; J. Lane, R. Riesenfeld 1981, *Bounds on a polynomial*). With none
//! there is no zero, with one exactly one; otherwise the interval is halved (P. de Casteljau 1959).

use crate::bracket::Bracket;
use core::ops::ControlFlow;

/// C(n, i).
const fn binomial(n: usize, i: usize) -> f64 {
    let (mut k, mut result) = (0, 1.0);
    while k < i {
        result = result * ((n - k) as f64) / ((k + 1) as f64);
        k += 1;
    }
    result
}

/// Weights of the products of coefficients in a product: C(m, i) C(n, j) / C(m + n, i + j).
struct Weights<const M: usize, const N: usize>;

impl<const M: usize, const N: usize> Weights<M, N> {
    const TABLE: [[f64; N]; M] = {
        let mut table = [[0.0; N]; M];
        let mut i = 0;
        while i < M {
            let mut j = 0;
            while j < N {
                table[i][j] = binomial(M - 1, i) * binomial(N - 1, j) / binomial(M + N - 2, i + j);
                j += 1;
            }
            i += 1;
        }
        table
    };
}

/// The product of two polynomials; L = M + N − 1. At the ends exactly the product of the ends.
#[inline]
pub fn product<const M: usize, const N: usize, const L: usize>(
    a: &[f64; M],
    b: &[f64; N],
) -> [f64; L] {
    debug_assert_eq!(L, M + N - 1);
    let mut result = [0.0; L];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            result[i + j] += Weights::<M, N>::TABLE[i][j] * x * y;
        }
    }
    result
}

/// Its value at `s`.
pub fn value<const N: usize>(coefficients: &[f64; N], s: f64) -> f64 {
    let mut b = *coefficients;
    for last in (1..N).rev() {
        for i in 0..last {
            b[i] += s * (b[i + 1] - b[i]);
        }
    }
    b[0]
}

/// Calls `visit` with every s in [0, 1] where a polynomial changes its sign, in ascending order, and with whether it
/// is negative before; until told to break. Zeros less than `smallest` apart may be missed in pairs.
pub fn sign_changes<const N: usize, R>(
    coefficients: &[f64; N],
    smallest: f64,
    mut visit: impl FnMut(f64, bool) -> ControlFlow<R>,
) -> Option<R> {
    match search(coefficients, (0.0, 1.0), smallest, &mut visit) {
        ControlFlow::Break(found) => Some(found),
        ControlFlow::Continue(()) => None,
    }
}

fn search<const N: usize, R>(
    b: &[f64; N],
    (first, last): (f64, f64),
    smallest: f64,
    visit: &mut impl FnMut(f64, bool) -> ControlFlow<R>,
) -> ControlFlow<R> {
    let changes = (b.windows(2))
        .filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0))
        .count();
    if changes == 0 {
        return ControlFlow::Continue(());
    }
    if changes == 1 || last - first < smallest {
        let inside = b[0] < 0.0;
        if inside == (b[N - 1] < 0.0) {
            return ControlFlow::Continue(());
        }
        return visit(first + (last - first) * refine(b), inside);
    }
    // Both halves, by repeated averages.
    let (mut left, mut right) = ([b[0]; N], *b);
    for (step, corner) in left.iter_mut().enumerate().skip(1) {
        for i in 0..N - step {
            right[i] = 0.5 * (right[i] + right[i + 1]);
        }
        *corner = right[0];
    }
    let middle = 0.5 * (first + last);
    search(&left, (first, middle), smallest, visit)?;
    search(&right, (middle, last), smallest, visit)
}

/// C(n, i) of all i.
struct Binomials<const N: usize>;

impl<const N: usize> Binomials<N> {
    const ROW: [f64; N] = {
        let mut row = [0.0; N];
        let mut i = 0;
        while i < N {
            row[i] = binomial(N - 1, i);
            i += 1;
        }
        row
    };
}

/// The zero between ends of different sign, to the last digits: by Newton's method between bounds, as a polynomial of
/// x = s/(1−s) up to the middle and of (1−s)/s beyond.
fn refine<const N: usize>(b: &[f64; N]) -> f64 {
    let scaled: [f64; N] = core::array::from_fn(|i| Binomials::<N>::ROW[i] * b[i]);
    let before = b[0] < 0.0;
    let middle: f64 = scaled.iter().sum();
    let first_half = (middle < 0.0) != before;
    let c: [f64; N] = core::array::from_fn(|i| scaled[if first_half { i } else { N - 1 - i }]);
    let negative = c[0] < 0.0;
    let mut bracket = Bracket::new(0.0, 1.0);
    // The zero of the chord between the ends.
    let (mut x, mut last_step) = (c[0] / (c[0] - middle), 1.0);
    for _ in 0..80 {
        let (mut value, mut slope) = (0.0_f64, 0.0_f64);
        for c in c.iter().rev() {
            slope = slope.mul_add(x, value);
            value = value.mul_add(x, *c);
        }
        bracket.cut(x, (value < 0.0) != negative);
        let step = value / slope;
        // Near the zero steps shrink quadratically until only rounding is left, which never ends and may lie outside.
        if step.abs() <= 2e-16 || (step.abs() <= 1e-10 && step.abs() > 0.25 * last_step) {
            break;
        }
        let next = bracket.within(x - step);
        last_step = (next - x).abs();
        x = next;
    }
    if first_half {
        x / (1.0 + x)
    } else {
        1.0 / (1.0 + x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The product of (s − r) over the roots.
    fn with_roots(roots: [f64; 6]) -> [f64; 7] {
        let factor = |r: f64| [-r, 1.0 - r];
        let two: [f64; 3] = product(&factor(roots[0]), &factor(roots[1]));
        let three: [f64; 4] = product(&two, &factor(roots[2]));
        let four: [f64; 5] = product(&three, &factor(roots[3]));
        let five: [f64; 6] = product(&four, &factor(roots[4]));
        product(&five, &factor(roots[5]))
    }

    fn zeros(coefficients: &[f64; 7]) -> Vec<(f64, bool)> {
        let mut found = Vec::new();
        sign_changes(coefficients, 1e-9, |s, inside| {
            found.push((s, inside));
            ControlFlow::<()>::Continue(())
        });
        found
    }

    proptest! {
        #[test]
        fn every_zero_is_found(mut roots in prop::array::uniform6(-0.5f64..1.5)) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|pair| pair[1] - pair[0] > 1e-3));
            prop_assume!(roots.iter().all(|r| r.abs() > 1e-6 && (r - 1.0).abs() > 1e-6));
            let polynomial = with_roots(roots);
            let found = zeros(&polynomial);
            let wanted: Vec<f64> = roots.into_iter().filter(|r| (0.0..=1.0).contains(r)).collect();
            prop_assert_eq!(found.len(), wanted.len(), "{:?} {:?}", found, wanted);
            for (index, ((s, inside), r)) in found.iter().zip(&wanted).enumerate() {
                prop_assert!((s - r).abs() < 1e-8, "{} is not {}", s, r);
                prop_assert_eq!(*inside, (value(&polynomial, 0.0) < 0.0) ^ (index % 2 == 1));
            }
        }
    }

    #[test]
    fn a_product_is_one() {
        let (a, b) = ([0.3, -1.0, 2.0, 0.7], [1.1, 0.2, -0.4, 3.0]);
        let ab: [f64; 7] = product(&a, &b);
        for k in 0..=10 {
            let s = f64::from(k) / 10.0;
            assert!((value(&ab, s) - value(&a, s) * value(&b, s)).abs() < 1e-13);
        }
        assert_eq!((ab[0], ab[6]), (0.3 * 1.1, 0.7 * 3.0));
    }

    #[test]
    fn a_zero_that_changes_no_sign_is_none() {
        assert_eq!(zeros(&with_roots([0.5, 0.5, 2.0, 3.0, 4.0, 5.0])), []);
    }
}
