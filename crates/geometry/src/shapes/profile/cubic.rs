//! Cubic curves in Bézier form.
//!
//! ```text
//! c(s) = (1−s)³ c₀ + 3 (1−s)² s c₁ + 3 (1−s) s² c₂ + s³ c₃,   0 ≤ s ≤ 1
//! ```

use core::ops::{Add, Mul, Sub};
use glam::DVec2;

/// What a curve goes through: points of a plane or of space, numbers.
pub(crate) trait Vector:
    Copy + Default + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}

impl<V> Vector for V where
    V: Copy + Default + PartialEq + Add<Output = V> + Sub<Output = V> + Mul<f64, Output = V>
{
}

/// A piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cubic<V = DVec2>(pub(crate) [V; 4]);

impl<V: Vector> Cubic<V> {
    /// The straight line from `a` to `b`.
    pub(crate) fn straight(a: V, b: V) -> Self {
        let between = |part: f64| a * (1.0 - part) + b * part;
        Self([a, between(1.0 / 3.0), between(2.0 / 3.0), b])
    }

    /// From `a` to `b` with the derivatives `da` and `db` there.
    pub(crate) fn hermite([a, b]: [V; 2], [da, db]: [V; 2]) -> Self {
        Self([a, a + da * (1.0 / 3.0), b - db * (1.0 / 3.0), b])
    }

    /// The point at `s`, by halving in proportion (de Casteljau's way).
    pub(crate) fn at(&self, s: f64) -> V {
        let mut b = self.0;
        for last in (1..b.len()).rev() {
            for i in 0..last {
                b[i] = b[i] + (b[i + 1] - b[i]) * s;
            }
        }
        b[0]
    }

    /// dc/ds.
    fn derivative(&self, s: f64) -> V {
        let [a, b, c] = [0, 1, 2].map(|i| self.0[i + 1] - self.0[i]);
        let rest = 1.0 - s;
        (a * (rest * rest) + b * (2.0 * rest * s) + c * (s * s)) * 3.0
    }

    /// dc/ds; at a cusp, or where inner points lie on ends, that of a place near by.
    pub(crate) fn tangent(&self, s: f64) -> V {
        let tangent = self.derivative(s);
        if tangent == V::default() {
            return self.derivative(s + (0.5 - s) * 1e-6);
        }
        tangent
    }
}

impl Cubic {
    /// The coefficients of a coordinate: 0 or 1.
    #[inline]
    pub(crate) fn coordinate(&self, axis: usize) -> [f64; 4] {
        self.0.map(|c| c[axis])
    }

    /// A box that holds it: that of its points.
    pub(crate) fn bounds(&self) -> [DVec2; 2] {
        let [a, b, c, d] = self.0;
        [a.min(b).min(c).min(d), a.max(b).max(c).max(d)]
    }
}
