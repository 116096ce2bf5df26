//! A box around everything that a moving box passes through while the shutter is open.
//!
//! Straight motion from key to key: over a step in which R turns by ω, a point c's way deviates from the straight line
//! between its ends by at most max|x″|/8, and |x″| ≤ ω²|S c| + 2ω|ΔS c| since T and S are linear in time.
//!
//! Along a curve the way of a point is a rational one: with the unnormalised quaternion q, and R(q) homogeneous of
//! degree two in its components,
//!
//! ```text
//! x(s) = T(s) + R(q(s)) S(s) c / |q(s)|²
//! ```
//!
//! of degree 9. In Bernstein form it lies in the convex hull of its control points, which under subdivision close in on
//! it quadratically (G. Farin, Curves and surfaces for CAGD, chapter on rational Bézier curves).

use crate::bernstein::product;
use crate::float64::acos;
use crate::keyframes::Piece;
use crate::motion::{Motion, parts_on};
use crate::parts::Parts;
use glam::DVec3;

/// A box that grows.
struct Hull {
    min: DVec3,
    max: DVec3,
}

impl Hull {
    fn include(&mut self, point: DVec3, slack: f64) {
        self.min = self.min.min(point - slack);
        self.max = self.max.max(point + slack);
    }
}

impl Motion {
    /// Corners of a box that holds the box from `low` to `high` at every time from 0 to 1.
    pub fn swept(&self, low: DVec3, high: DVec3) -> [DVec3; 2] {
        let corner = |i: usize| {
            let side = |axis: usize| if i >> axis & 1 == 0 { low } else { high }[axis];
            DVec3::new(side(0), side(1), side(2))
        };
        let corners: [DVec3; 8] = core::array::from_fn(corner);
        let mut hull = Hull {
            min: DVec3::INFINITY,
            max: DVec3::NEG_INFINITY,
        };
        for time in [0.0, 1.0] {
            let map = self.at(time);
            for c in corners {
                hull.include(map.transform_point3(c), 0.0);
            }
        }
        for (piece, [from, to]) in self.spans() {
            match piece {
                Piece::Constant(parts) => {
                    let map = parts.map();
                    for c in corners {
                        hull.include(map.transform_point3(c), 0.0);
                    }
                }
                Piece::Line(_) => straight(&piece, [from, to], &corners, &mut hull),
                Piece::Cubic(values) => curved(&values, [from, to], &corners, 0, &mut hull),
            }
        }
        [hull.min, hull.max]
    }
}

fn straight(piece: &Piece<Parts>, [from, to]: [f64; 2], corners: &[DVec3; 8], hull: &mut Hull) {
    /// A step turns no farther (rad), so that the deviation is below half a percent of the size.
    const TURN: f64 = 0.2;
    let on = |s: f64| parts_on(piece, s);
    let cos = on(from).rotation.dot(on(to).rotation);
    let angle = 2.0 * acos(cos.abs().min(1.0));
    let steps = (angle / TURN).ceil().clamp(1.0, 64.0) as u32;
    let omega = angle / f64::from(steps);
    let s = |i: u32| from + (to - from) * f64::from(i) / f64::from(steps);
    for step in 0..steps {
        let [a, b] = [step, step + 1].map(|i| on(s(i)));
        let slack = corners.map(|c| {
            let size = (a.stretch * c).length().max((b.stretch * c).length());
            let change = ((b.stretch - a.stretch) * c).length();
            (omega * omega * size + 2.0 * omega * change) / 8.0
        });
        let slack = slack.into_iter().fold(0.0, f64::max);
        for map in [a.map(), b.map()] {
            for c in corners {
                hull.include(map.transform_point3(*c), slack);
            }
        }
    }
}

/// The share of a cubic piece from s = `from` to `to`, by its blossom.
fn share(values: &[Parts; 4], [from, to]: [f64; 2]) -> [Parts; 4] {
    let blossom = |s: [f64; 3]| {
        let mut b = *values;
        for (last, s) in [3, 2, 1].into_iter().zip(s) {
            for i in 0..last {
                b[i] = b[i] * (1.0 - s) + b[i + 1] * s;
            }
        }
        b[0]
    };
    [
        blossom([from; 3]),
        blossom([from, from, to]),
        blossom([from, to, to]),
        blossom([to; 3]),
    ]
}

/// Halves of a piece are looked at to this depth.
const DEPTH: u32 = 4;

