//! Every place where a function of one parameter changes its sign, by interval arithmetic.

use core::ops::ControlFlow;
use etalon_math::expression::Number;
use etalon_math::{Dual, Interval};

/// More halvings than that change nothing in double precision.
const DEEPEST: usize = 64;

/// A function of one parameter.
pub(crate) trait OneParameter {
    /// Its value in any arithmetic.
    fn eval<N: Number>(&self, s: N) -> N;

    /// Whether s lies inside; an undefined value is outside.
    #[inline]
    fn is_inside(&self, s: f64) -> bool {
        self.eval(s) < 0.0
    }
}

/// Calls `visit` with every s in [`first`, `last`] where `f` changes its sign, in ascending order, and with whether `f`
/// is negative before, until `visit` breaks. Pieces for which `skip` is true are skipped. Only pairs of changes in a
/// piece shorter than `smallest` are missed.
///
/// The subdivision does not depend on `skip`, so that a change always has the same bits.
pub(crate) fn sign_changes<F: OneParameter, R>(
    f: &F,
    (first, last): (f64, f64),
    smallest: f64,
    skip: impl Fn(f64, f64) -> bool,
    mut visit: impl FnMut(f64, bool) -> ControlFlow<R>,
) -> Option<R> {
    let ends = [first, last].map(|s| f.is_inside(s));
    let mut pieces = [(first, last, ends[0], ends[1]); DEEPEST];
    let mut waiting = 1;
    while waiting > 0 {
        waiting -= 1;
        let (a, b, inside, then) = pieces[waiting];
        if skip(a, b) {
            continue;
        }
        let (passed, single) = enclose(f, a, b);
        if passed {
            continue;
        }
        let middle = 0.5 * (a + b);
        let small = b - a < smallest || !(middle > a && middle < b);
        if single || small || waiting + 2 > DEEPEST {
            if inside != then
                && let ControlFlow::Break(found) = visit(refine(f, a, b, inside), inside)
            {
                return Some(found);
            }
            continue;
        }
        let between = f.is_inside(middle);
        pieces[waiting] = (middle, b, between, then);
        pieces[waiting + 1] = (a, middle, inside, between);
        waiting += 2;
    }
    None
}

/// Whether f has no zero in [a, b], and whether it has one at most: from its values there, and from
/// f(m) + F′·([a, b] − m) with the middle m and the slopes F′ there.
fn enclose<F: OneParameter>(f: &F, a: f64, b: f64) -> (bool, bool) {
    let piece = Interval { low: a, high: b };
    let Dual { value, slope } = f.eval(Dual {
        value: piece,
        slope: Interval::constant(1.0),
    });
    if !value.has_zero() {
        return (true, true);
    }
    if !slope.has_zero() {
        return (false, true);
    }
    let middle = 0.5 * (a + b);
    let off = Interval::around(a - middle, b - middle);
    let mean_value = f.eval(Interval::constant(middle)).add(slope.mul(off));
    (!value.meet(mean_value).has_zero(), false)
}

/// The change of sign between `a`, which is inside or not, and `b`, to the last digits.
pub(crate) fn refine<F: OneParameter>(f: &F, mut a: f64, mut b: f64, inside: bool) -> f64 {
    let (mut fa, mut fb) = (f.eval(a), f.eval(b));
    for step in 0..200 {
        let middle = 0.5 * (a + b);
        if !(middle > a && middle < b) {
            break;
        }
        // The chord's zero, in turn with halving.
        let chord = a - fa * (b - a) / (fb - fa);
        let s = if step % 3 < 2 && chord > a && chord < b {
            chord
        } else {
            middle
        };
        let fs = f.eval(s);
        if fs == 0.0 {
            return s;
        }
        if (fs < 0.0) == inside {
            (a, fa) = (s, fs);
        } else {
            (b, fb) = (s, fs);
        }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::Cell;

    /// √(s − ¾) − ¼, which is defined from ¾ on and vanishes at 13/16; counts its evaluations.
    struct Root(Cell<u32>);

    impl OneParameter for Root {
        fn eval<N: Number>(&self, s: N) -> N {
            self.0.set(self.0.get() + 1);
            s.shift(-0.75).sqrt().shift(-0.25)
        }
    }

    /// An undefined interval is one piece; it is not subdivided down to the shortest.
    #[test]
    fn a_piece_that_is_undefined_everywhere_is_passed_over() {
        let root = Root(Cell::new(0));
        let mut changes = Vec::new();
        let found: Option<()> = sign_changes(
            &root,
            (0.0, 1.0),
            1e-6,
            |_, _| false,
            |s, inside| {
                changes.push((s, inside));
                ControlFlow::Continue(())
            },
        );
        assert_eq!(found, None);
        let [(begins, false), (ends, true)] = changes[..] else {
            panic!("{changes:?}");
        };
        assert!((begins - 0.75).abs() < 1e-6 && (ends - 0.8125).abs() < 1e-12);
        assert!(root.0.get() < 500, "{} evaluations", root.0.get());
    }
}
