//! Light selection, for receivers and for particles.
//!
//! Particles choose a light in proportion to power times `sampling_weight`. For a receiver, the rule is
//! [`LightSamplerKind`]: uniform, by power, or by the expected irradiance ([`FewLights`], [`LightTree`]).
//!
//! The power of a light at infinity is that which enters the scene's bounding sphere. A large ground plane
//! makes it huge, and it says little about the visible part of the scene. So, if a scene has lights of both
//! kinds, each kind gets half of the probability in the selection by power and by the tree.

use crate::extent::LightExtent;
use crate::few::FewLights;
use crate::tree::LightTree;
use etalon_math::lane::{Int, Lane, Mask, Select, per_lane};
use etalon_sampling::discrete::AliasTable;
use etalon_transport::{LaneReceiver, LightId, LightSampleContext};
use glam::Vec3;

/// A chosen light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChoice {
    /// The light.
    pub light: LightId,
    /// The probability of having chosen it; above zero.
    pub probability: f32,
    /// The random number rescaled for reuse: uniform in [0, 1).
    pub rest: f32,
}

/// Chosen lights, one for each of several receivers.
#[derive(Clone, Copy, Debug)]
pub struct LaneLightChoice<F: Lane> {
    /// The lanes that have one; what others have does not matter.
    pub found: F::Mask,
    /// The indices of the lights.
    pub light: F::Int,
    /// The probability of having chosen each.
    pub probability: F,
    /// The random numbers rescaled for reuse.
    pub rest: F,
}

impl<F: Lane> LaneLightChoice<F> {
    /// No light in any lane.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self {
            found: F::Mask::splat(false),
            light: F::Int::splat(0),
            probability: F::ZERO,
            rest: F::ZERO,
        }
    }

    /// `choice(i)` in lane i.
    #[inline(always)]
    fn of_lanes(choice: impl Fn(usize) -> Option<LightChoice>) -> Self {
        let choices = per_lane::<F, _>(choice);
        let number =
            |of: fn(&LightChoice) -> f32| F::from_fn(|i| choices[i].as_ref().map_or(0.0, of));
        Self {
            found: F::Mask::from_fn(|i| choices[i].is_some()),
            light: F::Int::from_fn(|i| choices[i].map_or(0, |choice| choice.light.0)),
            probability: number(|choice| choice.probability),
            rest: number(|choice| choice.rest),
        }
    }

    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        Self {
            found: (yes.found & mask) | (no.found & !mask),
            light: mask.select(yes.light, no.light),
            probability: mask.select(yes.probability, no.probability),
            rest: mask.select(yes.rest, no.rest),
        }
    }

    /// The choice in lane `index`, which has one.
    #[inline(always)]
    pub(crate) fn at_lane(&self, index: usize) -> LightChoice {
        LightChoice {
            light: LightId(self.light.lane(index)),
            probability: self.probability.lane(index),
            rest: self.rest.lane(index),
        }
    }
}

impl LaneLightChoice<f32> {
    /// The choice, where there is one lane.
    #[inline(always)]
    pub(crate) fn only(self) -> Option<LightChoice> {
        self.found.then(|| self.at_lane(0))
    }
}

/// How a light is selected for a receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightSamplerKind {
    /// Uniformly, times `sampling_weight`.
    Uniform,
    /// By power.
    Power,
    /// By a tree over the lights, by power, distance and orientation.
    Tree,
    /// By the expected irradiance of each light if there are at most [`LightSamplerKind::FEW`], else by a tree.
    #[default]
    Automatic,
}

impl LightSamplerKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Automatic, Self::Uniform, Self::Power, Self::Tree];

    /// The largest number of lights for [`FewLights`]; beyond, a tree is cheaper.
    pub const FEW: usize = 8;

    /// Its name in scenes and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Automatic => "automatic",
            Self::Uniform => "uniform",
            Self::Power => "power",
            Self::Tree => "tree",
        }
    }

    /// The chooser of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// The facts of a light that selection depends on.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Emitted power (W·nm⁻¹).
    pub power: f64,
    /// Its `sampling_weight`.
    pub weight: f64,
    /// Its bounds; `None` at infinity.
    pub extent: Option<LightExtent>,
    /// The facts of a light at infinity.
    pub far: Far,
}

/// The facts of a light at infinity that selection depends on.
#[derive(Clone, Copy, Debug)]
pub struct Far {
    /// The area across which its power enters the scene (m²).
    pub cross_section: f64,
    /// The one direction in which it is, if there is but one.
    pub toward: Option<Vec3>,
}

/// A distribution over lights.
#[derive(Clone, Debug)]
pub struct LightSampler {
    /// Distribution by power; `None` if no light can be chosen.
    by_power: Option<AliasTable>,
    /// For points; `None` for the same.
    for_points: Option<ForPoints>,
}

/// A distribution for points.
#[derive(Clone, Debug)]
enum ForPoints {
    /// The same for all.
    Table(AliasTable),
    /// For each its own, of few lights.
    Few(Box<FewLights>),
    /// For each its own, of the lights that have a place.
    Tree {
        tree: LightTree,
        /// Those at infinity.
        far: Option<AliasTable>,
        /// The share of choices that goes to them.
        far_share: f32,
    },
}

