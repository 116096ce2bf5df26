//! All lights of a scene.

use crate::alike;
use crate::{
    BoundingSphere, Candidate, Far, Light, LightChoice, LightDescription, LightSampler,
    LightSamplerKind,
};
use etalon_math::{DeltaProbability, Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Emission, EmissionPdf, LightCount, LightId, LightKind, LightSample, LightSampleContext,
    LightVariety, SamplePdf, Shapes, SurfaceInteraction, SurfacePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// The lights of a scene, by id. Methods implement those of [`etalon_transport::World`] of the same name;
/// densities and weights include the choice of the light.
#[derive(Clone, Debug)]
pub struct LightSet {
    lights: Vec<Light>,
    /// For each, the first that can be sampled in lanes together with it; none if it is sampled by itself.
    pub(crate) alike: Vec<LightId>,
    /// The lights that rays see at infinity.
    pub(crate) backgrounds: Vec<LightId>,
    powers: Vec<f64>,
    pub(crate) selector: LightSampler,
    /// The only light that is ever chosen.
    pub(crate) lone: Option<LightId>,
    bounds: BoundingSphere,
}

impl LightSet {
    /// Lights in the order of their ids, for a scene within `bounds`; `kind` is the rule of selection for
    /// receivers.
    pub fn new(
        descriptions: Vec<LightDescription>,
        scene: &(impl Textures + Shapes),
        bounds: BoundingSphere,
        kind: LightSamplerKind,
    ) -> Self {
        let (lights, weights): (Vec<Light>, Vec<f64>) = descriptions
            .into_iter()
            .map(|description| (description.light, description.sampling_weight))
            .unzip();
        let alike = alike::alike(&lights, scene);
        let powers: Vec<f64> = lights.iter().map(|l| l.power(scene, &bounds)).collect();
        let backgrounds = (0..lights.len())
            .filter(|&i| lights[i].is_background())
            .map(|i| LightId(i as u32))
            .collect();
        let candidates: Vec<Candidate> = (lights.iter().zip(&powers).zip(weights))
            .map(|((light, &power), weight)| Candidate {
                power,
                weight,
                extent: light.extent(scene),
                far: Far {
                    cross_section: bounds.cross_section(),
                    toward: light.toward(),
                },
            })
            .collect();
        let selector = LightSampler::new(&candidates, kind);
        let mut chosen = (0..lights.len() as u32)
            .map(LightId)
            .filter(|&light| selector.probability_to_emit(light) > 0.0);
        let lone = chosen.next().filter(|_| chosen.next().is_none());
        Self {
            selector,
            lone,
            lights,
            alike,
            backgrounds,
            powers,
            bounds,
        }
    }

    /// A light.
    #[inline]
    pub fn get(&self, light: LightId) -> &Light {
        &self.lights[light.0 as usize]
    }

    /// Number of lights.
    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// Whether there is no light.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// Emitted power of a light (see [`Light::power`]).
    pub fn power(&self, light: LightId) -> f64 {
        self.powers[light.0 as usize]
    }

    /// That of all lights together.
    pub fn total_power(&self) -> f64 {
        self.powers.iter().sum()
    }

    /// The rule of light selection.
    pub fn selector(&self) -> &LightSampler {
        &self.selector
    }

    /// Numbers of the lights that emit, by the ways of finding them.
    pub fn count(&self) -> LightCount {
        let mut count = LightCount::default();
        for (index, light) in self.lights.iter().enumerate() {
            // The power of a light at infinity is what enters the scene, if there is one.
            let into_nothing = light.is_infinite() && self.bounds.radius == 0.0;
            if !(self.powers[index] > 0.0 || into_nothing) {
                continue;
            }
            let hittable = light.can_be_hit();
            let chosen = self.selector.probability_to_emit(LightId(index as u32)) > 0.0;
            count.all += 1;
            count.hittable += u32::from(hittable);
            count.chosen += u32::from(chosen);
            count.either += u32::from(hittable || chosen);
            count.beams += u32::from(chosen && light.is_beam());
        }
        count
    }

    /// Radiance emitted by the surface at `vertex` toward `wo`.
    #[inline]
    pub fn emitted(
        &self,
        textures: &impl Textures,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        if !vertex.light.is_some() {
            return Vec4::ZERO;
        }
        self.get(vertex.light)
            .emitted(textures, vertex, wo, wavelengths)
    }

    /// Whether any light is at infinity.
    pub fn has_infinite(&self) -> bool {
        self.lights.iter().any(Light::is_infinite)
    }

    /// Whether any light at infinity can be seen.
    #[inline]
    pub fn has_background(&self) -> bool {
        !self.backgrounds.is_empty()
    }

    /// Radiance of the lights at infinity seen at the moment `time` along the unit vector `direction`.
    #[inline]
    pub fn background(
        &self,
        textures: &impl Textures,
        direction: Vec3,
        time: f32,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        let radiance =
            |&light: &LightId| (self.get(light)).background(textures, direction, time, wavelengths);
        self.backgrounds.iter().map(radiance).sum()
    }

    /// Chooses a light and a direction toward it.
    #[inline]
    pub fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let choice = self.selector.choose(from, u_light)?;
        self.sample_chosen(scene, choice, from, wavelengths, u)
    }

    /// The sample of a light that has been chosen.
    #[inline]
    pub(crate) fn sample_chosen(
        &self,
        scene: &(impl Textures + Shapes),
        choice: LightChoice,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let mut sampled = self.get(choice.light).sample(scene, from, wavelengths, u);
        // In place: it is not copied.
        let sample = sampled.as_mut()?;
        sample.light = choice.light;
        match &mut sample.chance {
            SamplePdf::Continuous(density) if self.are_one(sample.target.is_none()) => {
                sample.radiance = self.background(scene, sample.direction, from.time, wavelengths);
                *density = self.background_density(from, sample.direction);
            }
            SamplePdf::Continuous(density) => *density = *density * choice.probability,
            SamplePdf::Discrete(DeltaProbability(p)) => *p *= choice.probability,
        }
        sampled
    }

    /// Whether a sample, at infinity or not, is of several skies: seen in one direction, they are one technique, since a ray that
    /// goes there sees all of them, whichever of them chose it.
    #[inline]
    pub(crate) fn are_one(&self, at_infinity: bool) -> bool {
        at_infinity && self.backgrounds.len() > 1
    }

    /// How samples of [`LightSet::sample`] from `from` vary.
    #[inline]
    pub fn light_variety(&self, from: &LightSampleContext) -> LightVariety {
        match self.lone.map(|light| self.get(light)) {
            None => LightVariety::Several,
            Some(light) if light.is_even(from) => LightVariety::Even,
            Some(_) => LightVariety::Single,
        }
    }

    /// A direction toward one light, as if it were the only one.
    #[inline]
    pub fn sample_one(
        &self,
        scene: &(impl Textures + Shapes),
        light: LightId,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let mut sampled = self.get(light).sample(scene, from, wavelengths, u);
        if let Some(sample) = &mut sampled {
            sample.light = light;
        }
        sampled
    }

    /// The density with which [`LightSet::sample`] from `from` chooses the surface point `at`;
    /// zero if it does not emit.
    #[inline]
    pub fn density(
        &self,
        shapes: &impl Shapes,
        from: &LightSampleContext,
        at: &SurfaceInteraction,
    ) -> Density<SolidAngle> {
        if !at.light.is_some() {
            return Density::ZERO;
        }
        let probability = self.selector.probability(from, at.light);
        self.get(at.light)
            .density(shapes, from, &SurfacePoint::from(at))
            * probability
    }

    /// The density with which [`LightSet::sample`] from `from` chooses the background in
    /// `direction`.
    #[inline]
    pub fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        self.backgrounds.iter().fold(Density::ZERO, |sum, &light| {
            let probability = self.selector.probability(from, light);
            sum + self.get(light).background_density(from, direction) * probability
        })
    }

    /// Emits a particle.
    #[inline]
    pub fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        wavelengths: &Wavelengths,
        u_light: f32,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let choice = self.selector.choose_to_emit(u_light)?;
        let mut emission = self.get(choice.light).emit(
            scene,
            &self.bounds,
            wavelengths,
            u_position,
            u_direction,
            time,
        )?;
        emission.light = choice.light;
        emission.ray.time = time;
        if emission.origin == LightKind::Sky && self.backgrounds.len() > 1 {
            // One technique, as in `sample`.
            let toward = -emission.ray.direction;
            emission.density = self.emission_density(scene, choice.light, -toward, 1.0, time);
            let EmissionPdf { origin, ray } = emission.density;
            emission.weight = self.background(scene, toward, time, wavelengths) / (origin * ray);
        } else {
            emission.weight /= choice.probability;
            emission.density.origin *= choice.probability;
        }
        Some(emission)
    }

    /// The densities with which [`LightSet::emit`] makes a particle of `light` travel along
    /// `direction`, whose angle with the light's surface has the cosine `cos`.
    #[inline]
    pub fn emission_density(
        &self,
        shapes: &impl Shapes,
        light: LightId,
        direction: Vec3,
        cos: f32,
        time: f32,
    ) -> EmissionPdf {
        if self.backgrounds.len() > 1 && self.get(light).is_background() {
            return self.background_emission_density(shapes, -direction, time);
        }
        let chosen = self.get(light);
        let mut density = chosen.emission_density(shapes, &self.bounds, direction, cos, time);
        density.origin *= self.selector.probability_to_emit(light);
        density
    }

    /// The densities with which [`LightSet::emit`] makes a particle come at the moment `time` from the lights at infinity
    /// seen along `direction`.
    #[inline]
    pub fn background_emission_density(
        &self,
        shapes: &impl Shapes,
        direction: Vec3,
        time: f32,
    ) -> EmissionPdf {
        let origins = self.backgrounds.iter().map(|&light| {
            let sky = self.get(light);
            let density = sky.emission_density(shapes, &self.bounds, -direction, 1.0, time);
            density.origin * self.selector.probability_to_emit(light)
        });
        EmissionPdf {
            origin: origins.sum(),
            ray: self.bounds.ray_density(),
        }
    }

    /// The density with which [`LightSet::sample`] from `from` chooses the point where a particle
    /// began; the probability of its light if that is a point or a direction.
    #[inline]
    pub fn light_sample_density(
        &self,
        shapes: &impl Shapes,
        from: &LightSampleContext,
        start: &Emission,
    ) -> f32 {
        let probability = || self.selector.probability(from, start.light);
        match start.origin {
            LightKind::Surface => {
                let density = self.get(start.light).density(shapes, from, &start.point);
                density.hero() * probability()
            }
            LightKind::Sky => {
                let toward = -start.ray.direction;
                self.background_density(from, toward).hero()
            }
            LightKind::Point | LightKind::Parallel => probability(),
            LightKind::Beam | LightKind::Medium => 0.0,
        }
    }
}
