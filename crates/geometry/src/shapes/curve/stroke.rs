//! A flat stroke along a plane curve, without overlaps.

use crate::shapes::curve::joints::{Joint, Strand};
use crate::shapes::curve::uncovered::{Corner, Sheet};
use crate::shapes::curve::{Ends, Fineness, Net};
use core::f64::consts::PI;
use etalon_math::float64::sin_cos;
use glam::{DVec2, DVec3};

/// The ends of the stroke's width at a joint.
fn across(joint: &Joint) -> [Corner; 2] {
    let normal = joint.tangent.truncate().perp();
    [(-0.5, 0.0), (0.5, 1.0)].map(|(part, v)| Corner {
        position: joint.position.truncate() + normal * (part * joint.width),
        uv: DVec2::new(joint.u, v),
    })
}

/// Half a disk beyond a joint, outward along its tangent or, with −1, against it.
fn half_disk(joint: &Joint, outward: f64, fineness: Fineness, sheet: &mut Sheet) {
    let center = joint.position.truncate();
    let (tangent, radius) = (joint.tangent.truncate() * outward, 0.5 * joint.width);
    let steps = fineness.sides.div_ceil(2);
    let at = |step: usize| {
        let (sin, cos) = sin_cos(PI * step as f64 / steps as f64);
        let side = tangent.perp() * -cos;
        Corner {
            position: center + (side + tangent * sin) * radius,
            uv: DVec2::new(joint.u, 0.5 - 0.5 * outward * cos),
        }
    };
    let middle = Corner {
        position: center,
        uv: DVec2::new(joint.u, 0.5),
    };
    for step in 0..steps {
        sheet.add([middle, at(step), at(step + 1)]);
    }
}

/// Adds the strokes along strands.
pub(super) fn add(strands: &[Strand], ends: Ends, fineness: Fineness, net: &mut Net) {
    let joints = strands.iter().flat_map(|strand| &strand.joints);
    let widest = joints.map(|joint| joint.width).fold(0.0, f64::max);
    let mut sheet = Sheet::new(widest);
    for Strand { joints, closed } in strands {
        for pair in joints.windows(2) {
            let [[a, b], [c, d]] = [across(&pair[0]), across(&pair[1])];
            sheet.add([a, c, b]);
            sheet.add([c, d, b]);
        }
        if !closed && ends == Ends::Round {
            half_disk(&joints[0], -1.0, fineness, &mut sheet);
            half_disk(&joints[joints.len() - 1], 1.0, fineness, &mut sheet);
        }
    }
    for triangle in sheet.triangles() {
        let corners =
            triangle.map(|corner| net.corner(corner.position.extend(0.0), DVec3::Z, corner.uv));
        net.triangle(corners);
    }
}
