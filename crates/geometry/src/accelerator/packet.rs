//! Eight rays that go through a tree together, and what each has hit so far.

use super::block::LANES;
use super::tested_rays::{Meetings, TestedRays};
use crate::closest_hit::ClosestHit;
use crate::traversal_ray::{self, FARTHEST, FINITE, TraversalRay};
use etalon_transport::Ray;
use wide::{f32x8, u32x8};

/// Up to eight rays, whose directions are largest along the same axis, with what [`TraversalRay`] knows of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayPacket<'a> {
    rays: [&'a Ray; LANES],
    /// See [`TraversalRay::k`].
    pub(super) k: [usize; 3],
    pub(super) tested: TestedRays,
    pub(super) inverse: [f32x8; 3],
    /// (o + e)/d for the lower planes of boxes and (o − e)/d for the upper ones, per axis.
    pub(super) scaled: [[f32x8; 2]; 3],
    /// Where the rays end; below 0 for lanes that are not used.
    pub(crate) t_max: f32x8,
    /// The lanes that are used: bit i for lane i.
    pub(crate) lanes: u32,
}

impl<'a> RayPacket<'a> {
    /// Prepares the first `count` of these rays, which have `axis` as [`traversal_ray::largest_axis`], for geometry whose
    /// coordinates are all at most `extent` in magnitude. Rays that are too far away to meet it, or are no numbers, have
    /// no lane.
    #[inline(always)]
    pub(crate) fn new(rays: [&'a Ray; LANES], count: usize, axis: usize, extent: f32) -> Self {
        // Eight numbers that lie side by side.
        let row = |lane: usize| {
            let ray: &Ray = rays[lane];
            let (o, d) = (ray.origin, ray.direction);
            f32x8::new([o.x, o.y, o.z, d.x, d.y, d.z, ray.t_max, ray.time])
        };
        let rows = [
            row(0),
            row(1),
            row(2),
            row(3),
            row(4),
            row(5),
            row(6),
            row(7),
        ];
        let [ox, oy, oz, dx, dy, dz, t_max, _] = f32x8::transpose(rows);
        let (o, d) = ([ox, oy, oz], [dx, dy, dz]);
        let k = traversal_ray::axes(axis);
        let [x, y, z] = k;
        let splat = f32x8::splat;
        let farthest = ox.abs().fast_max(oy.abs()).fast_max(oz.abs());
        let reach = splat(extent) + farthest;
        // The same as in `TraversalRay::new`.
        let pad = splat(4.0 * f32::EPSILON) * reach + splat(f32::MIN_POSITIVE);
        let largest = (splat(FINITE) / reach).fast_min(splat(FINITE));
        let inverse = |d: f32x8| (f32x8::ONE / d).fast_max(-largest).fast_min(largest);
        let inverse = [inverse(dx), inverse(dy), inverse(dz)];
        let scaled = |i: usize| [(o[i] + pad) * inverse[i], (o[i] - pad) * inverse[i]];
        // False for NaN.
        let size = dx.abs() + dy.abs() + dz.abs();
        let usable = reach.simd_lt(splat(FARTHEST))
            & size.simd_lt(splat(f32::INFINITY))
            & t_max.simd_ge(f32x8::ZERO);
        let lanes = usable.to_bitmask() & ((1 << count) - 1);
        let used = u32x8::splat(lanes) & u32x8::new([1, 2, 4, 8, 16, 32, 64, 128]);
        let unused = f32x8::from_bits(used.simd_eq(u32x8::ZERO));
        Self {
            rays,
            k,
            tested: TestedRays {
                permuted: [o[x], o[y], o[z]],
                shear: [d[x] / d[z], d[y] / d[z], f32x8::ONE / d[z]],
                near: splat(256.0 * f32::EPSILON) * farthest / d[z].abs(),
            },
            inverse,
            scaled: [scaled(0), scaled(1), scaled(2)],
            t_max: unused.select(splat(-1.0), t_max),
            lanes,
        }
    }

    /// The ray of a lane.
    #[inline(always)]
    pub(super) fn ray(&self, lane: usize) -> TraversalRay {
        let of = |x: &[f32x8; 3]| {
            [
                x[0].as_array()[lane],
                x[1].as_array()[lane],
                x[2].as_array()[lane],
            ]
        };
        let inverse = of(&self.inverse);
        let sign = |axis: usize| (inverse[axis].to_bits() >> 31) as usize;
        let sign = [sign(0), sign(1), sign(2)];
        let scaled = |axis: usize, upper: usize| self.scaled[axis][upper & 1].as_array()[lane];
        let ray: &Ray = self.rays[lane];
        TraversalRay {
            origin: ray.origin,
            direction: ray.direction,
            k: self.k,
            permuted: of(&self.tested.permuted),
            shear: of(&self.tested.shear),
            near: self.tested.near.as_array()[lane],
            sign,
            inverse,
            entered: [scaled(0, sign[0]), scaled(1, sign[1]), scaled(2, sign[2])],
            left: [
                scaled(0, sign[0] ^ 1),
                scaled(1, sign[1] ^ 1),
                scaled(2, sign[2] ^ 1),
            ],
            departure: ray.departure,
            time: ray.time,
        }
    }
}

/// The nearest hits of a packet so far, with the order of [`ClosestHit`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct PacketHits {
    /// As in [`ClosestHit`].
    pub(crate) t: f32x8,
    primitive: u32x8,
    slot: u32x8,
    parameters: [f32x8; 2],
    inner: [u32; LANES],
    path: [u32; LANES],
    exact: [f64; LANES],
    /// The lanes of hits for which `exact` holds; it is NaN for the others.
    smooth: u32,
}

