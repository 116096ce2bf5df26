//! Weighted arc length of a curve, and uniform sampling by it, for surfaces swept from the curve.
//!
//! ```text
//! A = ∫ w(c(s)) |c′(s)| ds
//! ```
//!
//! Each cubic piece is cut into [`CELLS`] cells, each integrated by Gauss's rule of five points.

use crate::shapes::profile::cubic::Cubic;
use etalon_math::Bracket;
use glam::DVec2;

/// Cells of a piece.
const CELLS: usize = 8;

/// Gauss's points on [0, 1], and their weights.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_0, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// Weighted lengths up to the end of each cell.
#[derive(Clone, Debug)]
pub(crate) struct Lengths {
    upto: Vec<f64>,
    weight: fn(DVec2) -> f64,
}

impl Lengths {
    /// Those of a sequence of pieces.
    pub(crate) fn new(pieces: &[Cubic], weight: fn(DVec2) -> f64) -> Self {
        let mut lengths = Self {
            upto: Vec::with_capacity(CELLS * pieces.len()),
            weight,
        };
        let mut sum = 0.0;
        for piece in pieces {
            for cell in 0..CELLS {
                let [first, last] = [cell, cell + 1].map(|k| k as f64 / CELLS as f64);
                sum += lengths.between(piece, first, last);
                lengths.upto.push(sum);
            }
        }
        lengths
    }

    /// The total.
    pub(crate) fn total(&self) -> f64 {
        self.upto[self.upto.len() - 1]
    }

    fn density(&self, piece: &Cubic, s: f64) -> f64 {
        (self.weight)(piece.at(s)) * piece.tangent(s).length()
    }

    fn between(&self, piece: &Cubic, first: f64, last: f64) -> f64 {
        let size = last - first;
        let terms = GAUSS.map(|(x, weight)| weight * self.density(piece, first + size * x));
        size * terms.into_iter().sum::<f64>()
    }

    /// The piece, and the place on it, below which is the part `u` of the whole.
    pub(crate) fn sample(&self, pieces: &[Cubic], u: f64) -> (usize, f64) {
        let wanted = u * self.total();
        let cell = self.upto.partition_point(|&upto| upto <= wanted);
        let cell = cell.min(self.upto.len() - 1);
        let before = if cell > 0 { self.upto[cell - 1] } else { 0.0 };
        let piece = &pieces[cell / CELLS];
        let first = (cell % CELLS) as f64 / CELLS as f64;
        let mut bracket = Bracket::new(first, first + 1.0 / CELLS as f64);
        let mut s = bracket.middle();
        for _ in 0..40 {
            let off = before + self.between(piece, first, s) - wanted;
            bracket.cut(s, off > 0.0);
            let next = bracket.within(s - off / self.density(piece, s));
            if (next - s).abs() < 1e-12 {
                break;
            }
            s = next;
        }
        (cell / CELLS, s)
    }
}
