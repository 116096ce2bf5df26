//! Selection among few lights, by the expected irradiance of each at the receiver.
//!
//! Light i of sampling weight wᵢ is chosen with the probability
//!
//! ```text
//! pᵢ = ½ wᵢ Eᵢ / Σⱼ wⱼ Eⱼ  +  ½ wᵢ [Eᵢ > 0] / Σⱼ wⱼ [Eⱼ > 0]
//! ```
//!
//! where Eᵢ estimates the unoccluded irradiance at the receiver: I(x, n) of [`crate::extent`] over the solid
//! angles that the light shines into, or the irradiance of a parallel light or of the mean of a sky. It is zero
//! only if no light arrives. The uniform half makes up for occlusion and the unknown brightness of a sky: no
//! light that reaches the receiver has less than half of its uniform probability.

use crate::extent::{LightBounds, LightExtent};
use crate::light_sampler::{Candidate, LightChoice, LightSamplerKind};
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_transport::{LightId, LightSampleContext};
use glam::Vec3;

/// The least share of the strongest light's power that a light is taken to have, so that its irradiance
/// is a positive number in single precision.
const LEAST: f64 = 1e-15;

/// A few lights.
#[derive(Clone, Debug)]
pub struct FewLights {
    lights: Vec<One>,
}

#[derive(Clone, Copy, Debug)]
struct One {
    light: LightId,
    weight: f32,
    expected: Expected,
}

/// The expected irradiance of a light.
#[derive(Clone, Copy, Debug)]
enum Expected {
    Near(LightBounds),
    /// The same irradiance for all receivers.
    Sky(f32),
    /// Irradiance on a surface that faces the light, and where the light is.
    Parallel(f32, Vec3),
}

impl Expected {
    #[inline]
    fn at(&self, from: &LightSampleContext) -> f32 {
        match self {
            Self::Near(promise) => promise.at(from),
            Self::Sky(irradiance) => *irradiance,
            Self::Parallel(irradiance, toward) => irradiance * from.facing(*toward),
        }
    }
}

impl FewLights {
    /// Those of `lights`, in the order of their ids, that have any power and weight; `None` if there is
    /// nothing to choose, or if they are more than [`LightSamplerKind::FEW`].
    pub fn new(lights: &[Candidate]) -> Option<Self> {
        let strongest = lights.iter().map(|l| l.power).fold(0.0, f64::max);
        let heaviest = lights.iter().map(|l| l.weight).fold(0.0, f64::max);
        let one = |(index, light): (usize, &Candidate)| {
            let power = (light.power / strongest).max(LEAST);
            let expected = match (light.extent, light.far) {
                (Some(extent), _) => Expected::Near(LightBounds::new(&LightExtent {
                    power: power / extent.orientation_measure().max(LEAST),
                    ..extent
                })),
                (None, far) => {
                    let irradiance = (power / far.cross_section).max(LEAST) as f32;
                    match far.toward {
                        Some(toward) => Expected::Parallel(irradiance, toward),
                        None => Expected::Sky(0.25 * irradiance),
                    }
                }
            };
            (light.power * light.weight > 0.0).then_some(One {
                light: LightId(index as u32),
                weight: (light.weight / heaviest).max(LEAST) as f32,
                expected,
            })
        };
        let lights: Vec<One> = lights.iter().enumerate().filter_map(one).collect();
        (2..=LightSamplerKind::FEW)
            .contains(&lights.len())
            .then_some(Self { lights })
    }

    /// The probability of each light, in the order in which they are kept; zeros if none reaches `from`.
    #[inline]
    fn shares(&self, from: &LightSampleContext) -> [f32; LightSamplerKind::FEW] {
        let mut shares = [0.0; LightSamplerKind::FEW];
        let (mut expected, mut weights) = (0.0, 0.0);
        for (share, one) in shares.iter_mut().zip(&self.lights) {
            *share = one.weight * one.expected.at(from);
            if *share > 0.0 {
                expected += *share;
                weights += one.weight;
            }
        }
        if expected > 0.0 {
            let (by_expected, by_weight) = (0.5 / expected, 0.5 / weights);
            for (share, one) in shares.iter_mut().zip(&self.lights) {
                if *share > 0.0 {
                    *share = *share * by_expected + one.weight * by_weight;
                }
            }
        }
        shares
    }

    /// Chooses a light for `from`; `None` if none reaches it.
    #[inline]
    pub fn choose(&self, from: &LightSampleContext, mut u: f32) -> Option<LightChoice> {
        let mut choice = None;
        for (&probability, one) in self.shares(from).iter().zip(&self.lights) {
            if probability > 0.0 {
                choice = Some(LightChoice {
                    light: one.light,
                    probability,
                    rest: (u / probability).min(ONE_MINUS_EPSILON),
                });
                if u < probability {
                    break;
                }
                u -= probability;
            }
        }
        choice
    }

    /// The probability with which [`FewLights::choose`] chooses `light` for `from`.
    #[inline]
    pub fn probability(&self, from: &LightSampleContext, light: LightId) -> f32 {
        let at = self.lights.iter().position(|one| one.light == light);
        at.map_or(0.0, |at| self.shares(from)[at])
    }
}
