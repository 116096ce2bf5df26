//! No acceleration: every ray is tested against every primitive. The oracle of the others.

use super::block::{Block, LANES};
use super::observer::Observer;
use super::{CustomPrimitives, Primitives, block_bytes, has_area};
use crate::closest_hit::ClosestHit;
use crate::traversal_ray::TraversalRay;

/// All primitives in their order.
#[derive(Debug)]
pub(crate) struct Linear {
    blocks: Vec<Block>,
    others: Vec<u32>,
}

impl Linear {
    pub(crate) fn build(primitives: &impl Primitives) -> Self {
        let mut triangles = Vec::new();
        let mut others = Vec::new();
        for primitive in 0..primitives.len() as u32 {
            match primitives.triangle(primitive) {
                Some(corners) if has_area(&corners) => triangles.push((corners, primitive)),
                Some(_) => {}
                None if primitives.bounds(primitive).is_endless() => {}
                None => others.push(primitive),
            }
        }
        Self {
            blocks: triangles
                .chunks(LANES)
                .map(|chunk| Block::new(chunk.iter().copied()))
                .collect(),
            others,
        }
    }

    #[inline]
    pub(crate) fn intersect(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        for (index, block) in self.blocks.iter().enumerate() {
            others.observer().primitives(|| block.len());
            block.intersect(index, probe, nearest);
        }
        others.observer().primitives(|| self.others.len());
        for &primitive in &self.others {
            others.intersect(primitive, probe, nearest);
        }
    }

    #[inline]
    pub(crate) fn occluded(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        t_max: f32,
    ) -> bool {
        let observer = others.observer();
        let hits_block = |block: &Block| {
            observer.primitives(|| block.len());
            block.occludes(probe, t_max, |primitive| others.stops(primitive))
        };
        let hits_other = |&primitive: &u32| {
            observer.primitives(|| 1);
            others.occludes(primitive, probe, t_max)
        };
        self.blocks.iter().any(hits_block) || self.others.iter().any(hits_other)
    }

    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    pub(crate) fn bytes(&self) -> usize {
        block_bytes(&self.blocks)
    }
}
