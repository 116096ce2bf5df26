//! Which light to ask: chosen by power, with the means to do it by place later.
//!
//! Lights are chosen in proportion to their power times their `sampling_weight`. The power of a
//! light at infinity is what enters the scene's bounding sphere, which says little of what
//! arrives where the eye looks (one large ground plane makes it huge). So, where there are lights
//! of both kinds, each kind is given half of the choices.

use crate::light::Light;
use etalon_sampling::discrete::AliasTable;
use etalon_transport::{LightId, Receiver};

/// A chosen light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChoice {
    /// The light.
    pub light: LightId,
    /// The probability of having chosen it; above zero.
    pub probability: f32,
    /// What is left of the random number: uniform in [0, 1) again.
    pub rest: f32,
}

/// A distribution over lights.
#[derive(Clone, Debug)]
pub struct LightSelector {
    /// `None` if no light can be chosen.
    table: Option<AliasTable>,
}

impl LightSelector {
    /// The distribution for lights with the given powers (W·nm⁻¹) and sampling weights. Lights of
    /// no power or weight are never chosen.
    pub fn new(lights: &[Light], powers: &[f64], sampling_weights: &[f64]) -> Self {
        let total = |infinite: bool, values: &dyn Fn(usize) -> f64| -> f64 {
            (0..lights.len())
                .filter(|&i| lights[i].is_infinite() == infinite)
                .map(values)
                .sum()
        };
        let weight = |i: usize| powers[i] * sampling_weights[i];
        let powers_of = [false, true].map(|infinite| total(infinite, &|i| powers[i]));
        let both = [false, true]
            .iter()
            .all(|&infinite| total(infinite, &weight) > 0.0);
        let weights: Vec<f64> = (0..lights.len())
            .map(|i| {
                if both {
                    weight(i) / powers_of[usize::from(lights[i].is_infinite())]
                } else {
                    weight(i)
                }
            })
            .collect();
        Self {
            table: AliasTable::new(&weights).ok(),
        }
    }

    /// Chooses a light to ask for what arrives at `from`. `None` if there is none.
    #[inline]
    pub fn choose(&self, _from: &Receiver, u: f32) -> Option<LightChoice> {
        self.choose_to_emit(u)
    }

    /// The probability with which [`LightSelector::choose`] chooses `light` for the point
    /// `_from`.
    #[inline]
    pub fn probability(&self, _from: &Receiver, light: LightId) -> f32 {
        self.probability_to_emit(light)
    }

    /// The probability with which [`LightSelector::choose_to_emit`] chooses `light`.
    #[inline]
    pub fn probability_to_emit(&self, light: LightId) -> f32 {
        self.table
            .as_ref()
            .map_or(0.0, |table| table.probability(light.0 as usize))
    }

    /// Chooses a light to emit a particle.
    #[inline]
    pub fn choose_to_emit(&self, u: f32) -> Option<LightChoice> {
        let choice = self.table.as_ref()?.sample(u);
        (choice.probability > 0.0).then_some(LightChoice {
            light: LightId(choice.index as u32),
            probability: choice.probability,
            rest: choice.rest,
        })
    }
}
