//! Eight pairs of a ray and a triangle, tested at once: one ray and eight triangles, or eight rays and one triangle.
//!
//! The watertight test of Woop, Benthin & Wald (2013), see [`TraversalRay`]: with sheared corners A, B,
//! C relative to the ray, the edge functions
//!
//! ```text
//! U = C×B,   V = A×C,   W = B×A,     det = U + V + W
//! t = (U·A_z + V·B_z + W·C_z) / det,     b₁ = V/det,   b₂ = W/det
//! ```
//!
//! have equal signs exactly if the ray passes through the triangle. Products are rounded before
//! they are subtracted (no fused operations there), so that the same edge seen from the
//! neighbour gives exactly the opposite number; where one is zero all three are taken again in
//! double precision, where the products are exact. Zero counts as inside for both neighbours.
//!
//! A hit nearer than [`TraversalRay::near`] is checked against a bound on the error of t (Pharr, Jakob,
//! Humphreys 2023, section 6.8.7), so that a ray never hits the triangle that it leaves.
//!
//! No lane depends on another, so a pair has the same result whatever pairs are tested with it.

use super::block::{Block, LANES};
use crate::traversal_ray::TraversalRay;
use core::hint::black_box;
use etalon_math::gamma;
use wide::f32x8;

/// What the test needs of rays, see [`TraversalRay`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct TestedRays {
    pub(crate) permuted: [f32x8; 3],
    pub(crate) shear: [f32x8; 3],
    pub(crate) near: f32x8,
}

impl TestedRays {
    /// One ray in all lanes.
    #[inline(always)]
    pub(super) fn splat(ray: &TraversalRay) -> Self {
        let all = |[x, y, z]: [f32; 3]| [f32x8::splat(x), f32x8::splat(y), f32x8::splat(z)];
        Self {
            permuted: all(ray.permuted),
            shear: all(ray.shear),
            near: f32x8::splat(ray.near),
        }
    }

    /// The ray of one lane in all lanes.
    #[inline(always)]
    pub(super) fn spread(&self, lane: usize) -> Self {
        let spread = |x: &f32x8| f32x8::splat(x.as_array()[lane]);
        let all = |[x, y, z]: &[f32x8; 3]| [spread(x), spread(y), spread(z)];
        Self {
            permuted: all(&self.permuted),
            shear: all(&self.shear),
            near: spread(&self.near),
        }
    }
}

/// The pairs that meet.
pub(super) struct Meetings {
    /// All bits of their lanes, and none of the others.
    pub(super) meeting: f32x8,
    pub(super) t: f32x8,
    v: f32x8,
    w: f32x8,
    det: f32x8,
}

impl Meetings {
    /// Barycentric coordinates of the second and third corner.
    #[inline(always)]
    pub(super) fn parameters(&self) -> [f32x8; 2] {
        [self.v / self.det, self.w / self.det]
    }

    /// The same in one lane.
    #[inline(always)]
    pub(super) fn parameters_of(&self, lane: usize) -> [f32; 2] {
        let det = self.det.as_array()[lane];
        [self.v.as_array()[lane] / det, self.w.as_array()[lane] / det]
    }
}

