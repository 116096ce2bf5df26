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
use crate::light_sampler::{Candidate, LaneLightChoice, LightChoice, LightSamplerKind};
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::{F32x8, Int, Lane, Mask, Select, Vector};
use etalon_transport::{LaneReceiver, LightId, LightSampleContext};
use glam::Vec3;

/// The least share of the strongest light's power that a light is taken to have, so that its irradiance
/// is a positive number in single precision.
const LEAST: f64 = 1e-15;

/// A few lights.
#[derive(Clone, Debug)]
pub struct FewLights {
    lights: Vec<One>,
    /// The bounds of those that are near, light i in lane i.
    near: LightBounds<F32x8>,
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
    #[inline(always)]
    fn at<F: Lane>(&self, from: &LaneReceiver<F>) -> F {
        match self {
            Self::Near(bounds) => bounds.broadcast::<F>().at(from),
            Self::Sky(irradiance) => F::splat(*irradiance),
            Self::Parallel(irradiance, toward) => {
                from.facing(F::Vector::broadcast(*toward)) * *irradiance
            }
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
        let near = LightBounds::of_lanes(|i| match lights.get(i).map(|one| &one.expected) {
            Some(Expected::Near(bounds)) => bounds,
            _ => &LightBounds::NONE,
        });
        (2..=LightSamplerKind::FEW)
            .contains(&lights.len())
            .then_some(Self { lights, near })
    }

    /// The expected irradiance of each light at several receivers.
    #[inline(always)]
    fn expected<F: Lane>(&self, from: &LaneReceiver<F>) -> [F; LightSamplerKind::FEW] {
        let mut expected = [F::ZERO; LightSamplerKind::FEW];
        for (expected, one) in expected.iter_mut().zip(&self.lights) {
            *expected = one.expected.at(from);
        }
        expected
    }

    /// The same at one receiver, for which the lanes are lights.
    #[inline]
    fn expected_at_one(&self, from: &LightSampleContext) -> [f32; LightSamplerKind::FEW] {
        let mut expected = [0.0; LightSamplerKind::FEW];
        self.near.at(&from.broadcast()).store(&mut expected);
        for (expected, one) in expected.iter_mut().zip(&self.lights) {
            if !matches!(one.expected, Expected::Near(_)) {
                *expected = one.expected.at::<f32>(&from.broadcast());
            }
        }
        expected
    }

    /// The probability of each light, in the order in which they are kept; zeros if nothing is expected.
    #[inline(always)]
    fn shares<F: Lane>(&self, expected: [F; LightSamplerKind::FEW]) -> [F; LightSamplerKind::FEW] {
        let mut shares = expected;
        let (mut expected, mut weights) = (F::ZERO, F::ZERO);
        for (share, one) in shares.iter_mut().zip(&self.lights) {
            *share = *share * one.weight;
            let reaches = share.gt(F::ZERO);
            expected = reaches.select(expected + *share, expected);
            weights = reaches.select(weights + one.weight, weights);
        }
        let (by_expected, by_weight) = (F::splat(0.5) / expected, F::splat(0.5) / weights);
        for (share, one) in shares.iter_mut().zip(&self.lights) {
            let probability = *share * by_expected + by_weight * one.weight;
            *share = share.gt(F::ZERO).select(probability, *share);
        }
        shares
    }

    /// Chooses a light for `from`; `None` if none reaches it.
    #[inline]
    pub fn choose(&self, from: &LightSampleContext, u: f32) -> Option<LightChoice> {
        self.chosen::<f32>(self.expected_at_one(from), u).only()
    }

    /// Chooses a light for every receiver that one reaches.
    #[inline(always)]
    pub fn choose_lanes<F: Lane>(&self, from: &LaneReceiver<F>, u: F) -> LaneLightChoice<F> {
        self.chosen(self.expected(from), u)
    }

    #[inline(always)]
    fn chosen<F: Lane>(&self, expected: [F; LightSamplerKind::FEW], u: F) -> LaneLightChoice<F> {
        let mut u = u;
        let mut choice = LaneLightChoice::<F>::none();
        let mut open = F::Mask::splat(true);
        for (&probability, one) in self.shares(expected).iter().zip(&self.lights) {
            // The last that is possible, should rounding leave a rest.
            let here = open & probability.gt(F::ZERO);
            choice.found = choice.found | here;
            choice.light = here.select(F::Int::splat(one.light.0), choice.light);
            choice.probability = here.select(probability, choice.probability);
            let rest = (u / probability).min(F::splat(ONE_MINUS_EPSILON));
            choice.rest = here.select(rest, choice.rest);
            open = open & !(here & u.lt(probability));
            if !open.any() {
                break;
            }
            u = here.select(u - probability, u);
        }
        choice
    }

    /// [`FewLights::probability`] in lanes, for one light.
    #[inline(always)]
    pub fn probability_lanes<F: Lane>(&self, from: &LaneReceiver<F>, light: LightId) -> F {
        let at = self.lights.iter().position(|one| one.light == light);
        at.map_or(F::ZERO, |at| self.shares(self.expected(from))[at])
    }

    /// The probability with which [`FewLights::choose`] chooses `light` for `from`.
    #[inline]
    pub fn probability(&self, from: &LightSampleContext, light: LightId) -> f32 {
        let at = self.lights.iter().position(|one| one.light == light);
        at.map_or(0.0, |at| self.shares::<f32>(self.expected_at_one(from))[at])
    }
}
