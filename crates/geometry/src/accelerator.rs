//! Accelerators: which primitives may a ray hit?
//!
//! An accelerator knows triangles, which it intersects itself in `Block`s of eight, and
//! *others*: anything with a box and a primitive number, for which it calls back. It returns the
//! nearest hit by the total order of `ClosestHit`, so every accelerator gives the same bits.

mod binary;
pub(crate) mod block;
mod box_tree;
mod bunch;
mod bvh;
mod choices;
mod linear;
mod node;
pub(crate) mod observer;
mod octree;
mod pack;
pub(crate) mod packet;
mod tested_rays;
pub(crate) mod wide;
pub(crate) mod wide_packet;

use crate::closest_hit::ClosestHit;
use crate::traversal_ray::TraversalRay;
use block::Block;
use box_tree::BoxTree;
use glam::Vec3;
use linear::Linear;
use observer::Observer;
use wide::Wide;

/// The kind of accelerator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AcceleratorKind {
    /// Every ray is tested against everything: slow, and obviously right.
    Linear,
    /// A cube, divided into eight again and again.
    Octree,
    /// A binary tree of boxes, divided at the mean of the widest axis.
    BvhMean,
    /// A binary tree of boxes, divided by the surface area heuristic.
    Bvh,
    /// A bounding volume hierarchy with eight children per node.
    #[default]
    Wide,
}

impl AcceleratorKind {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Linear,
        Self::Octree,
        Self::BvhMean,
        Self::Bvh,
        Self::Wide,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Octree => "octree",
            Self::BvhMean => "bvh-mean",
            Self::Bvh => "bvh",
            Self::Wide => "wide",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// An axis-parallel box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub min: Vec3,
    /// Upper corner.
    pub max: Vec3,
}

impl Bounds {
    /// The box around nothing.
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// All of space.
    pub const ENDLESS: Self = Self {
        min: Vec3::NEG_INFINITY,
        max: Vec3::INFINITY,
    };

    /// The smallest box around points.
    #[inline]
    pub fn around(points: &[Vec3]) -> Self {
        points.iter().fold(Self::EMPTY, |b, &p| Self {
            min: b.min.min(p),
            max: b.max.max(p),
        })
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether there is nothing in it.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !(self.min.cmple(self.max).all())
    }

    /// Whether there is something in it, without end.
    #[inline]
    pub fn is_endless(&self) -> bool {
        !self.is_empty() && !(self.max - self.min).is_finite()
    }

    /// Half of its surface; 0 for the empty box.
    #[inline]
    pub(crate) fn half_area(&self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let d = self.max - self.min;
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The point in the middle; the origin for the empty box.
    pub fn center(&self) -> Vec3 {
        if self.is_empty() {
            Vec3::ZERO
        } else {
            (self.min.as_dvec3() * 0.5 + self.max.as_dvec3() * 0.5).as_vec3()
        }
    }

    /// The largest magnitude of a coordinate; 0 for the empty box.
    pub fn extent(&self) -> f32 {
        if self.is_empty() {
            0.0
        } else {
            self.min.abs().max(self.max.abs()).max_element()
        }
    }
}

/// The input of an accelerator: primitives numbered from 0, triangles and others.
pub(crate) trait Primitives: Sync {
    /// Number of primitives.
    fn len(&self) -> usize;
    /// The corners of a triangle; `None` for anything else.
    fn triangle(&self, primitive: u32) -> Option<[Vec3; 3]>;
    /// Whether a primitive is a triangle.
    fn is_triangle(&self, primitive: u32) -> bool;
    /// The box of a primitive that is not a triangle.
    fn bounds(&self, primitive: u32) -> Bounds;
    /// Whether any box has no end.
    fn any_endless(&self) -> bool {
        false
    }
}

/// Intersection of primitives that are not triangles, for accelerators.
pub(crate) trait CustomPrimitives {
    /// Updates `nearest` with the nearest hit of `primitive`.
    fn intersect(&self, primitive: u32, probe: &TraversalRay, nearest: &mut ClosestHit);
    /// Whether the ray hits `primitive` before `t_max`.
    fn occludes(&self, primitive: u32, probe: &TraversalRay, t_max: f32) -> bool;
    /// Whether a search for anything ends at a triangle.
    fn stops(&self, primitive: u32) -> bool;
    /// Who watches the search.
    fn observer(&self) -> &impl Observer;
}

/// Whether a triangle has any area. One without is not part of any surface: rounding alone would
/// decide whether a ray hits it.
#[inline]
pub(crate) fn has_area(corners: &[Vec3; 3]) -> bool {
    let [a, b, c] = corners;
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (b - a).cross(c - a).length_squared() > 0.0
}

/// An accelerator.
#[derive(Debug)]
pub(crate) struct Accelerator {
    index: Index,
    /// Unbounded primitives, which have no place in a tree: every ray is tested against them.
    endless: Vec<u32>,
}

/// The tree or list of an accelerator.
#[derive(Debug)]
enum Index {
    Linear(Linear),
    Boxes(BoxTree),
    Wide(Wide),
}

impl Accelerator {
    /// Builds an accelerator over all primitives but triangles without area.
    pub(crate) fn build(kind: AcceleratorKind, primitives: &impl Primitives) -> Self {
        let is_endless = |&primitive: &u32| {
            !primitives.is_triangle(primitive) && primitives.bounds(primitive).is_endless()
        };
        Self {
            index: match kind {
                AcceleratorKind::Linear => Index::Linear(Linear::build(primitives)),
                AcceleratorKind::Octree => Index::Boxes(octree::build(primitives)),
                AcceleratorKind::BvhMean => Index::Boxes(bvh::by_mean(primitives)),
                AcceleratorKind::Bvh => Index::Boxes(bvh::by_area(primitives)),
                AcceleratorKind::Wide => Index::Wide(Wide::build(primitives)),
            },
            endless: match primitives.any_endless() {
                true => (0..primitives.len() as u32).filter(is_endless).collect(),
                false => Vec::new(),
            },
        }
    }

