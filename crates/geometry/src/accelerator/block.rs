//! Up to eight triangles, intersected at once.
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

use crate::closest_hit::ClosestHit;
use crate::traversal_ray::TraversalRay;
use etalon_math::gamma;
use glam::{Vec2, Vec3};
use wide::f32x8;

/// Number of triangles in a block.
pub(crate) const LANES: usize = 8;

/// Up to eight triangles; unused lanes have NaN corners, which nothing hits.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Block {
    /// Corner, axis, lane.
    corners: [[f32x8; 3]; 3],
    primitives: [u32; LANES],
}

/// The lanes that a ray hits, before rounding of t is looked at.
struct Candidates {
    lanes: u32,
    t: f32x8,
    u: f32x8,
    v: f32x8,
    w: f32x8,
    det: f32x8,
}

impl Block {
    /// A block of at most eight triangles, each with its primitive.
    pub(crate) fn new(triangles: impl Iterator<Item = ([Vec3; 3], u32)>) -> Self {
        let mut corners = [[[f32::NAN; LANES]; 3]; 3];
        let mut primitives = [u32::MAX; LANES];
        for (lane, (triangle, primitive)) in triangles.enumerate() {
            for (corner, p) in corners.iter_mut().zip(triangle) {
                let [x, y, z] = corner;
                (x[lane], y[lane], z[lane]) = (p.x, p.y, p.z);
            }
            primitives[lane] = primitive;
        }
        let axes = |corner: usize| {
            let [x, y, z] = corners[corner];
            [f32x8::new(x), f32x8::new(y), f32x8::new(z)]
        };
        Self {
            corners: [axes(0), axes(1), axes(2)],
            primitives,
        }
    }

    /// Number of triangles.
    pub(crate) fn len(&self) -> usize {
        let used = self.primitives.iter();
        used.filter(|&&primitive| primitive != u32::MAX).count()
    }

    /// The corners of the triangle in a slot of `blocks`.
    #[inline]
    pub(crate) fn corners(blocks: &[Self], slot: u32) -> [Vec3; 3] {
        let Self { corners, .. } = &blocks[slot as usize / LANES];
        let lane = slot as usize % LANES;
        let corner = |c: usize| {
            let [x, y, z] = &corners[c];
            Vec3::new(x.as_array()[lane], y.as_array()[lane], z.as_array()[lane])
        };
        [corner(0), corner(1), corner(2)]
    }

    // Written out: `map` over arrays of vectors is not reliably inlined.
    #[inline(always)]
    fn candidates(&self, probe: &TraversalRay, t_max: f32) -> Option<Candidates> {
        let [kx, ky, kz] = probe.k;
        let (kx, ky, kz) = (kx.min(2), ky.min(2), kz.min(2));
        let ox = f32x8::splat(probe.permuted[0]);
        let oy = f32x8::splat(probe.permuted[1]);
        let oz = f32x8::splat(probe.permuted[2]);
        let sx = f32x8::splat(probe.shear[0]);
        let sy = f32x8::splat(probe.shear[1]);
        let [a, b, c] = &self.corners;
        let (az, bz, cz) = (a[kz] - oz, b[kz] - oz, c[kz] - oz);
        let ax = sx.mul_neg_add(az, a[kx] - ox);
        let ay = sy.mul_neg_add(az, a[ky] - oy);
        let bx = sx.mul_neg_add(bz, b[kx] - ox);
        let by = sy.mul_neg_add(bz, b[ky] - oy);
        let cx = sx.mul_neg_add(cz, c[kx] - ox);
        let cy = sy.mul_neg_add(cz, c[ky] - oy);
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
            // Only those lanes: the result must not depend on a triangle's neighbours in the block.
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
        let t = scaled * f32x8::splat(probe.shear[2]) / det;
        // False for NaN, and so for a triangle seen edge-on (0/0).
        let ahead = t.simd_gt(zero) & t.simd_le(f32x8::splat(t_max));
        let lanes = (inside & ahead).to_bitmask();
        (lanes != 0).then_some(Candidates {
            lanes,
            t,
            u,
            v,
            w,
            det,
        })
    }

    /// Whether the hit of `lane` at `t` is ahead of the ray's origin beyond doubt.
    #[inline(always)]
    fn is_ahead(&self, probe: &TraversalRay, lane: usize, candidates: &Candidates) -> bool {
        let kz = probe.k[2].min(2);
        let scale = probe.shear[2];
        let depth =
            |corner: usize| (self.corners[corner][kz].as_array()[lane] - probe.permuted[2]) * scale;
        // t is a weighted mean of the corners' depths, with inexact weights.
        depth(0).min(depth(1)).min(depth(2)) > probe.near
            || self.is_far_enough(probe, lane, candidates)
    }

    /// Whether t exceeds the bound on its error.
    #[inline(never)]
    fn is_far_enough(&self, probe: &TraversalRay, lane: usize, candidates: &Candidates) -> bool {
        let [kx, ky, kz] = probe.k;
        let along = |corner: usize, axis: usize, origin: f32| {
            self.corners[corner][axis.min(2)].as_array()[lane] - origin
        };
        let [ox, oy, oz] = probe.permuted;
        let z = |i: usize| along(i, kz, oz);
        let x = |i: usize| along(i, kx, ox) - probe.shear[0] * z(i);
        let y = |i: usize| along(i, ky, oy) - probe.shear[1] * z(i);
        let largest = |a: f32, b: f32, c: f32| a.abs().max(b.abs()).max(c.abs());
        let max_x = largest(x(0), x(1), x(2));
        let max_y = largest(y(0), y(1), y(2));
        let max_z = largest(z(0), z(1), z(2));
        let edge = |e: &f32x8| e.as_array()[lane];
        let max_e = largest(
            edge(&candidates.u),
            edge(&candidates.v),
            edge(&candidates.w),
        );
        let delta_z = gamma(3) * max_z;
        let delta_x = gamma(5) * (max_x + max_z);
        let delta_y = gamma(5) * (max_y + max_z);
        let delta_e = 2.0 * (gamma(2) * max_x * max_y + delta_y * max_x + delta_x * max_y);
        let delta = gamma(3) * max_e * max_z + delta_e * max_z + delta_z * max_e;
        let det = candidates.det.as_array()[lane];
        candidates.t.as_array()[lane] > 3.0 * delta * (probe.shear[2] / det).abs()
    }

    /// Updates `nearest` with the nearest triangle that the ray hits; this is block number `index`.
    #[inline(always)]
    pub(crate) fn intersect(&self, index: usize, probe: &TraversalRay, nearest: &mut ClosestHit) {
        let Some(candidates) = self.candidates(probe, nearest.t) else {
            return;
        };
        let mut lanes = candidates.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            let t = candidates.t.as_array()[lane];
            let primitive = self.primitives[lane];
            if nearest.loses_to(t, primitive) && self.is_ahead(probe, lane, &candidates) {
                let weights =
                    Vec2::new(candidates.v.as_array()[lane], candidates.w.as_array()[lane]);
                let parameters = weights / candidates.det.as_array()[lane];
                nearest.set(t, primitive, (index * LANES + lane) as u32, parameters);
            }
        }
    }

    /// Whether the ray hits any triangle before `t_max`.
    #[inline(always)]
    pub(crate) fn occludes(&self, probe: &TraversalRay, t_max: f32) -> bool {
        let Some(candidates) = self.candidates(probe, t_max) else {
            return false;
        };
        let mut lanes = candidates.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            if candidates.t.as_array()[lane] < t_max && self.is_ahead(probe, lane, &candidates) {
                return true;
            }
        }
        false
    }
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