/// In place of a slot where nothing was hit.
const NOT_FOUND: u32 = u32::MAX;

impl PacketHits {
    /// Nothing yet, and nothing at or beyond `t_max` will count.
    #[inline(always)]
    pub(crate) fn within(t_max: f32x8) -> Self {
        Self {
            t: t_max,
            primitive: u32x8::ZERO,
            slot: u32x8::splat(NOT_FOUND),
            parameters: [f32x8::ZERO; 2],
            inner: [0; LANES],
            path: [0; LANES],
            exact: [f64::NAN; LANES],
            smooth: 0,
        }
    }

    /// Notes those hits of the triangle in `slot` that win.
    #[inline(always)]
    pub(super) fn take(&mut self, meetings: &Meetings, primitive: u32, slot: u32) {
        let precedes = u32x8::splat(primitive).simd_lt(self.primitive);
        let tie = meetings.t.simd_eq(self.t) & f32x8::from_bits(precedes);
        let wins = meetings.meeting & (meetings.t.simd_lt(self.t) | tie);
        if !wins.any() {
            return;
        }
        let [u, v] = meetings.parameters();
        self.t = wins.select(meetings.t, self.t);
        self.parameters = [
            wins.select(u, self.parameters[0]),
            wins.select(v, self.parameters[1]),
        ];
        self.smooth &= !wins.to_bitmask();
        let wins = wins.to_bits();
        self.primitive = wins.select(u32x8::splat(primitive), self.primitive);
        self.slot = wins.select(u32x8::splat(slot), self.slot);
    }

    /// The nearest hit of a lane.
    #[inline(always)]
    pub(crate) fn of(&self, lane: usize) -> ClosestHit {
        let slot = self.slot.as_array()[lane];
        let [u, v] = &self.parameters;
        ClosestHit {
            t: self.t.as_array()[lane],
            exact: match self.smooth >> lane & 1 {
                0 => f64::NAN,
                _ => self.exact[lane],
            },
            primitive: self.primitive.as_array()[lane],
            // Of no consequence for a triangle of this accelerator.
            inner: self.inner[lane],
            path: self.path[lane],
            slot,
            parameters: [u.as_array()[lane], v.as_array()[lane]].into(),
            found: slot != NOT_FOUND,
        }
    }

    /// Notes what the ray of a lane found by itself.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, hit: &ClosestHit) {
        self.t.as_mut_array()[lane] = hit.t;
        self.primitive.as_mut_array()[lane] = hit.primitive;
        self.slot.as_mut_array()[lane] = hit.slot;
        let [u, v] = &mut self.parameters;
        u.as_mut_array()[lane] = hit.parameters.x;
        v.as_mut_array()[lane] = hit.parameters.y;
        self.inner[lane] = hit.inner;
        self.path[lane] = hit.path;
        self.exact[lane] = hit.exact;
        self.smooth |= 1 << lane;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traversal_ray::largest_axis;
    use glam::Vec3;

    /// Everything that a ray is tested with, in integers.
    fn bits(ray: &TraversalRay) -> ([usize; 6], Vec<u32>) {
        let [x, y, z] = ray.k;
        let [a, b, c] = ray.sign;
        let numbers = [ray.permuted, ray.shear, ray.inverse, ray.entered, ray.left];
        let bits = numbers.as_flattened().iter().map(|x| x.to_bits());
        (
            [x, y, z, a, b, c],
            bits.chain([ray.near.to_bits()]).collect(),
        )
    }

    #[test]
    fn a_lane_is_the_ray_by_itself() {
        let odd = [0.0, -0.0, 1.0, -2.5, 1e-40, -1e-30, 3e5, 1e20];
        let mut rays = [const { Vec::new() }; 3];
        for (i, x) in odd.into_iter().enumerate() {
            for (j, y) in odd.into_iter().enumerate() {
                for (k, z) in odd.into_iter().enumerate() {
                    let direction = Vec3::new(x, y, z);
                    if direction == Vec3::ZERO {
                        continue;
                    }
                    let origin = Vec3::new(odd[j], odd[k], odd[i]);
                    let ray = Ray::new(origin, direction, 0.5);
                    rays[largest_axis(direction)].push(ray);
                }
            }
        }
        for (axis, rays) in rays.iter().enumerate() {
            for some in rays.chunks(LANES) {
                let eight = core::array::from_fn(|i| some.get(i).unwrap_or(&some[0]));
                let packet = RayPacket::new(eight, some.len(), axis, 7.0);
                assert_eq!(packet.lanes, (1 << some.len()) - 1);
                for (lane, ray) in some.iter().enumerate() {
                    let alone = TraversalRay::new(ray.origin, ray.direction, 7.0);
                    assert_eq!(bits(&packet.ray(lane)), bits(&alone), "{ray:?}");
                }
            }
        }
    }

    #[test]
    fn rays_that_meet_nothing_have_no_lane() {
        let good = Ray::new(Vec3::ONE, Vec3::X, 0.0);
        let far = Ray::new(Vec3::splat(1e30), Vec3::X, 0.0);
        let nowhere = Ray::new(Vec3::ONE, Vec3::new(f32::NAN, 0.0, 0.0), 0.0);
        let endless = Ray::new(Vec3::ONE, Vec3::new(f32::INFINITY, 0.0, 0.0), 0.0);
        let backward = Ray {
            t_max: -1.0,
            ..good
        };
        let eight = [
            &good, &far, &nowhere, &good, &endless, &backward, &good, &good,
        ];
        assert_eq!(RayPacket::new(eight, 7, 0, 1.0).lanes, 0b100_1001);
    }
}
