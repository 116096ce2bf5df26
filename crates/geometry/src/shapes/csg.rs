//! `union`, `intersection`, `difference`: constructive solid geometry (A. Requicha, Representations for rigid solids,
//! 1980; S. Roth, Ray casting for modeling solids, 1982).
//!
//! A line is inside a closed operand on intervals; whether it is inside the whole follows from the states of the
//! operands. Walking from crossing to crossing of either operand, the whole is crossed where its state changes:
//!
//! ```text
//! union: a ∨ b        intersection: a ∧ b        difference: a ∧ ¬b
//! ```
//!
//! Crossings closer than rounding resolves are passed together, so that coincident faces of touching operands vanish. No
//! state is kept between crossings: whether a point is inside an operand follows from its next crossing, which leaves
//! the operand if so.
//!
//! As a light, points are chosen uniformly over the area ΣA of all operands; one that is not on the boundary of the
//! whole counts as zero, so that the density on the boundary is exactly 1/ΣA.

use crate::local_interaction::LocalInteraction;
use crate::placement::{Placement, perpendicular};
use crate::shapes::Shape;
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::shape_model::ShapeModel;
use etalon_transport::SurfacePoint;
use glam::{DVec3, Vec2};

/// The operation on two solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Points in either.
    Union,
    /// Points in both.
    Intersection,
    /// Points in the first and not in the second.
    Difference,
}

impl Operation {
    /// The operation of a plugin's name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "union" => Some(Self::Union),
            "intersection" => Some(Self::Intersection),
            "difference" => Some(Self::Difference),
            _ => None,
        }
    }

    /// The names of the plugins.
    pub const NAMES: [&str; 3] = ["union", "intersection", "difference"];

    fn of(self, a: bool, b: bool) -> bool {
        match self {
            Self::Union => a || b,
            Self::Intersection => a && b,
            Self::Difference => a && !b,
        }
    }
}

#[derive(Debug)]
enum Part {
    /// A closed shape, and the number of its first face.
    Leaf(Box<Shape>, u32),
    Inner(Operation, Box<[Tree; 2]>),
}

/// Solids combined, in a box.
#[derive(Debug)]
struct Tree {
    part: Part,
    bounds: [DVec3; 2],
}

/// Distances along a line that differ by no more than this are the same.
fn tolerance(line: &Line, t: f64) -> f64 {
    // 2⁻⁴⁰: some ten thousand roundings.
    const RELATIVE: f64 = 1.0 / (1_u64 << 40) as f64;
    (line.origin.abs().max_element() / line.direction.length() + t.abs()) * RELATIVE
}

impl Tree {
    /// All of `parts` under one operation, as a tree that is not deeper than it must be.
    fn balanced(operation: Operation, mut parts: Vec<Self>) -> Option<Self> {
        match parts.len() {
            0 | 1 => parts.pop(),
            count => {
                let right = parts.split_off(count / 2);
                let halves = [parts, right].map(|half| Self::balanced(operation, half));
                let [Some(left), Some(right)] = halves else {
                    return None;
                };
                Some(Self::inner(operation, left, right))
            }
        }
    }

    fn leaf_of(shape: Shape, first_face: u32) -> Self {
        let bounds = shape.bounds();
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let slack = (high - low) * 1e-6;
        Self {
            bounds: [low - slack, high + slack],
            part: Part::Leaf(Box::new(shape), first_face),
        }
    }

    fn inner(operation: Operation, a: Self, b: Self) -> Self {
        let ([low_a, high_a], [low_b, high_b]) = (a.bounds, b.bounds);
        Self {
            bounds: match operation {
                Operation::Union => [low_a.min(low_b), high_a.max(high_b)],
                Operation::Intersection => [low_a.max(low_b), high_a.min(high_b)],
                Operation::Difference => [low_a, high_a],
            },
            part: Part::Inner(operation, Box::new([a, b])),
        }
    }

    /// The first crossing beyond `after`.
    fn next(&self, line: &Line, after: f64) -> Option<Crossing> {
        if line.misses(self.bounds, after) {
            return None;
        }
        match &self.part {
            Part::Leaf(shape, first_face) => {
                let pieces = (0..shape.primitives_analytic())
                    .filter_map(|piece| shape.next_crossing(piece, line, after, f64::INFINITY));
                let crossing = pieces.min_by(|a, b| a.t.total_cmp(&b.t))?;
                Some(Crossing {
                    face: first_face + crossing.face,
                    ..crossing
                })
            }
            Part::Inner(operation, operands) => {
                let mut ahead = [0, 1].map(|i| operands[i].next(line, after));
                let mut inside = ahead.map(|met| met.is_some_and(|met| !met.enters));
                loop {
                    let t = (ahead.iter().flatten())
                        .map(|met| met.t)
                        .min_by(f64::total_cmp)?;
                    let before = operation.of(inside[0], inside[1]);
                    let limit = t + tolerance(line, t);
                    let mut changed: Option<Crossing> = None;
                    for i in 0..2 {
                        let was = inside[i];
                        let mut last = None;
                        while let Some(met) = ahead[i].filter(|met| met.t <= limit) {
                            inside[i] = met.enters;
                            ahead[i] = operands[i].next(line, met.t);
                            last = Some(met);
                        }
                        // Among coincident faces, the first operand's.
                        if inside[i] != was && changed.is_none() {
                            changed = last;
                        }
                    }
                    let state = operation.of(inside[0], inside[1]);
                    if let Some(met) = changed
                        && state != before
                    {
                        return Some(Crossing {
                            carved: met.carved != (met.enters != state),
                            enters: state,
                            ..met
                        });
                    }
                }
            }
        }
    }

