//! Packets of eight rays through the wide tree.
//!
//! All rays visit a node, or a block of triangles, if enough of them enter its box; eight boxes or triangles are tested one
//! after the other. Where fewer are left, these go on one by one: that takes one test for eight boxes or triangles.

use super::CustomPrimitives;
use super::block::LANES;
use super::node::{Link, Target};
use super::packet::{PacketHits, RayPacket};
use super::wide::{MAX_DEPTH, Wide, stack_for, with_stack};
use wide::f32x8;

/// Fewer rays are no packet.
pub(crate) const FEWEST: usize = 3;

/// With fewer rays of a packet, it takes more time than these one by one: measured in boxes around meshes.
#[inline(always)]
fn fewest(link: Link) -> u32 {
    match link.target() {
        Target::Node(_) => 5,
        Target::Block(_) => 3,
        Target::Other(_) => u32::MAX,
    }
}

/// The lanes of a mask.
#[inline(always)]
fn each_lane(mut lanes: u32, mut visit: impl FnMut(usize)) {
    while lanes != 0 {
        visit(lanes.trailing_zeros() as usize & (LANES - 1));
        lanes &= lanes - 1;
    }
}

impl Wide {
    /// Updates the nearest hits.
    #[inline]
    pub(crate) fn intersect_packet(
        &self,
        rays: &RayPacket<'_>,
        others: &impl CustomPrimitives,
        nearest: &mut PacketHits,
    ) {
        with_stack!(self.find_nearest_of_packet(rays, others, nearest));
    }

    /// The lanes of the rays that hit anything.
    #[inline]
    pub(crate) fn occluded_packet(
        &self,
        rays: &RayPacket<'_>,
        others: &impl CustomPrimitives,
    ) -> u32 {
        with_stack!(self.find_any_of_packet(rays, others))
    }

    fn find_nearest_of_packet<const STACK: usize>(
        &self,
        rays: &RayPacket<'_>,
        others: &impl CustomPrimitives,
        nearest: &mut PacketHits,
    ) {
        let Some(root) = self.0.root else { return };
        // For each entry where the rays enter it, NaN for those that do not; and, in one number, the least of these and
        // the link, as in the search for one ray.
        let mut entered = [f32x8::ZERO; STACK];
        let mut stack = [0u64; STACK];
        let mut top = 0;
        let (mut link, mut lanes) = (root, rays.lanes);
        loop {
            if lanes.count_ones() < fewest(link) {
                self.nearest_one_by_one::<STACK>((link, lanes), rays, others, nearest);
            } else {
                match link.target() {
                    Target::Node(index) => {
                        let node = &self.0.nodes[index];
                        let base = top;
                        for child in 0..node.children() {
                            let (near, inside) = node.entered_by(child, rays, nearest.t);
                            if !inside.any() {
                                continue;
                            }
                            let near_or_never = inside.select(near, f32x8::splat(f32::INFINITY));
                            let least = |a: f32, b: &f32| if *b < a { *b } else { a };
                            let first = near_or_never.as_array().iter().fold(f32::INFINITY, least);
                            let entry =
                                u64::from(first.to_bits()) << 32 | u64::from(node.link(child).0);
                            let mut slot = top;
                            while slot > base && stack[slot - 1] < entry {
                                stack[slot] = stack[slot - 1];
                                entered[slot] = entered[slot - 1];
                                slot -= 1;
                            }
                            stack[slot] = entry;
                            entered[slot] = near | !inside;
                            top += 1;
                        }
                    }
                    Target::Block(index) => {
                        self.0.blocks[index].intersect_packet(index, rays, nearest);
                    }
                    Target::Other(_) => unreachable!("others are intersected one by one"),
                }
            }
            loop {
                if top == 0 {
                    return;
                }
                top -= 1;
                lanes = entered[top].simd_le(nearest.t).to_bitmask();
                if lanes != 0 {
                    link = Link(stack[top] as u32);
                    break;
                }
            }
        }
    }

    /// Takes some rays of a packet through what is below a link.
    #[inline(never)]
    fn nearest_one_by_one<const STACK: usize>(
        &self,
        (link, lanes): (Link, u32),
        rays: &RayPacket<'_>,
        others: &impl CustomPrimitives,
        nearest: &mut PacketHits,
    ) {
        each_lane(lanes, |lane| {
            let mut hit = nearest.of(lane);
            match link.target() {
                Target::Node(_) => {
                    self.find_nearest_below::<STACK>(link, &rays.ray(lane), others, &mut hit);
                }
                Target::Block(index) => {
                    let ray = (rays.k, &rays.tested.spread(lane));
                    self.0.blocks[index].intersect_tested(index, ray, &mut hit);
                }
                Target::Other(primitive) => others.intersect(primitive, &rays.ray(lane), &mut hit),
            }
            if hit.found {
                nearest.set(lane, &hit);
            }
        });
    }

    fn find_any_of_packet<const STACK: usize>(
        &self,
        rays: &RayPacket<'_>,
        others: &impl CustomPrimitives,
    ) -> u32 {
        let Some(root) = self.0.root else { return 0 };
        // Below 0 for rays that have hit something.
        let mut t_max = rays.t_max;
        let mut entered = [f32x8::ZERO; STACK];
        let mut stack = [root; STACK];
        let mut top = 0;
        let (mut link, mut lanes) = (root, rays.lanes);
        loop {
            if lanes.count_ones() < fewest(link) {
                self.any_one_by_one::<STACK>((link, lanes), rays, others, &mut t_max);
            } else {
                match link.target() {
                    Target::Node(index) => {
                        let node = &self.0.nodes[index];
                        // The largest box (the first one) is looked into first.
                        for child in (0..node.children()).rev() {
                            let (near, inside) = node.entered_by(child, rays, t_max);
                            if inside.any() {
                                entered[top] = near | !inside;
                                stack[top] = node.link(child);
                                top += 1;
                            }
                        }
                    }
                    Target::Block(index) => self.0.blocks[index].occlude_packet(rays, &mut t_max),
                    Target::Other(_) => unreachable!("others are intersected one by one"),
                }
            }
            loop {
                if top == 0 {
                    return t_max.simd_lt(f32x8::ZERO).to_bitmask() & rays.lanes;
                }
                top -= 1;
                lanes = entered[top].simd_le(t_max).to_bitmask();
                if lanes != 0 {
                    link = stack[top];
                    break;
                }
            }
        }
    }

    /// Looks for anything that some rays of a packet hit below a link.
    #[inline(never)]
    fn any_one_by_one<const STACK: usize>(
        &self,
        (link, lanes): (Link, u32),
        rays: &RayPacket<'_>,
        others: &impl CustomPrimitives,
        t_max: &mut f32x8,
    ) {
        each_lane(lanes, |lane| {
            let end = t_max.as_array()[lane];
            let is_hit = match link.target() {
                Target::Node(_) => self.find_any_below::<STACK>(link, &rays.ray(lane), others, end),
                Target::Block(index) => {
                    let ray = (rays.k, &rays.tested.spread(lane));
                    self.0.blocks[index]
                        .occludes_tested(ray, end, |primitive| others.stops(primitive))
                }
                Target::Other(primitive) => others.occludes(primitive, &rays.ray(lane), end),
            };
            if is_hit {
                t_max.as_mut_array()[lane] = -1.0;
            }
        });
    }
}
