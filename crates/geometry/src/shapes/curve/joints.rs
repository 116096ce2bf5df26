//! A curve as joints with straight pieces between: as many as it takes.

use crate::shapes::curve::Fineness;
use core::f64::consts::PI;
use etalon_math::float64::{atan2, sin_cos};
use glam::DVec3;

/// A place on a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Joint {
    /// The parameter along the curve, from 0 to 1.
    pub(super) u: f64,
    pub(super) position: DVec3,
    /// The direction onward, a unit vector.
    pub(super) tangent: DVec3,
    pub(super) width: f64,
}

/// A curve in one piece.
#[derive(Clone, Debug)]
pub(super) struct Strand {
    pub(super) joints: Vec<Joint>,
    /// Whether its last joint is the first again.
    pub(super) closed: bool,
}

/// The most halvings of a piece.
const DEEPEST: u32 = 12;

/// The angle between unit vectors.
fn angle(a: DVec3, b: DVec3) -> f64 {
    atan2(a.cross(b).length(), a.dot(b))
}

/// Adds the joints after `a` up to `b`; `between` computes one in the middle, or `None` if there is none.
pub(super) fn refine(
    [a, b]: [Joint; 2],
    fineness: Fineness,
    between: &mut dyn FnMut(&Joint, &Joint) -> Option<Joint>,
    joints: &mut Vec<Joint>,
) {
    refine_within([a, b], 0, fineness, between, joints);
}

fn refine_within(
    [a, b]: [Joint; 2],
    depth: u32,
    fineness: Fineness,
    between: &mut dyn FnMut(&Joint, &Joint) -> Option<Joint>,
    joints: &mut Vec<Joint>,
) {
    let middle = if depth < DEEPEST {
        between(&a, &b)
    } else {
        None
    };
    if let Some(middle) = middle {
        let chord = b.position - a.position;
        let from = middle.position - a.position;
        let along = (from.dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
        let off = (from - chord * if along.is_finite() { along } else { 0.0 }).length();
        let allowed = fineness.off() * a.width.max(b.width).max(middle.width);
        let wider = (middle.width - 0.5 * (a.width + b.width)).abs();
        let turned = angle(a.tangent, middle.tangent) + angle(middle.tangent, b.tangent);
        if off > allowed || wider > 2.0 * allowed || turned > fineness.turn() {
            refine_within([a, middle], depth + 1, fineness, between, joints);
            refine_within([middle, b], depth + 1, fineness, between, joints);
            return;
        }
    }
    joints.push(b);
}

/// Where the tangent still jumps, turns it step by step; leaves out joints that say nothing new.
pub(super) fn turned(joints: &[Joint], fineness: Fineness) -> Vec<Joint> {
    let mut all: Vec<Joint> = Vec::with_capacity(joints.len());
    for joint in joints {
        if let Some(last) = all.last().copied() {
            let whole = angle(last.tangent, joint.tangent);
            if last.position == joint.position && last.width == joint.width && whole < 1e-9 {
                continue;
            }
            let steps = (whole / fineness.turn()).ceil().max(1.0);
            // At a reversal the direction of the turn is arbitrary.
            let aside = joint.tangent - last.tangent * last.tangent.dot(joint.tangent);
            let aside = if whole > 0.999 * PI {
                last.tangent.any_orthonormal_vector()
            } else {
                aside.normalize_or_zero()
            };
            for step in 1..steps as u32 {
                let part = f64::from(step) / steps;
                let (sin, cos) = sin_cos(part * whole);
                all.push(Joint {
                    u: last.u + (joint.u - last.u) * part,
                    position: last.position.lerp(joint.position, part),
                    tangent: last.tangent * cos + aside * sin,
                    width: last.width + (joint.width - last.width) * part,
                });
            }
        }
        all.push(*joint);
    }
    all
}
