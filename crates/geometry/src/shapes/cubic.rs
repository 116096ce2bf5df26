//! Cubic curves in Bézier form, and sequences of them in a plane.
//!
//! ```text
//! c(s) = (1−s)³ c₀ + 3 (1−s)² s c₁ + 3 (1−s) s² c₂ + s³ c₃,   0 ≤ s ≤ 1
//! ```

use core::ops::{Add, Mul, Sub};
use glam::DVec2;

/// The values of a curve: points of a plane or of space, numbers.
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

/// Pieces, one after another.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    pieces: Vec<Cubic>,
    /// Boxes of the binary tree over the pieces: a node, then the nodes of its first half, then those of its second.
    boxes: Vec<[DVec2; 2]>,
}

impl Profile {
    /// A sequence of one piece or more.
    pub(crate) fn new(pieces: Vec<Cubic>) -> Self {
        let mut boxes = Vec::with_capacity(2 * pieces.len());
        add_boxes(&pieces, &mut boxes);
        Self { pieces, boxes }
    }

    /// The pieces.
    pub(crate) fn pieces(&self) -> &[Cubic] {
        &self.pieces
    }

    /// Its end points.
    pub(crate) fn ends(&self) -> [DVec2; 2] {
        [self.pieces[0].0[0], self.pieces[self.pieces.len() - 1].0[3]]
    }

    /// Whether it ends where it begins.
    pub(crate) fn is_closed(&self) -> bool {
        let [first, last] = self.ends();
        first == last
    }

    /// A box that holds it.
    pub(crate) fn bounds(&self) -> [DVec2; 2] {
        self.boxes[0]
    }

    /// The parameter along the whole, from 0 to 1, of the place `s` of a piece.
    pub(crate) fn part(&self, index: usize, s: f64) -> f64 {
        (index as f64 + s) / self.pieces.len() as f64
    }

    /// A place on it as a crossing keeps it: the piece's number from 1, negative if the normal is to be turned, and s.
    pub(crate) fn kept((index, s): (usize, f64), turned: bool) -> DVec2 {
        let number = index as f64 + 1.0;
        DVec2::new(if turned { -number } else { number }, s)
    }

    /// The same again: piece, s, and −1 if the normal is to be turned.
    pub(crate) fn place(&self, kept: DVec2) -> (usize, f64, f64) {
        let number = kept.x.abs().clamp(1.0, self.pieces.len() as f64);
        (number as usize - 1, kept.y, 1.0_f64.copysign(kept.x))
    }

    /// Points along it, `count` for each piece, and the last.
    pub(crate) fn points(&self, count: u32) -> impl Iterator<Item = DVec2> + '_ {
        let inner = move |piece: &'_ Cubic| {
            let piece = *piece;
            (0..count).map(move |k| piece.at(f64::from(k) / f64::from(count)))
        };
        self.pieces.iter().flat_map(inner).chain([self.ends()[1]])
    }

    /// Calls `visit` with the number of each piece in whose box, and in all above it, `meets` finds something.
    #[inline]
    pub(crate) fn search(&self, meets: impl Fn([DVec2; 2]) -> bool, mut visit: impl FnMut(usize)) {
        // Halves still to be looked at: node, first piece, one past the last.
        let mut waiting = [(0, 0, self.pieces.len()); 32];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (node, first, end) = waiting[count];
            if !meets(self.boxes[node]) {
                continue;
            }
            if end - first == 1 {
                visit(first);
                continue;
            }
            let middle = first.midpoint(end);
            waiting[count] = (node + 2 * (middle - first), middle, end);
            waiting[count + 1] = (node + 1, first, middle);
            count += 2;
        }
    }
}

fn add_boxes(pieces: &[Cubic], boxes: &mut Vec<[DVec2; 2]>) -> [DVec2; 2] {
    let own = boxes.len();
    boxes.push([DVec2::ZERO; 2]);
    let bounds = if let [piece] = pieces {
        piece.bounds()
    } else {
        let (first, second) = pieces.split_at(pieces.len() / 2);
        let ([a, b], [c, d]) = (add_boxes(first, boxes), add_boxes(second, boxes));
        [a.min(c), b.max(d)]
    };
    boxes[own] = bounds;
    bounds
}