    /// The leaf of a face, and the face's number there.
    fn leaf(&self, face: u32) -> Option<(&Shape, u32)> {
        match &self.part {
            Part::Leaf(shape, first) => {
                let own = face.checked_sub(*first)?;
                (own < shape.faces()).then_some((&**shape, own))
            }
            Part::Inner(_, operands) => operands.iter().find_map(|operand| operand.leaf(face)),
        }
    }

    fn leaves(&self) -> Vec<(&Shape, u32)> {
        match &self.part {
            Part::Leaf(shape, first) => vec![(shape, *first)],
            Part::Inner(_, operands) => operands.iter().flat_map(Self::leaves).collect(),
        }
    }
}

/// A solid made of others.
#[derive(Debug)]
pub struct Csg {
    placement: Placement,
    tree: Tree,
    faces: u32,
    inward: bool,
    /// ΣA in the world (m²), where it can be sampled.
    area: Option<f64>,
}

impl Csg {
    /// What `operation` makes of closed shapes, placed by `placement`: a difference is the first without all others.
    /// `None` if there is none.
    pub fn new(
        operation: Operation,
        operands: Vec<Shape>,
        placement: Placement,
        flip: bool,
    ) -> Option<Self> {
        let mut faces = 0;
        let mut leaves: Vec<Tree> = operands
            .into_iter()
            .map(|shape| {
                let first = faces;
                faces += shape.faces();
                Tree::leaf_of(shape, first)
            })
            .collect();
        let tree = match operation {
            Operation::Difference if leaves.len() > 1 => {
                let others = leaves.split_off(1);
                let others = Tree::balanced(Operation::Union, others)?;
                Tree::inner(operation, leaves.pop()?, others)
            }
            _ => Tree::balanced(operation, leaves)?,
        };
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| placement.vector(axis));
        let similar =
            perpendicular(x, y, true) && perpendicular(y, z, true) && perpendicular(z, x, true);
        let areas = tree
            .leaves()
            .into_iter()
            .map(|(shape, _)| shape.can_emit().then(|| shape.area()));
        let sum = areas.sum::<Option<f64>>().filter(|_| similar);
        Some(Self {
            area: sum.map(|area| area * x.length_squared()),
            placement,
            tree,
            faces,
            inward: flip,
        })
    }

    /// The surface at a crossing of the tree, in whose space `p` is.
    fn surface(&self, p: DVec3, crossing: &Crossing) -> Option<LocalInteraction> {
        let (shape, own_face) = self.tree.leaf(crossing.face)?;
        let own = Crossing {
            face: own_face,
            ..*crossing
        };
        // A solid that is made of others turns what was carved out itself.
        let turned = crossing.carved && !matches!(shape, Shape::Csg(_));
        let point = LocalInteraction {
            face: crossing.face,
            ..shape.surface_at(0, p, &own)?
        };
        Some(
            point
                .flipped_if(turned)
                .placed_if(&self.placement)
                .flipped_if(self.inward),
        )
    }
}

impl ShapeModel for Csg {
    fn next_crossing(&self, _: u32, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let own = Line {
            origin: self.placement.local_point(line.origin),
            direction: self.placement.local_vector(line.direction),
        };
        self.tree.next(&own, after)
    }

    fn surface_at(&self, _: u32, p: DVec3, crossing: &Crossing) -> Option<LocalInteraction> {
        self.surface(self.placement.local_point(p), crossing)
    }

    fn piece_bounds(&self, _: u32) -> [DVec3; 2] {
        self.placement.bounds(self.tree.bounds)
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn is_convex(&self) -> bool {
        false
    }

    fn faces(&self) -> u32 {
        self.faces
    }

    fn area(&self) -> Option<f64> {
        self.area
    }

    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint> {
        let leaves = self.tree.leaves();
        let total: f64 = leaves.iter().map(|(shape, _)| shape.area()).sum();
        let mut rest = f64::from(u.x) * total;
        let mut chosen = *leaves.last()?;
        for (shape, first) in leaves {
            if rest < shape.area() {
                chosen = (shape, first);
                break;
            }
            rest -= shape.area();
        }
        let (shape, first) = chosen;
        let x = ((rest / shape.area()) as f32).min(etalon_math::float::ONE_MINUS_EPSILON);
        let sampled = shape.sample_area(Vec2::new(x, u.y)).point;
        // Whether the whole is crossed there, along the normal, by the chosen operand.
        let line = Line {
            origin: sampled.position.as_dvec3(),
            direction: sampled.normal.as_dvec3(),
        };
        let extent = f64::from(shape.bounds().extent());
        let reach = 1e-5 * (line.origin.abs().max_element() + extent);
        let met = self.tree.next(&line, -reach)?;
        let own = met.face.checked_sub(first)?;
        if own >= shape.faces() || met.t > reach {
            return None;
        }
        Some(self.surface(line.at(met.t), &met)?.whole())
    }
}
