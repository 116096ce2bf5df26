//! Keyframes: a value that changes with time, between moments at which it is given.
//!
//! With h the time from one key to the next, 0 ≤ s ≤ 1 the share of it that has passed and pᵢ the values:
//!
//! ```text
//! step         p = p₀
//! linear       p = (1 − s) p₀ + s p₁
//! hermite      p = (1 − s)²(1 + 2s) p₀ + s²(3 − 2s) p₁ + s(1 − s)² h m₀ − s²(1 − s) h m₁     with tangents m
//! catmull-rom  Hermite with mᵢ = (pᵢ₊₁ − pᵢ₋₁)/(tᵢ₊₁ − tᵢ₋₁), at the ends toward the only neighbour
//! cubic        through four keys the cubic polynomial, the fourth being the first of the next four
//! ```
//!
//! Hermite's form is C. Hermite's (1877), Catmull–Rom's that of E. Catmull and R. Rom (A class of local interpolating
//! splines, 1974), and the cubic is Lagrange's; with keys at 0, 1/3, 2/3 and 1 it is the one of textbooks. Before the
//! first and after the last key the value stays.

use core::ops::{Add, Mul};

/// The interpolation between keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Interpolation {
    Step,
    #[default]
    Linear,
    CatmullRom,
    Hermite,
    Cubic,
}

impl Interpolation {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Step,
        Self::Linear,
        Self::CatmullRom,
        Self::Hermite,
        Self::Cubic,
    ];

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Linear => "linear",
            Self::CatmullRom => "catmull-rom",
            Self::Hermite => "hermite",
            Self::Cubic => "cubic",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        let is_named = |kind: &Self| kind.name() == name;
        Self::ALL.into_iter().find(is_named)
    }

    /// Whether so many keys can be interpolated: a cubic takes 4, 7, 10 …, the others any number but none.
    pub fn takes(self, keys: usize) -> bool {
        keys > 0 && (self != Self::Cubic || keys == 1 || keys % 3 == 1)
    }
}

/// A vector space over the real numbers, for interpolation.
pub trait Interpolated: Copy + Add<Output = Self> + Mul<f64, Output = Self> {}

impl<V: Copy + Add<Output = V> + Mul<f64, Output = V>> Interpolated for V {}

/// A value at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key<V> {
    /// The moment.
    pub time: f64,
    /// The value then.
    pub value: V,
    /// Its change per unit of time, which [`Interpolation::Hermite`] follows; without one it takes Catmull–Rom's.
    pub tangent: Option<V>,
}

/// The motion between two keys, for s from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece<V> {
    /// Nothing.
    Constant(V),
    /// A straight line.
    Line([V; 2]),
    /// A cubic polynomial, by its coefficients in Bernstein form.
    Cubic([V; 4]),
}

impl<V: Interpolated> Piece<V> {
    /// The value at `s`.
    pub fn at(&self, s: f64) -> V {
        let t = 1.0 - s;
        match *self {
            Self::Constant(value) => value,
            Self::Line([a, b]) => a * t + b * s,
            Self::Cubic([a, b, c, d]) => {
                a * (t * t * t) + b * (3.0 * s * t * t) + c * (3.0 * s * s * t) + d * (s * s * s)
            }
        }
    }

    /// The piece with derivatives by s at its ends.
    fn hermite([a, b]: [V; 2], [da, db]: [V; 2]) -> Self {
        let third = 1.0 / 3.0;
        Self::Cubic([a, a + da * third, b + db * -third, b])
    }

    /// The cubic polynomial through four keys.
    fn through(keys: &[Key<V>]) -> Self {
        let (first, last) = (keys[0].time, keys[3].time);
        let u: [f64; 4] = core::array::from_fn(|i| (keys[i].time - first) / (last - first));
        // Lagrange's polynomials lⱼ, which are 1 at u[j] and 0 at the others: their slope at u[i] is Σₖ 1/(u[i] − u[k])
        // for i = j, and else (w[j]/w[i])/(u[i] − u[j]) with the weights w[j] = Πₖ 1/(u[j] − u[k]).
        let others = |j: usize| (0..4).filter(move |&k| k != j);
        let weight = |j: usize| others(j).map(|k| 1.0 / (u[j] - u[k])).product::<f64>();
        let slope = |i: usize| {
            let of = |j: usize| match i == j {
                true => others(i).map(|k| 1.0 / (u[i] - u[k])).sum::<f64>(),
                false => weight(j) / weight(i) / (u[i] - u[j]),
            };
            let terms: [V; 4] = core::array::from_fn(|j| keys[j].value * of(j));
            terms[0] + terms[1] + terms[2] + terms[3]
        };
        Self::hermite([keys[0].value, keys[3].value], [slope(0), slope(3)])
    }
}