impl LightSampler {
    /// The distribution over lights, in the order of their ids. Lights of no power or weight are
    /// never chosen.
    pub fn new(lights: &[Candidate], kind: LightSamplerKind) -> Self {
        let weight = |light: &Candidate| light.power * light.weight;
        let total = |far: bool| -> (f64, f64) {
            let kind = || lights.iter().filter(|l| l.extent.is_none() == far);
            (kind().map(|l| l.power).sum(), kind().map(weight).sum())
        };
        let totals = [total(false), total(true)];
        let both = totals.iter().all(|(_, weights)| *weights > 0.0);
        let by_power = |light: &Candidate| match both {
            true => weight(light) / totals[usize::from(light.extent.is_none())].0,
            false => weight(light),
        };
        let table = |of: &dyn Fn(&Candidate) -> f64| {
            AliasTable::new(&lights.iter().map(of).collect::<Vec<_>>()).ok()
        };
        let few = lights.iter().filter(|l| weight(l) > 0.0).count() <= LightSamplerKind::FEW;
        let for_points = match kind {
            LightSamplerKind::Power => None,
            LightSamplerKind::Automatic if few => {
                FewLights::new(lights).map(|few| ForPoints::Few(Box::new(few)))
            }
            LightSamplerKind::Uniform => table(&|light| match light.power > 0.0 {
                true => light.weight,
                false => 0.0,
            })
            .map(ForPoints::Table),
            LightSamplerKind::Tree | LightSamplerKind::Automatic => {
                Self::tree(lights).map(|tree| {
                    let far = table(&|light| match light.extent {
                        Some(_) => 0.0,
                        None => weight(light),
                    });
                    let far_share = if far.is_some() { 0.5 } else { 0.0 };
                    ForPoints::Tree {
                        tree,
                        far,
                        far_share,
                    }
                })
            }
        };
        Self {
            by_power: table(&by_power),
            for_points,
        }
    }

    fn tree(lights: &[Candidate]) -> Option<LightTree> {
        let placed = lights.iter().enumerate().filter_map(|(index, light)| {
            let extent = LightExtent {
                power: light.power * light.weight,
                ..light.extent?
            };
            Some((LightId(index as u32), extent))
        });
        LightTree::new(placed.collect(), lights.len())
    }

    /// Selects a light for the receiver `from`. `None` if there is none that sends
    /// anything there.
    #[inline]
    pub fn choose(&self, from: &LightSampleContext, u: f32) -> Option<LightChoice> {
        match &self.for_points {
            Some(ForPoints::Few(few)) => few.choose(from, u),
            _ => self.choose_lanes::<f32>(&from.broadcast(), u).only(),
        }
    }

    /// The same for several receivers.
    #[inline(always)]
    pub fn choose_lanes<F: Lane>(&self, from: &LaneReceiver<F>, u: F) -> LaneLightChoice<F> {
        let (tree, far, far_share) = match &self.for_points {
            None => return LaneLightChoice::of_lanes(|i| self.choose_to_emit(u.lane(i))),
            Some(ForPoints::Table(table)) => {
                return LaneLightChoice::of_lanes(|i| chosen(table, u.lane(i)));
            }
            Some(ForPoints::Few(few)) => return few.choose_lanes(from, u),
            Some(ForPoints::Tree {
                tree,
                far,
                far_share,
            }) => (tree, far, *far_share),
        };
        let is_far = u.lt(F::splat(far_share));
        let share = 1.0 - far_share;
        let mut choice = match is_far.all() {
            true => LaneLightChoice::none(),
            false => tree.choose(from, (u - far_share) / share),
        };
        choice.probability = choice.probability * share;
        if let Some(far) = far
            && is_far.any()
        {
            let mut at_infinity = LaneLightChoice::of_lanes(|i| {
                let choose = || chosen(far, u.lane(i) / far_share);
                is_far.lane(i).then(choose).flatten()
            });
            at_infinity.probability = at_infinity.probability * far_share;
            choice = LaneLightChoice::choose(is_far, at_infinity, choice);
        }
        choice
    }

    /// The probability with which [`LightSampler::choose`] chooses `light` for the point
    /// `from`.
    #[inline]
    pub fn probability(&self, from: &LightSampleContext, light: LightId) -> f32 {
        match &self.for_points {
            None => self.probability_to_emit(light),
            Some(ForPoints::Table(table)) => table.probability(light.0 as usize),
            Some(ForPoints::Few(few)) => few.probability(from, light),
            Some(ForPoints::Tree {
                tree,
                far,
                far_share,
            }) => {
                let far = (far.as_ref()).map_or(0.0, |far| far.probability(light.0 as usize));
                match far > 0.0 {
                    true => far * far_share,
                    false => tree.probability(from, light) * (1.0 - far_share),
                }
            }
        }
    }

    /// [`LightSampler::probability`] in lanes, for one light.
    #[inline]
    pub fn probability_lanes<F: Lane>(&self, from: &LaneReceiver<F>, light: LightId) -> F {
        match &self.for_points {
            Some(ForPoints::Few(few)) => few.probability_lanes(from, light),
            Some(ForPoints::Tree { .. }) => {
                F::from_fn(|i| self.probability(&from.at_lane(i), light))
            }
            // It is the same for all.
            _ => F::splat(self.probability(&from.at_lane(0), light)),
        }
    }

    /// The probability with which [`LightSampler::choose_to_emit`] chooses `light`.
    #[inline]
    pub fn probability_to_emit(&self, light: LightId) -> f32 {
        (self.by_power.as_ref()).map_or(0.0, |table| table.probability(light.0 as usize))
    }

    /// Chooses a light to emit a particle.
    #[inline]
    pub fn choose_to_emit(&self, u: f32) -> Option<LightChoice> {
        chosen(self.by_power.as_ref()?, u)
    }
}

#[inline]
fn chosen(table: &AliasTable, u: f32) -> Option<LightChoice> {
    let choice = table.sample(u);
    (choice.probability > 0.0).then_some(LightChoice {
        light: LightId(choice.index as u32),
        probability: choice.probability,
        rest: choice.rest,
    })
}