/// The pairs that meet ahead of the ray's origin and not beyond `t_max`; `corner(block, i, j)` is corner
/// i's coordinate along axis j of [`TraversalRay::k`].
// Written out: `map` over arrays of vectors is not reliably inlined.
#[inline(always)]
pub(super) fn meet(
    block: &Block,
    corner: impl Fn(&Block, usize, usize) -> f32x8,
    rays: &TestedRays,
    t_max: f32x8,
) -> Option<Meetings> {
    let [ox, oy, oz] = rays.permuted;
    let [sx, sy, sz] = rays.shear;
    let x = |i: usize| corner(block, i, 0) - ox;
    let y = |i: usize| corner(block, i, 1) - oy;
    let z = |i: usize| corner(block, i, 2) - oz;
    let (az, bz, cz) = (z(0), z(1), z(2));
    let (ax, ay) = (sx.mul_neg_add(az, x(0)), sy.mul_neg_add(az, y(0)));
    let (bx, by) = (sx.mul_neg_add(bz, x(1)), sy.mul_neg_add(bz, y(1)));
    let (cx, cy) = (sx.mul_neg_add(cz, x(2)), sy.mul_neg_add(cz, y(2)));
    let mut u = cx * by - cy * bx;
    let mut v = ax * cy - ay * cx;
    let mut w = bx * ay - by * ax;
    let zero = f32x8::ZERO;
    // Not (some positive and some negative), false for NaN; and all lanes with a zero.
    let low = u.fast_min(v).fast_min(w);
    let high = u.fast_max(v).fast_max(w);
    let mut inside = low.simd_ge(zero) | high.simd_le(zero);
    if !inside.any() {
        // With a zero among them, two numbers still have opposite signs here; these do not
        // depend on the zero's true sign.
        return None;
    }
    let edge = u.simd_eq(zero) | v.simd_eq(zero) | w.simd_eq(zero);
    if edge.any() {
        let sheared = [[ax, ay], [bx, by], [cx, cy]];
        // Only those lanes: the result must not depend on other pairs.
        let exact = exact_edges(edge.to_bitmask(), &sheared);
        u = edge.select(exact[0], u);
        v = edge.select(exact[1], v);
        w = edge.select(exact[2], w);
        let low = u.fast_min(v).fast_min(w);
        let high = u.fast_max(v).fast_max(w);
        inside = low.simd_ge(zero) | high.simd_le(zero);
    }
    let det = u + v + w;
    let scaled = u * az + v * bz + w * cz;
    let t = scaled * sz / det;
    // False for NaN, and so for a triangle seen edge-on (0/0).
    let ahead = t.simd_gt(zero) & t.simd_le(t_max);
    let mut meeting = inside & ahead;
    if !meeting.any() {
        return None;
    }
    // t is a weighted mean of the corners' depths, with inexact weights.
    let depth = (az * sz).fast_min(bz * sz).fast_min(cz * sz);
    let beyond_doubt = depth.simd_gt(rays.near);
    if (meeting & !beyond_doubt).any() {
        // Loaded again, so that nothing is kept for this branch.
        let block = black_box(block);
        let corners = [
            [
                corner(block, 0, 0),
                corner(block, 0, 1),
                corner(block, 0, 2),
            ],
            [
                corner(block, 1, 0),
                corner(block, 1, 1),
                corner(block, 1, 2),
            ],
            [
                corner(block, 2, 0),
                corner(block, 2, 1),
                corner(block, 2, 2),
            ],
        ];
        meeting &= beyond_doubt | is_far_enough(&corners, &{ *rays }, &[t, det, u, v, w]);
    }
    Some(Meetings {
        meeting,
        t,
        v,
        w,
        det,
    })
}

/// Whether t exceeds the bound on its error.
#[inline(never)]
fn is_far_enough(
    [a, b, c]: &[[f32x8; 3]; 3],
    rays: &TestedRays,
    [t, det, u, v, w]: &[f32x8; 5],
) -> f32x8 {
    let [ox, oy, oz] = rays.permuted;
    let [sx, sy, sz] = rays.shear;
    let (az, bz, cz) = (a[2] - oz, b[2] - oz, c[2] - oz);
    let x = |corner: f32x8, z: f32x8| corner - ox - sx * z;
    let y = |corner: f32x8, z: f32x8| corner - oy - sy * z;
    let largest = |a: f32x8, b: f32x8, c: f32x8| a.abs().fast_max(b.abs()).fast_max(c.abs());
    let max_x = largest(x(a[0], az), x(b[0], bz), x(c[0], cz));
    let max_y = largest(y(a[1], az), y(b[1], bz), y(c[1], cz));
    let max_z = largest(az, bz, cz);
    let max_e = largest(*u, *v, *w);
    let times = |factor: f32, x: f32x8| f32x8::splat(factor) * x;
    let delta_z = times(gamma(3), max_z);
    let delta_x = times(gamma(5), max_x + max_z);
    let delta_y = times(gamma(5), max_y + max_z);
    let delta_e = times(gamma(2), max_x) * max_y + delta_y * max_x + delta_x * max_y;
    let delta = times(gamma(3), max_e) * max_z + times(2.0, delta_e) * max_z + delta_z * max_e;
    t.simd_gt(times(3.0, delta) * (sz / *det).abs())
}

/// Edge functions of some lanes in double precision: a product of two floats is exact there, so the sign of the
/// difference is right.
#[cold]
#[inline(never)]
fn exact_edges(lanes: u32, sheared: &[[f32x8; 2]; 3]) -> [f32x8; 3] {
    let mut edges = [[0.0; LANES]; 3];
    for lane in (0..LANES).filter(|lane| lanes >> lane & 1 != 0) {
        let corner = |i: usize| sheared[i].map(|x| f64::from(x.as_array()[lane]));
        let (a, b, c) = (corner(0), corner(1), corner(2));
        let cross = |p: [f64; 2], q: [f64; 2]| (p[0] * q[1] - p[1] * q[0]) as f32;
        edges[0][lane] = cross(c, b);
        edges[1][lane] = cross(a, c);
        edges[2][lane] = cross(b, a);
    }
    edges.map(f32x8::new)
}
