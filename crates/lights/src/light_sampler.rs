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
use etalon_sampling::discrete::AliasTable;
use etalon_transport::{LightId, LightSampleContext};
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
    Few(FewLights),
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
            LightSamplerKind::Automatic if few => FewLights::new(lights).map(ForPoints::Few),
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
            None => self.choose_to_emit(u),
            Some(ForPoints::Table(table)) => chosen(table, u),
            Some(ForPoints::Few(few)) => few.choose(from, u),
            Some(ForPoints::Tree {
                tree,
                far,
                far_share,
            }) => match far {
                Some(far) if u < *far_share => {
                    chosen(far, u / far_share).map(|choice| LightChoice {
                        probability: choice.probability * far_share,
                        ..choice
                    })
                }
                _ => {
                    let near = 1.0 - far_share;
                    let choice = tree.choose(from, (u - far_share) / near)?;
                    Some(LightChoice {
                        probability: choice.probability * near,
                        ..choice
                    })
                }
            },
        }
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
