//! A density on the unit square that is constant in each leaf of an adaptive quadtree
//! (Müller, Gross & Novák 2017, "Practical Path Guiding", §3.2).
//!
//! ```text
//! p(x) = Π 4·sᵢ        over the nodes i from the root to the leaf of x
//! ```
//!
//! with sᵢ the share of its quadrant in the mass of node i. The mass of every leaf is summed outside
//! (by any number of threads, see [`Quadtree::spread`]); then [`Quadtree::learned`] divides the leaves
//! of large mass and merges those of small mass.

use etalon_math::float::ONE_MINUS_EPSILON;
use glam::Vec2;

/// A piecewise constant density on [0, 1)².
#[derive(Clone, Debug, PartialEq)]
pub struct Quadtree {
    nodes: Vec<Node>,
}

/// A square of four quadrants: lower left, lower right, upper left, upper right.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    /// The quadrants' shares of the node's mass.
    share: [f32; 4],
    /// Indices of the quadrants' nodes; [`LEAF`] if a quadrant is not divided.
    child: [u32; 4],
}

/// Marks a leaf instead of a child's index; the root is never a child.
const LEAF: u32 = 0;

/// The rule of refinement of [`Quadtree::learned`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Squares with more than this share of all mass are divided.
    pub share: f64,
    /// The smallest squares have sides of 2 to the minus this; at least 1.
    pub depth: u32,
}

impl Default for Quadtree {
    fn default() -> Self {
        Self::uniform()
    }
}

/// The quadrant of a square in which `at` lies; `at` becomes the place in it.
#[inline]
fn enter(at: &mut Vec2) -> usize {
    let (right, upper) = (at.x >= 0.5, at.y >= 0.5);
    // Exact: doubling, and Sterbenz's lemma.
    at.x = 2.0 * at.x - f32::from(u8::from(right));
    at.y = 2.0 * at.y - f32::from(u8::from(upper));
    usize::from(right) + 2 * usize::from(upper)
}

impl Quadtree {
    /// The uniform density, in four leaves.
    pub fn uniform() -> Self {
        let root = Node {
            share: [0.25; 4],
            child: [LEAF; 4],
        };
        Self { nodes: vec![root] }
    }

    /// Number of slots, the indices of leaves; some are unused.
    #[inline]
    pub fn slots(&self) -> usize {
        4 * self.nodes.len()
    }

    /// The density at a point of [0, 1)², per unit of area.
    #[inline]
    pub fn density(&self, at: Vec2) -> f32 {
        let (mut at, mut node, mut density) = (at, &self.nodes[0], 1.0);
        loop {
            let quadrant = enter(&mut at);
            density *= 4.0 * node.share[quadrant];
            match node.child[quadrant] {
                LEAF => return density,
                child => node = &self.nodes[child as usize],
            }
        }
    }

    /// A point with this density, and the density there, which is positive.
    #[inline]
    pub fn sample(&self, u: Vec2) -> (Vec2, f32) {
        let (mut u, mut node, mut density) = (u, &self.nodes[0], 1.0);
        let (mut corner, mut side) = (Vec2::ZERO, 1.0);
        loop {
            let [a, b, c, d] = node.share;
            let upper = choose(&mut u.y, a + b, c + d);
            let (left, right) = if upper { (c, d) } else { (a, b) };
            let to_the_right = choose(&mut u.x, left, right);
            let quadrant = usize::from(to_the_right) + 2 * usize::from(upper);
            density *= 4.0 * node.share[quadrant];
            side *= 0.5;
            corner.x += side * f32::from(u8::from(to_the_right));
            corner.y += side * f32::from(u8::from(upper));
            match node.child[quadrant] {
                // Rounding up must not leave the leaf.
                LEAF => {
                    let inside =
                        |corner: f32, u: f32| (corner + side * u).min((corner + side).next_down());
                    return (
                        Vec2::new(inside(corner.x, u.x), inside(corner.y, u.y)),
                        density,
                    );
                }
                child => node = &self.nodes[child as usize],
            }
        }
    }

