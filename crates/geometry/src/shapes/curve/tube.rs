//! A tube around a curve: rings joined by triangles, and lids.

use crate::shapes::curve::joints::{Joint, Strand};
use crate::shapes::curve::{Ends, Fineness, Net};
use core::f64::consts::{FRAC_PI_2, TAU};
use etalon_math::float64::{atan2, sin_cos};
use glam::{DVec2, DVec3};

/// A ring in its plane.
struct Ring {
    joint: Joint,
    /// The unit vector of φ = 0.
    start: DVec3,
    /// dw/2 to the length along the curve: normals lean back by as much.
    slope: f64,
}

/// `v` turned with the frame from one tangent to another, by the rotation that takes the one to the other.
fn transported(v: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let (axis, cos) = (from.cross(to), from.dot(to));
    let turned = v * cos + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cos));
    (turned - to * turned.dot(to)).normalize_or(to.any_orthonormal_vector())
}

/// `v`, across the unit vector `about`, turned about it.
fn rotated(v: DVec3, about: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = sin_cos(angle);
    v * cos + about.cross(v) * sin
}

/// The rings of a strand.
fn rings(strand: &Strand) -> Vec<Ring> {
    let joints = &strand.joints;
    let mut start = joints[0].tangent.any_orthonormal_vector();
    let mut lengths = vec![0.0];
    let mut rings: Vec<Ring> = Vec::with_capacity(joints.len());
    for (index, joint) in joints.iter().enumerate() {
        if let Some(last) = rings.last() {
            start = transported(start, last.joint.tangent, joint.tangent);
            let step = last.joint.position.distance(joint.position);
            lengths.push(lengths[index - 1] + step);
        }
        let next = joints.get(index + 1).unwrap_or(joint);
        let before = if index > 0 { &joints[index - 1] } else { joint };
        let length =
            before.position.distance(joint.position) + joint.position.distance(next.position);
        let growth = 0.5 * (next.width - before.width);
        rings.push(Ring {
            joint: *joint,
            start,
            slope: if length > 0.0 { growth / length } else { 0.0 },
        });
    }
    if strand.closed {
        // The accumulated twist of a closed curve is compensated evenly along it.
        let (first, about) = (rings[0].start, rings[0].joint.tangent);
        let twist = atan2(about.cross(first).dot(start), first.dot(start));
        let whole = lengths[lengths.len() - 1];
        for (ring, length) in rings.iter_mut().zip(&lengths) {
            ring.start = rotated(ring.start, ring.joint.tangent, -twist * length / whole);
        }
    }
    rings
}

/// Adds the corners of a ring; the last is at the place of the first.
fn corners(ring: &Ring, sides: usize, net: &mut Net) -> u32 {
    let Joint {
        u,
        position,
        tangent,
        width,
    } = ring.joint;
    let first = net.0.positions.len() as u32;
    for side in 0..=sides {
        let radial = rotated(
            ring.start,
            tangent,
            TAU * (side % sides) as f64 / sides as f64,
        );
        let uv = DVec2::new(u, side as f64 / sides as f64);
        net.corner(
            position + radial * (0.5 * width),
            radial - tangent * ring.slope,
            uv,
        );
    }
    first
}

/// Joins two rings by triangles.
fn join(a: u32, b: u32, sides: usize, net: &mut Net) {
    for side in 0..sides as u32 {
        let (a, b) = (a + side, b + side);
        net.triangle([a, a + 1, b]);
        net.triangle([a + 1, b + 1, b]);
    }
}

/// Half a ball beyond a ring whose corners are given, outward along its tangent or, with −1, against it.
fn dome(ring: &Ring, corners_of_ring: u32, outward: f64, sides: usize, net: &mut Net) {
    let radius = 0.5 * ring.joint.width;
    let steps = sides.div_ceil(4);
    let mut last = corners_of_ring;
    for step in 1..=steps {
        let (sin, cos) = sin_cos(FRAC_PI_2 * step as f64 / steps as f64);
        // A point at the pole.
        let across = if step == steps { 0.0 } else { cos };
        let center = ring.joint.position + ring.joint.tangent * (outward * radius * sin);
        let first = net.0.positions.len() as u32;
        for side in 0..=sides {
            let turn = TAU * (side % sides) as f64 / sides as f64;
            let radial = rotated(ring.start, ring.joint.tangent, turn);
            let normal = radial * across + ring.joint.tangent * (outward * sin);
            let uv = DVec2::new(ring.joint.u, side as f64 / sides as f64);
            net.corner(center + radial * (radius * across), normal, uv);
        }
        if outward > 0.0 {
            join(last, first, sides, net);
        } else {
            join(first, last, sides, net);
        }
        last = first;
    }
}

/// A flat lid on a ring.
fn lid(ring: &Ring, outward: f64, sides: usize, net: &mut Net) {
    let normal = ring.joint.tangent * outward;
    let center = net.corner(ring.joint.position, normal, DVec2::new(ring.joint.u, 0.5));
    let first = corners(ring, sides, net);
    for normals in &mut net.0.normals[first as usize..] {
        *normals = normal.as_vec3();
    }
    for side in 0..sides as u32 {
        let [a, b] = [first + side, first + side + 1];
        net.triangle(if outward > 0.0 {
            [center, a, b]
        } else {
            [center, b, a]
        });
    }
}

/// Adds the tube around a strand.
pub(super) fn add(strand: &Strand, ends: Ends, fineness: Fineness, net: &mut Net) {
    let sides = fineness.sides;
    let rings = rings(strand);
    let mut before: Option<u32> = None;
    let mut first_ring = 0;
    for (index, ring) in rings.iter().enumerate() {
        let first = corners(ring, sides, net);
        if strand.closed && index + 1 == rings.len() {
            // The start, to the last bit.
            for side in 0..=sides {
                let (from, to) = (first_ring as usize + side, first as usize + side);
                net.0.positions[to] = net.0.positions[from];
                net.0.normals[to] = net.0.normals[from];
            }
        }
        match before {
            Some(before) => join(before, first, sides, net),
            None => first_ring = first,
        }
        before = Some(first);
    }
    let (Some(last_ring), Some(first), Some(last)) = (before, rings.first(), rings.last()) else {
        return;
    };
    if strand.closed {
        return;
    }
    for (ring, corners, outward) in [(first, first_ring, -1.0), (last, last_ring, 1.0)] {
        match ends {
            Ends::Flat => lid(ring, outward, sides, net),
            Ends::Round => dome(ring, corners, outward, sides, net),
            Ends::Open => {}
        }
    }
}
