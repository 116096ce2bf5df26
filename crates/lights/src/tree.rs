//! A tree over the lights at finite positions, for selection by importance.
//!
//! From the root down, one of two children is taken with a probability proportional to its importance at
//! the receiver ([`LightBounds`]): one light of a thousand costs ten choices, and near lights that face the
//! receiver are likely. Clusters are split where the sum of power × extent × spread of the two halves is
//! least (A. Conty Estevez and C. Kulla, Importance sampling of many lights with adaptive tree
//! splitting, 2018, section 4.3; the traversal is theirs without splitting).

use crate::extent::{LightBounds, LightExtent};
use crate::light_sampler::LaneLightChoice;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::{Int, Lane, Mask, Select};
use etalon_transport::{LaneReceiver, LightId, LightSampleContext};
use glam::DVec3;

/// The child of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Below {
    /// One light.
    Light(LightId),
    /// Two nodes: the next one, and this.
    Two(u32),
}

#[derive(Clone, Copy, Debug)]
struct Node {
    promise: LightBounds,
    below: Below,
}

/// The way from the root to a light: bit k says whether its step k goes to the second child.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Trail(u64);

/// A tree of lights.
#[derive(Clone, Debug)]
pub struct LightTree {
    nodes: Vec<Node>,
    /// Path from the root, by light; `None` if it is not in the tree.
    trails: Vec<Option<Trail>>,
}

/// Places at which a cluster may be cut, along each axis.
const BINS: usize = 12;

/// Depth from which clusters are cut in halves of equal number, so that trails stay short: with
/// fewer than 2³² lights no trail has more than 64 steps.
const HALVES_FROM: u32 = 32;

impl LightTree {
    /// A tree of `lights`, each with its id, out of `count`; `None` without lights. Those of no power
    /// are left out.
    pub fn new(mut lights: Vec<(LightId, LightExtent)>, count: usize) -> Option<Self> {
        let total: f64 = lights.iter().map(|(_, extent)| extent.power).sum();
        lights.retain(|(_, extent)| extent.power > 0.0);
        for (_, extent) in &mut lights {
            // Of the whole, and not too little for single precision.
            extent.power = (extent.power / total).max(1e-20);
        }
        if lights.is_empty() || !total.is_finite() {
            return None;
        }
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * lights.len() - 1),
            trails: vec![None; count],
        };
        tree.grow(&mut lights, Trail(0), 0);
        Some(tree)
    }

    fn grow(&mut self, lights: &mut [(LightId, LightExtent)], trail: Trail, depth: u32) {
        let whole = around(lights);
        let node = self.nodes.len();
        self.nodes.push(Node {
            promise: LightBounds::new(&whole),
            below: Below::Light(lights[0].0),
        });
        if let [(light, _)] = lights {
            self.trails[light.0 as usize] = Some(trail);
            return;
        }
        let cut = best_cut(lights, &whole).filter(|_| depth < HALVES_FROM);
        let middle = cut.map_or(0, |cut| partition(lights, |extent| cut.holds(extent)));
        let middle = match middle {
            0 => lights.len() / 2,
            all if all == lights.len() => all / 2,
            between => between,
        };
        let (first, second) = lights.split_at_mut(middle);
        self.grow(first, trail, depth + 1);
        self.nodes[node].below = Below::Two(self.nodes.len() as u32);
        self.grow(second, Trail(trail.0 | 1 << depth), depth + 1);
    }

    /// The probability of the first of a node's children, at `from`; `None` if neither child sends
    /// anything there.
    #[inline]
    fn first(&self, node: usize, second: u32, from: &LightSampleContext) -> Option<f32> {
        let from = from.broadcast();
        let a = self.nodes[node + 1].promise.at(&from);
        let b = self.nodes[second as usize].promise.at(&from);
        (a + b > 0.0).then(|| a / (a + b))
    }

    /// The light of the leaf with this index, or the index of the second child.
    #[inline]
    fn below(&self, node: u32) -> Below {
        self.nodes[node as usize].below
    }

    /// Chooses a light for every receiver that one reaches.
    #[inline(always)]
    pub(crate) fn choose<F: Lane>(&self, from: &LaneReceiver<F>, u: F) -> LaneLightChoice<F> {
        let mut u = u;
        let mut node = F::Int::splat(0);
        let mut probability = F::ONE;
        let mut found = F::Mask::splat(true);
        loop {
            // The root is nobody's child.
            let second = F::Int::from_fn(|i| match self.below(node.lane(i)) {
                Below::Two(second) => second,
                Below::Light(_) => 0,
            });
            let inner = found & !second.eq(F::Int::splat(0));
            if !inner.any() {
                break;
            }
            let first = node.wrapping_add(F::Int::splat(1));
            let [a, b] = [inner.select(first, node), second].map(|child| {
                LightBounds::<F>::of_lanes(|i| &self.nodes[child.lane(i) as usize].promise).at(from)
            });
            let sum = a + b;
            found = found & (sum.gt(F::ZERO) | !inner);
            let p = a / sum;
            let is_first = u.lt(p);
            let q = is_first.select(p, F::ONE - p);
            let rest = is_first.select(u, u - p) / q;
            u = inner.select(rest.min(F::splat(ONE_MINUS_EPSILON)), u);
            probability = inner.select(probability * q, probability);
            node = inner.select(is_first.select(first, second), node);
        }
        LaneLightChoice {
            found,
            light: F::Int::from_fn(|i| match self.below(node.lane(i)) {
                Below::Light(light) => light.0,
                Below::Two(_) => 0,
            }),
            probability,
            rest: u,
        }
    }

    /// The probability with which `light` is chosen for `from`.
    #[inline]
    pub fn probability(&self, from: &LightSampleContext, light: LightId) -> f32 {
        let Some(Trail(mut trail)) = self.trails[light.0 as usize] else {
            return 0.0;
        };
        let (mut node, mut probability) = (0, 1.0);
        while let Below::Two(second) = self.nodes[node].below {
            let Some(p) = self.first(node, second, from) else {
                return 0.0;
            };
            if trail & 1 == 0 {
                probability *= p;
                node += 1;
            } else {
                probability *= 1.0 - p;
                node = second as usize;
            }
            trail >>= 1;
        }
        probability
    }
}

