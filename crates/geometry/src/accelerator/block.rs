//! Up to eight triangles, intersected at once.
//!
//! The watertight test of Woop, Benthin & Wald (2013), see [`Probe`]: with sheared corners A, B,
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
//! A hit nearer than [`Probe::near`] is checked against a bound on the error of t (Pharr, Jakob,
//! Humphreys 2023, section 6.8.7), so that a ray never hits the triangle that it leaves.

use crate::nearest::Nearest;
use crate::probe::Probe;
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
    t: [f32; LANES],
    edges: [f32x8; 3],
    det: f32x8,
}

impl Block {
    /// A block of at most eight triangles, each with its primitive.
    pub(crate) fn new(triangles: impl Iterator<Item = ([Vec3; 3], u32)>) -> Self {
        let mut corners = [[[f32::NAN; LANES]; 3]; 3];
        let mut primitives = [u32::MAX; LANES];
        for (lane, (triangle, primitive)) in triangles.enumerate() {
            for (corner, p) in corners.iter_mut().zip(triangle) {
                corner[0][lane] = p.x;
                corner[1][lane] = p.y;
                corner[2][lane] = p.z;
            }
            primitives[lane] = primitive;
        }
        Self {
            corners: corners.map(|corner| corner.map(f32x8::new)),
            primitives,
        }
    }

    #[inline(always)]
    fn candidates(&self, probe: &Probe, t_max: f32) -> Option<Candidates> {
        let [kx, ky, kz] = probe.k;
        let origin = probe.origin.to_array();
        let o = [kx, ky, kz].map(|axis| f32x8::splat(origin[axis]));
        let [sx, sy, sz] = probe.shear.map(f32x8::splat);
        let sheared = self.corners.map(|corner| {
            let z = corner[kz] - o[2];
            let x = sx.mul_neg_add(z, corner[kx] - o[0]);
            let y = sy.mul_neg_add(z, corner[ky] - o[1]);
            [x, y, z]
        });
        let [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = sheared;
        let mut u = cx * by - cy * bx;
        let mut v = ax * cy - ay * cx;
        let mut w = bx * ay - by * ax;
        let zero = f32x8::ZERO;
        let edge = (u.simd_eq(zero) | v.simd_eq(zero) | w.simd_eq(zero)).to_bitmask();
        if edge != 0 {
            [u, v, w] = exact_edges(edge, [u, v, w], &sheared);
        }
        let positive = u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero);
        let negative = u.simd_le(zero) & v.simd_le(zero) & w.simd_le(zero);
        let inside = positive | negative;
        if !inside.any() {
            return None;
        }
        let det = u + v + w;
        let scaled = u * az + v * bz + w * cz;
        let t = scaled * sz / det;
        // False for NaN, and so for a triangle seen edge-on (0/0).
        let ahead = t.simd_gt(zero) & t.simd_le(f32x8::splat(t_max));
        let lanes = (inside & ahead).to_bitmask();
        (lanes != 0).then(|| Candidates {
            lanes,
            t: t.to_array(),
            edges: [u, v, w],
            det,
        })
    }

    /// Whether the hit of `lane` at `t` is ahead of the ray's origin beyond doubt.
    #[inline]
    fn is_ahead(&self, probe: &Probe, lane: usize, t: f32, edges: [f32; 3], det: f32) -> bool {
        let [kx, ky, kz] = probe.k;
        let relative = self.corners.map(|corner| {
            let at = |axis: usize| corner[axis].as_array()[lane] - probe.origin[axis];
            [at(kx), at(ky), at(kz)]
        });
        let depth = relative.map(|[_, _, z]| z * probe.shear[2]);
        // t is a mean of the corners' depths, whatever the error of its weights.
        if depth[0].min(depth[1]).min(depth[2]) > probe.near {
            return true;
        }
        let largest = |f: &dyn Fn(usize) -> f32| f(0).max(f(1)).max(f(2));
        let max_z = largest(&|i| depth[i].abs());
        let max_x = largest(&|i| (relative[i][0] - probe.shear[0] * relative[i][2]).abs());
        let max_y = largest(&|i| (relative[i][1] - probe.shear[1] * relative[i][2]).abs());
        let max_z_raw = largest(&|i| relative[i][2].abs());
        let delta_z = gamma(3) * max_z;
        let delta_x = gamma(5) * (max_x + max_z_raw);
        let delta_y = gamma(5) * (max_y + max_z_raw);
        let delta_e = 2.0 * (gamma(2) * max_x * max_y + delta_y * max_x + delta_x * max_y);
        let max_e = largest(&|i| edges[i].abs());
        let delta_t =
            3.0 * (gamma(3) * max_e * max_z + delta_e * max_z + delta_z * max_e) / det.abs();
        t > delta_t
    }

    /// Notes the nearest triangle that the ray hits, if it wins over what is known.
    #[inline(always)]
    pub(crate) fn intersect(&self, probe: &Probe, nearest: &mut Nearest) {
        let Some(candidates) = self.candidates(probe, nearest.t) else {
            return;
        };
        let edges = candidates.edges.map(|e| e.to_array());
        let det = candidates.det.to_array();
        let mut lanes = candidates.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            let t = candidates.t[lane];
            let [u, v, w] = edges.map(|e| e[lane]);
            if nearest.loses_to(t, self.primitives[lane])
                && self.is_ahead(probe, lane, t, [u, v, w], det[lane])
            {
                let parameters = Vec2::new(v, w) / det[lane];
                nearest.set(t, self.primitives[lane], parameters);
            }
        }
    }

    /// Whether the ray hits any triangle before `t_max`.
    #[inline(always)]
    pub(crate) fn occludes(&self, probe: &Probe, t_max: f32) -> bool {
        let Some(candidates) = self.candidates(probe, t_max) else {
            return false;
        };
        let edges = candidates.edges.map(|e| e.to_array());
        let det = candidates.det.to_array();
        let mut lanes = candidates.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            let t = candidates.t[lane];
            if t < t_max && self.is_ahead(probe, lane, t, edges.map(|e| e[lane]), det[lane]) {
                return true;
            }
        }
        false
    }
}

/// Edge functions of some lanes in double precision: a product of two floats is exact there, so
/// the sign of the difference is right.
#[cold]
#[inline(never)]
fn exact_edges(lanes: u32, edges: [f32x8; 3], sheared: &[[f32x8; 3]; 3]) -> [f32x8; 3] {
    let mut edges = edges.map(|e| e.to_array());
    for lane in (0..LANES).filter(|lane| lanes & (1 << lane) != 0) {
        let corner = |i: usize| {
            let at = |axis: usize| f64::from(sheared[i][axis].as_array()[lane]);
            (at(0), at(1))
        };
        let (a, b, c) = (corner(0), corner(1), corner(2));
        let cross = |p: (f64, f64), q: (f64, f64)| (p.0 * q.1 - p.1 * q.0) as f32;
        edges[0][lane] = cross(c, b);
        edges[1][lane] = cross(a, c);
        edges[2][lane] = cross(b, a);
    }
    edges.map(f32x8::new)
}