/// Catmull–Rom's tangent at the key of number `i`, of two keys or more.
pub(crate) fn catmull_rom<V: Interpolated>(keys: &[Key<V>], i: usize) -> V {
    let (a, b) = (
        &keys[i.saturating_sub(1)],
        &keys[(i + 1).min(keys.len() - 1)],
    );
    (b.value + a.value * -1.0) * (1.0 / (b.time - a.time))
}

/// A value that changes with time.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframes<V> {
    /// The moments at which pieces begin and end.
    pub(crate) times: Vec<f64>,
    pub(crate) pieces: Vec<Piece<V>>,
    pub(crate) last: V,
}

impl<V: Interpolated> Keyframes<V> {
    /// The way through `keys`, whose times must ascend. `None` if `interpolation` does not take so many.
    pub fn new(interpolation: Interpolation, keys: &[Key<V>]) -> Option<Self> {
        debug_assert!(keys.windows(2).all(|pair| pair[0].time < pair[1].time));
        let last = keys.last()?.value;
        if !interpolation.takes(keys.len()) {
            return None;
        }
        let stride = match interpolation {
            Interpolation::Cubic => 3,
            _ => 1,
        };
        let pieces = (0..keys.len() - 1).step_by(stride).map(|i| {
            let (a, b) = (&keys[i], &keys[i + 1]);
            let h = b.time - a.time;
            match interpolation {
                Interpolation::Step => Piece::Constant(a.value),
                Interpolation::Linear => Piece::Line([a.value, b.value]),
                Interpolation::CatmullRom => {
                    let tangents = [i, i + 1].map(|i| catmull_rom(keys, i) * h);
                    Piece::hermite([a.value, b.value], tangents)
                }
                Interpolation::Hermite => {
                    let of = |i: usize| keys[i].tangent.unwrap_or_else(|| catmull_rom(keys, i));
                    let tangents = [i, i + 1].map(|i| of(i) * h);
                    Piece::hermite([a.value, b.value], tangents)
                }
                Interpolation::Cubic => Piece::through(&keys[i..i + 4]),
            }
        });
        Some(Self {
            times: keys.iter().step_by(stride).map(|key| key.time).collect(),
            pieces: pieces.collect(),
            last,
        })
    }

    /// The piece at a moment and the share of it that has passed; a constant outside of all.
    #[inline]
    pub(crate) fn piece(&self, time: f64) -> (Piece<V>, f64) {
        let after = self.times.partition_point(|&begin| begin <= time);
        match after.checked_sub(1) {
            None => (Piece::Constant(self.first()), 0.0),
            Some(i) => match self.pieces.get(i) {
                None => (Piece::Constant(self.last), 0.0),
                Some(piece) => {
                    let [a, b] = [self.times[i], self.times[i + 1]];
                    (*piece, (time - a) / (b - a))
                }
            },
        }
    }

    fn first(&self) -> V {
        self.pieces.first().map_or(self.last, |piece| piece.at(0.0))
    }

