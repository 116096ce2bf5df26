//! Lights that are sampled together in lanes: those of one kind, each lane its own light.

use crate::{Light, LightSet};
use etalon_math::lane::{Int, Lane, Mask, Select, Spectral};
use etalon_spectrum::Wavelengths;
use etalon_transport::{LaneLightSample, LaneReceiver, LightId, Shapes, Textures};
use glam::Vec2;

/// For each light, the first that can be sampled in lanes together with it; none if it is sampled by itself.
pub(crate) fn alike(lights: &[Light], scene: &impl Shapes) -> Vec<LightId> {
    let mut kinds: Vec<usize> = Vec::new();
    let mut alike = Vec::with_capacity(lights.len());
    for (index, light) in lights.iter().enumerate() {
        if !light.is_alike(light, scene) {
            alike.push(LightId::NONE);
            continue;
        }
        let kind = kinds
            .iter()
            .find(|kind| lights[**kind].is_alike(light, scene));
        let kind = kind.copied().unwrap_or_else(|| {
            kinds.push(index);
            index
        });
        alike.push(LightId(kind as u32));
    }
    alike
}

impl LightSet {
    /// [`LightSet::sample`] for several receivers, in the lanes where it is `wanted`.
    #[inline]
    pub fn sample_lanes<F: Lane>(
        &self,
        scene: &(impl Textures + Shapes),
        (from, wavelengths): (&LaneReceiver<F>, &[Wavelengths]),
        wanted: F::Mask,
        u_light: F,
        u: [F; 2],
    ) -> LaneLightSample<F> {
        if let Some(light) = self.lone
            && self.alike[light.0 as usize].is_some()
        {
            // It is chosen with probability 1.
            let light = self.get(light);
            return Light::sample_lanes(|_| light, scene, (from, wavelengths), wanted, u);
        }
        let choice = self.selector.choose_lanes(from, u_light);
        let chosen = choice.found & wanted;
        let alike = F::Int::from_fn(|i| match chosen.lane(i) {
            true => self.alike[choice.light.lane(i) as usize].0,
            false => 0,
        });
        let mut sample = LaneLightSample::none();
        // Lanes whose light must be sampled by itself.
        let mut alone = 0;
        let mut left = chosen.bits();
        while left != 0 {
            let first = left.trailing_zeros() as usize;
            let kind = LightId(alike.lane(first));
            let lanes = chosen & alike.eq(F::Int::splat(kind.0));
            left &= !lanes.bits();
            if !kind.is_some() || self.are_one(self.get(kind).is_background()) {
                alone |= lanes.bits();
                continue;
            }
            // Lanes of other lights repeat the first.
            let light = lanes.select(choice.light, F::Int::splat(choice.light.lane(first)));
            let light = |i: usize| self.get(LightId(light.lane(i)));
            let found = Light::sample_lanes(light, scene, (from, wavelengths), lanes, u);
            sample = LaneLightSample::choose(lanes, found, sample);
        }
        sample.chance = sample.chance * choice.probability;
        if alone == 0 {
            return sample;
        }
        let is_alone = |i: usize| alone >> i & 1 != 0;
        let by_itself = LaneLightSample::of_lanes(|i| {
            let u = Vec2::from(u.map(|u| u.lane(i)));
            let at =
                |choice| self.sample_chosen(scene, choice, &from.at_lane(i), &wavelengths[i], u);
            is_alone(i).then(|| at(choice.at_lane(i))).flatten()
        });
        LaneLightSample::choose(F::Mask::from_fn(is_alone), by_itself, sample)
    }

    /// [`LightSet::background`] and [`LightSet::background_density`] in lanes.
    #[inline]
    pub fn background_lanes<F: Lane>(
        &self,
        textures: &impl Textures,
        from: &LaneReceiver<F>,
        direction: F::Vector,
        wavelengths: &[Wavelengths],
    ) -> (F::Spectrum, F) {
        let nothing = (F::Spectrum::uniform(F::ZERO), F::ZERO);
        self.backgrounds.iter().fold(nothing, |sum, &light| {
            let probability = self.selector.probability_lanes(from, light);
            let (radiance, density) =
                (self.get(light)).background_lanes(textures, from, direction, wavelengths);
            (sum.0 + radiance, sum.1 + density * probability)
        })
    }
}