fn curved(
    values: &[Parts; 4],
    [from, to]: [f64; 2],
    corners: &[DVec3; 8],
    depth: u32,
    hull: &mut Hull,
) {
    if depth < DEPTH {
        let middle = 0.5 * (from + to);
        curved(values, [from, middle], corners, depth + 1, hull);
        curved(values, [middle, to], corners, depth + 1, hull);
        return;
    }
    let piece = share(values, [from, to]);
    let q = |axis: usize| piece.map(|parts| parts.rotation.to_array()[axis]);
    // The products of q's components, and with them R(q) and |q|² as polynomials of degree 6.
    let square = |i: usize, j: usize| -> [f64; 7] { product(&q(i), &q(j)) };
    let sum = |terms: &[(f64, [f64; 7])]| {
        let of = |n: usize| terms.iter().map(|(factor, term)| factor * term[n]).sum();
        core::array::from_fn::<f64, 7, _>(of)
    };
    let [x, y, z, w] = [0, 1, 2, 3];
    let squares = [x, y, z, w].map(|i| square(i, i));
    let norm = sum(&squares.map(|term| (1.0, term)));
    let entry = |i: usize, j: usize| {
        if i == j {
            let sign = |axis: usize| if axis == i || axis == w { 1.0 } else { -1.0 };
            return sum(&[x, y, z, w].map(|axis| (sign(axis), squares[axis])));
        }
        let third = 3 - i - j;
        let sign = if (i + 1) % 3 == j { -2.0 } else { 2.0 };
        sum(&[(2.0, square(i, j)), (sign, square(third, w))])
    };
    let rotation: [[[f64; 7]; 3]; 3] =
        core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
    let weights: [f64; 10] = product(&norm, &[1.0; 4]);
    let is_hull = weights.iter().all(|weight| *weight > 1e-3);
    for c in corners {
        if !is_hull {
            // The quaternion comes near zero: for any rotation the point is at most this far from T.
            let reach = piece.map(|parts| (parts.stretch * *c).length());
            let reach = reach.into_iter().fold(0.0, f64::max);
            for parts in piece {
                hull.include(parts.translation, reach);
            }
            continue;
        }
        let stretched: [[f64; 4]; 3] =
            core::array::from_fn(|axis| piece.map(|parts| (parts.stretch * *c)[axis]));
        let along: [[f64; 10]; 3] = core::array::from_fn(|i| {
            let place = piece.map(|parts| parts.translation[i]);
            let mut total: [f64; 10] = product(&norm, &place);
            for (entry, stretched) in rotation[i].iter().zip(&stretched) {
                let term: [f64; 10] = product(entry, stretched);
                for (sum, term) in total.iter_mut().zip(term) {
                    *sum += term;
                }
            }
            total
        });
        for (n, weight) in weights.iter().enumerate() {
            let point = DVec3::new(along[0][n], along[1][n], along[2][n]) / *weight;
            hull.include(point, 1e-9 * point.abs().max_element());
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::keyframes::Interpolation;
    use crate::motion::{Motion, MotionKey};
    use glam::{DMat4, DVec3, Vec3Swizzles};
    use proptest::prelude::*;

    fn placed(at: DVec3, turn: f64, scale: DVec3) -> DMat4 {
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        DMat4::from_translation(at) * DMat4::from_axis_angle(axis, turn) * DMat4::from_scale(scale)
    }

    proptest! {
        /// The box of a moving box holds all its points at all times, and is not much larger than it must be.
        #[test]
        fn swept_boxes_hold_everything(
            at in prop::array::uniform3(-5.0..5.0f64), turns in prop::array::uniform4(-3.1..3.1f64),
            scale in prop::array::uniform3(0.5..2.0f64), inside in prop::array::uniform3(0.0..1.0f64),
            velocity in prop::array::uniform3(-9.0..9.0f64), kind in 0..5usize,
        ) {
            let [at, scale] = [at, scale].map(DVec3::from);
            let keys = [
                (-0.2, placed(DVec3::ZERO, turns[0], DVec3::ONE)),
                (0.3, placed(at, turns[1], scale)),
                (0.6, placed(at.zxy(), turns[2], scale)),
                (1.1, placed(-at, turns[3], scale.yzx())),
            ];
            let keys = keys.map(|key| MotionKey { velocity: Some(DVec3::from(velocity)), ..key.into() });
            let Ok(motion) = Motion::new(Interpolation::ALL[kind], &keys) else {
                return Ok(());
            };
            let (low, high) = (DVec3::new(1.0, -2.0, 0.5), DVec3::new(3.0, 2.0, 4.0));
            let [min, max] = motion.swept(low, high);
            let point = low + (high - low) * DVec3::from(inside);
            let (mut seen_min, mut seen_max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            for i in 0..=200 {
                let map = motion.at(f64::from(i) / 200.0);
                let seen = map.transform_point3(point);
                prop_assert!(seen.cmpge(min).all() && seen.cmple(max).all());
                for corner in 0..8 {
                    let side = |axis: usize| if corner >> axis & 1 == 0 { low } else { high }[axis];
                    let seen = map.transform_point3(DVec3::new(side(0), side(1), side(2)));
                    seen_min = seen_min.min(seen);
                    seen_max = seen_max.max(seen);
                }
            }
            let size = (seen_max - seen_min).max_element();
            prop_assert!(((max - min) - (seen_max - seen_min)).max_element() < 0.1 * size, "{:?}", kind);
        }
    }
}
