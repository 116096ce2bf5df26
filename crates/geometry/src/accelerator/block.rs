//! Up to eight triangles, intersected at once.

use super::packet::{PacketHits, RayPacket};
use super::tested_rays::{self, Meetings, TestedRays};
use crate::closest_hit::ClosestHit;
use crate::traversal_ray::TraversalRay;
use glam::Vec3;
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

    /// The triangles that a ray, the same in all lanes, meets; not beyond `t_max`.
    #[inline(always)]
    fn meet(&self, k: [usize; 3], ray: &TestedRays, t_max: f32) -> Option<Meetings> {
        let [kx, ky, kz] = k;
        let k = [kx.min(2), ky.min(2), kz.min(2)];
        let corner = |block: &Self, i: usize, j: usize| block.corners[i][k[j]];
        tested_rays::meet(self, corner, ray, f32x8::splat(t_max))
    }

    /// Updates `nearest` with the nearest triangle that the ray hits; this is block number `index`.
    #[inline(always)]
    pub(crate) fn intersect(&self, index: usize, probe: &TraversalRay, nearest: &mut ClosestHit) {
        self.intersect_tested(index, (probe.k, &TestedRays::splat(probe)), nearest);
    }

    /// The same with a ray that is the same in all lanes, and its axes.
    #[inline(always)]
    pub(super) fn intersect_tested(
        &self,
        index: usize,
        (k, ray): ([usize; 3], &TestedRays),
        nearest: &mut ClosestHit,
    ) {
        let Some(meetings) = self.meet(k, ray, nearest.t) else {
            return;
        };
        let mut lanes = meetings.meeting.to_bitmask();
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            let t = meetings.t.as_array()[lane];
            let primitive = self.primitives[lane];
            if nearest.loses_to(t, primitive) {
                let parameters = meetings.parameters_of(lane).into();
                nearest.set(t, primitive, (index * LANES + lane) as u32, parameters);
            }
        }
    }

    /// Whether the ray hits any triangle before `t_max` that `stops` it.
    #[inline(always)]
    pub(crate) fn occludes(
        &self,
        probe: &TraversalRay,
        t_max: f32,
        stops: impl Fn(u32) -> bool,
    ) -> bool {
        self.occludes_tested((probe.k, &TestedRays::splat(probe)), t_max, stops)
    }

    /// The same with a ray that is the same in all lanes, and its axes.
    #[inline(always)]
    pub(super) fn occludes_tested(
        &self,
        (k, ray): ([usize; 3], &TestedRays),
        t_max: f32,
        stops: impl Fn(u32) -> bool,
    ) -> bool {
        let Some(meetings) = self.meet(k, ray, t_max) else {
            return false;
        };
        let before = meetings.meeting & meetings.t.simd_lt(f32x8::splat(t_max));
        let mut lanes = before.to_bitmask();
        while lanes != 0 {
            if stops(self.primitives[lanes.trailing_zeros() as usize & (LANES - 1)]) {
                return true;
            }
            lanes &= lanes - 1;
        }
        false
    }
}

/// Eight rays and one triangle after the other.
impl Block {
    #[inline(always)]
    fn meet_packet(&self, lane: usize, rays: &RayPacket<'_>, t_max: f32x8) -> Option<Meetings> {
        let [kx, ky, kz] = rays.k;
        let (kx, ky, kz) = (kx.min(2), ky.min(2), kz.min(2));
        let k = [kx, ky, kz];
        let corner = |block: &Self, i: usize, j: usize| {
            f32x8::splat(block.corners[i][k[j]].as_array()[lane])
        };
        tested_rays::meet(self, corner, &rays.tested, t_max)
    }

    /// Updates `nearest` with the nearest triangles that the rays hit; this is block number `index`.
    #[inline(always)]
    pub(super) fn intersect_packet(
        &self,
        index: usize,
        rays: &RayPacket<'_>,
        nearest: &mut PacketHits,
    ) {
        for lane in 0..LANES {
            let primitive = self.primitives[lane];
            if primitive == u32::MAX {
                break;
            }
            let Some(meetings) = self.meet_packet(lane, rays, nearest.t) else {
                continue;
            };
            nearest.take(&meetings, primitive, (index * LANES + lane) as u32);
        }
    }

    /// Sets `t_max` to −1 for the rays that hit any triangle before it.
    #[inline(always)]
    pub(super) fn occlude_packet(&self, rays: &RayPacket<'_>, t_max: &mut f32x8) {
        for lane in 0..LANES {
            if self.primitives[lane] == u32::MAX {
                break;
            }
            if let Some(meetings) = self.meet_packet(lane, rays, *t_max) {
                let hit = meetings.meeting & meetings.t.simd_lt(*t_max);
                *t_max = hit.select(f32x8::splat(-1.0), *t_max);
            }
        }
    }
}