    /// The value at a moment.
    pub fn at(&self, time: f64) -> V {
        let (piece, s) = self.piece(time);
        piece.at(s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn key(time: f64, value: f64, tangent: f64) -> Key<f64> {
        let tangent = Some(tangent);
        Key {
            time,
            value,
            tangent,
        }
    }

    #[test]
    fn numbers_of_keys() {
        for n in [1, 4, 7] {
            assert!(Interpolation::ALL.into_iter().all(|kind| kind.takes(n)));
        }
        assert!(!Interpolation::Cubic.takes(5) && !Interpolation::Cubic.takes(0));
        let two = [key(0.0, 1.0, 0.0), key(1.0, 2.0, 0.0)];
        assert_eq!(Keyframes::new(Interpolation::Cubic, &two), None);
        assert_eq!(Keyframes::<f64>::new(Interpolation::Linear, &[]), None);
    }

    /// The course's cubic through four points at 0, 1/3, 2/3 and 1, by its basis.
    #[test]
    fn cubic_by_its_textbook_basis() {
        let points = [1.0, -2.0, 0.5, 4.0];
        let third = |i: u32| f64::from(i) / 3.0;
        let keys: Vec<_> = (0..4)
            .map(|i| key(third(i), points[i as usize], 0.0))
            .collect();
        let curve = Keyframes::new(Interpolation::Cubic, &keys).expect("four keys");
        for i in 0..=20 {
            let u = f64::from(i) / 20.0;
            let basis = [
                -4.5 * (u - third(1)) * (u - third(2)) * (u - 1.0),
                13.5 * u * (u - third(2)) * (u - 1.0),
                -13.5 * u * (u - third(1)) * (u - 1.0),
                4.5 * u * (u - third(1)) * (u - third(2)),
            ];
            let expected: f64 = basis.iter().zip(points).map(|(b, p)| b * p).sum();
            assert!((curve.at(u) - expected).abs() < 1e-12, "at {u}");
        }
    }

    proptest! {
        /// Hermite and cubic reproduce every cubic polynomial for any key times; Catmull–Rom every quadratic
        /// between inner, evenly spaced keys; linear every line; step the previous key.
        #[test]
        fn polynomials_are_reproduced(
            c in prop::array::uniform4(-3.0..3.0f64), gaps in prop::array::uniform3(0.1..2.0f64),
            share in 0.0..1.0f64,
        ) {
            let value = |t: f64, c: [f64; 4]| c[0] + t * (c[1] + t * (c[2] + t * c[3]));
            let slope = |t: f64, c: [f64; 4]| c[1] + t * (2.0 * c[2] + t * 3.0 * c[3]);
            let keys = |c: [f64; 4], times: [f64; 4]| times.map(|t| key(t, value(t, c), slope(t, c)));
            let times = [-0.7, gaps[0] - 0.7, gaps[0] + gaps[1] - 0.7, gaps[0] + gaps[1] + gaps[2] - 0.7];
            let at = times[0] + share * (times[3] - times[0]);
            for kind in [Interpolation::Cubic, Interpolation::Hermite] {
                let curve = Keyframes::new(kind, &keys(c, times)).expect("four keys");
                prop_assert!((curve.at(at) - value(at, c)).abs() < 1e-9, "{kind:?}");
            }
            let quadratic = [c[0], c[1], c[2], 0.0];
            let even = [0.0, 1.0, 2.0, 3.0];
            let curve = Keyframes::new(Interpolation::CatmullRom, &keys(quadratic, even)).expect("keys");
            prop_assert!((curve.at(1.0 + share) - value(1.0 + share, quadratic)).abs() < 1e-9);
            let line = [c[0], c[1], 0.0, 0.0];
            let curve = Keyframes::new(Interpolation::Linear, &keys(line, times)).expect("keys");
            prop_assert!((curve.at(at) - value(at, line)).abs() < 1e-9);
            let curve = Keyframes::new(Interpolation::Step, &keys(c, times)).expect("keys");
            let last = times.into_iter().rfind(|t| *t <= at).unwrap_or(times[0]);
            prop_assert_eq!(curve.at(at), value(last, c));
        }

        /// All pass through their keys and stay before the first and after the last.
        #[test]
        fn keys_are_met(values in prop::array::uniform4(-3.0..3.0f64), gap in 0.1..2.0f64) {
            let time = |i: usize| gap * i as f64;
            let keys: [_; 4] = core::array::from_fn(|i| key(time(i), values[i], 0.3));
            for kind in Interpolation::ALL {
                let curve = Keyframes::new(kind, &keys).expect("four keys");
                for key in &keys {
                    prop_assert!((curve.at(key.time) - key.value).abs() < 1e-12, "{kind:?}");
                }
                prop_assert!((curve.at(-1.0) - values[0]).abs() < 1e-12);
                prop_assert_eq!(curve.at(9.0), values[3]);
            }
        }
    }
}