fn around(lights: &[(LightId, LightExtent)]) -> LightExtent {
    let (first, rest) = lights.split_first().expect("clusters are not empty");
    (rest.iter()).fold(first.1, |sum, (_, extent)| sum.union(*extent))
}

/// A plane across an axis.
struct Cut {
    axis: usize,
    at: f64,
}

impl Cut {
    fn holds(&self, extent: &LightExtent) -> bool {
        extent.centre()[self.axis] < self.at
    }
}

/// Moves the lights for which `held` is true to the front; their number.
fn partition(lights: &mut [(LightId, LightExtent)], held: impl Fn(&LightExtent) -> bool) -> usize {
    lights.sort_by_key(|(_, extent)| !held(extent));
    lights.partition_point(|(_, extent)| held(extent))
}

/// The cheapest plane between centres; `None` if all centres are in one place.
fn best_cut(lights: &[(LightId, LightExtent)], whole: &LightExtent) -> Option<Cut> {
    let centres = || lights.iter().map(|(_, extent)| extent.centre());
    let low = centres().fold(DVec3::INFINITY, DVec3::min);
    let high = centres().fold(DVec3::NEG_INFINITY, DVec3::max);
    let sides = whole.high - whole.low;
    let mut best: Option<(f64, Cut)> = None;
    for axis in 0..3 {
        if high[axis] <= low[axis] {
            continue;
        }
        // Clusters are to be cut across their long side: thin slices are looked at from the side.
        let long = sides.max_element() / sides[axis].max(f64::MIN_POSITIVE);
        let mut bins: [Option<LightExtent>; BINS] = [None; BINS];
        for (_, extent) in lights {
            let place = (extent.centre()[axis] - low[axis]) / (high[axis] - low[axis]);
            let bin = &mut bins[((place * BINS as f64) as usize).min(BINS - 1)];
            *bin = Some(bin.map_or(*extent, |sum| sum.union(*extent)));
        }
        for cut in 1..BINS {
            let part = |bins: &[Option<LightExtent>]| {
                bins.iter().flatten().copied().reduce(LightExtent::union)
            };
            let (Some(a), Some(b)) = (part(&bins[..cut]), part(&bins[cut..])) else {
                continue;
            };
            let cost = long * (cost(&a) + cost(&b));
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                let at = low[axis] + (high[axis] - low[axis]) * cut as f64 / BINS as f64;
                best = Some((cost, Cut { axis, at }));
            }
        }
    }
    best.map(|(_, cut)| cut)
}

/// Power × surface × solid angle of a cluster.
fn cost(extent: &LightExtent) -> f64 {
    let s = extent.high - extent.low;
    let surface = 2.0 * (s.x * s.y + s.y * s.z + s.z * s.x);
    // Lights in one line or point have no surface; their length, squared, orders them as well.
    extent.power * extent.orientation_measure() * (surface + 1e-6 * s.length_squared())
}