    /// The side of the leaf in which `at` lies.
    #[inline]
    fn side(&self, at: Vec2) -> f32 {
        let (mut at, mut node, mut side) = (at, &self.nodes[0], 0.5);
        loop {
            match node.child[enter(&mut at)] {
                LEAF => return side,
                child => node = &self.nodes[child as usize],
            }
            side *= 0.5;
        }
    }

    /// Spreads a unit of mass evenly over a square around `at`, as large as the leaf there, but within
    /// the unit square (Müller 2019, "Practical Path Guiding in Production", §10.5.1): `add` is
    /// called with the slots of the leaves that it touches, and what each gets.
    #[inline]
    pub fn spread(&self, at: Vec2, mut add: impl FnMut(usize, f32)) {
        let half = 0.5 * self.side(at);
        let from = (at - half).max(Vec2::ZERO);
        let to = (at + half).min(Vec2::ONE);
        let area = (to - from).element_product();
        self.spread_in(0, Vec2::ZERO, 0.5, (from, to), &mut |slot, part: f32| {
            add(slot, part / area);
        });
    }

    fn spread_in(
        &self,
        node: usize,
        corner: Vec2,
        side: f32,
        (from, to): (Vec2, Vec2),
        add: &mut impl FnMut(usize, f32),
    ) {
        for quadrant in 0..4 {
            let offset = Vec2::new((quadrant % 2) as f32, (quadrant / 2) as f32);
            let corner = corner + side * offset;
            let overlap = to.min(corner + side) - from.max(corner);
            if overlap.min_element() > 0.0 {
                match self.nodes[node].child[quadrant] {
                    LEAF => add(4 * node + quadrant, overlap.element_product()),
                    child => self.spread_in(child as usize, corner, 0.5 * side, (from, to), add),
                }
            }
        }
    }

    /// The density proportional to the mass of each leaf, given by slot; large masses are divided as
    /// `refinement` says, small ones merged. `None` if there is no mass at all.
    pub fn learned(&self, mass: impl Fn(usize) -> f64, refinement: Refinement) -> Option<Self> {
        let mut sums = vec![[0.0; 4]; self.nodes.len()];
        // Children stand behind their parents.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            sums[index] = core::array::from_fn(|quadrant| match node.child[quadrant] {
                LEAF => mass(4 * index + quadrant),
                child => sums[child as usize].iter().sum(),
            });
        }
        let total: f64 = sums[0].iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let mut learned = Self { nodes: Vec::new() };
        let large = Refinement {
            share: refinement.share * total,
            ..refinement
        };
        self.divide(Some(0), total, &sums, large, &mut learned);
        Some(learned)
    }

    /// Adds a node of the given mass with its descendants, modelled on the old node if there was one.
    fn divide(
        &self,
        old: Option<usize>,
        mass: f64,
        sums: &[[f64; 4]],
        large: Refinement,
        learned: &mut Self,
    ) -> u32 {
        let masses = old.map_or([0.25 * mass; 4], |old| sums[old]);
        let index = learned.nodes.len();
        learned.nodes.push(Node {
            share: masses.map(|quadrant| (quadrant / mass) as f32),
            child: [LEAF; 4],
        });
        for (quadrant, &mass) in masses.iter().enumerate() {
            if large.depth > 1 && mass > large.share {
                let child = old.map_or(LEAF, |old| self.nodes[old].child[quadrant]);
                let child = (child != LEAF).then_some(child as usize);
                let deeper = Refinement {
                    depth: large.depth - 1,
                    ..large
                };
                learned.nodes[index].child[quadrant] =
                    self.divide(child, mass, sums, deeper, learned);
            }
        }
        index as u32
    }
}

/// Chooses between two masses by `u`, which it rescales for reuse: `true` for the second. A zero mass is never
/// chosen.
#[inline]
fn choose(u: &mut f32, first: f32, second: f32) -> bool {
    let first = first / (first + second);
    let chosen = second > 0.0 && *u >= first;
    *u = if chosen {
        (*u - first) / (1.0 - first)
    } else {
        *u / first
    }
    .min(ONE_MINUS_EPSILON);
    chosen
}