    /// Updates the nearest hit.
    #[inline(always)]
    pub(crate) fn intersect(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        nearest: &mut ClosestHit,
    ) {
        for &primitive in &self.endless {
            others.observer().primitives(|| 1);
            others.intersect(primitive, probe, nearest);
        }
        match &self.index {
            Index::Linear(linear) => linear.intersect(probe, others, nearest),
            Index::Boxes(boxes) => boxes.intersect(probe, others, nearest),
            Index::Wide(wide) => wide.intersect(probe, others, nearest),
        }
    }

    /// Whether anything is hit before `t_max`.
    #[inline(always)]
    pub(crate) fn occluded(
        &self,
        probe: &TraversalRay,
        others: &impl CustomPrimitives,
        t_max: f32,
    ) -> bool {
        let mut endless = self.endless.iter();
        endless.any(|&primitive| {
            others.observer().primitives(|| 1);
            others.occludes(primitive, probe, t_max)
        }) || match &self.index {
            Index::Linear(linear) => linear.occluded(probe, others, t_max),
            Index::Boxes(boxes) => boxes.occluded(probe, others, t_max),
            Index::Wide(wide) => wide.occluded(probe, others, t_max),
        }
    }

    /// The tree, if packets of rays can go through it.
    pub(crate) fn packets(&self) -> Option<&Wide> {
        match &self.index {
            Index::Wide(wide) if self.endless.is_empty() => Some(wide),
            _ => None,
        }
    }

    /// The corners of the triangle that [`Accelerator::intersect`] found in `slot`.
    #[inline]
    pub(crate) fn corners(&self, slot: u32) -> [Vec3; 3] {
        match &self.index {
            Index::Linear(linear) => Block::corners(linear.blocks(), slot),
            Index::Boxes(boxes) => Block::corners(boxes.blocks(), slot),
            Index::Wide(wide) => Block::corners(wide.blocks(), slot),
        }
    }

    /// Number of nodes.
    pub(crate) fn nodes(&self) -> usize {
        match &self.index {
            Index::Linear(_) => 0,
            Index::Boxes(boxes) => boxes.nodes(),
            Index::Wide(wide) => wide.nodes(),
        }
    }

    /// Memory held (bytes).
    pub(crate) fn bytes(&self) -> usize {
        match &self.index {
            Index::Linear(linear) => linear.bytes(),
            Index::Boxes(boxes) => boxes.bytes(),
            Index::Wide(wide) => wide.bytes(),
        }
    }
}

/// Memory of blocks (bytes).
fn block_bytes(blocks: &[Block]) -> usize {
    size_of_val(blocks)
}
