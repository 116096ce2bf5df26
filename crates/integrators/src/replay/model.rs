//! A scattering model that answers as another does, and writes down what it said.

use super::Event;
use super::event_log::{Place, SharedEventLog};
use etalon_math::{Density, Frame, SolidAngle};
use etalon_transport::{Bsdf, BsdfSample, Mixture, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A scattering model that writes down what it says.
#[derive(Clone, Copy)]
pub(super) struct RecordingBsdf<'a, B> {
    pub(super) model: B,
    pub(super) place: Option<Place>,
    pub(super) notebook: &'a SharedEventLog,
}

impl<B> RecordingBsdf<'_, B> {
    fn evaluated(&self, wi: Vec3, value: Vec4, density: Option<Density<SolidAngle>>) {
        let event = Event::Evaluated {
            wi,
            value,
            density,
            mixture: None,
        };
        self.notebook
            .write(|notes| notes.ask(self.place, wi, event));
    }

    /// A direction was found that leads on from `place`.
    fn scattered(&self, place: Option<Place>, sample: Option<BsdfSample>) {
        let event = Event::Scattered {
            walk: place.map(|place| place.walk),
            sample,
            prefix: place.and_then(|place| place.prefix),
            mixture: None,
        };
        self.notebook.write(|notes| notes.scatter(place, event));
    }
}

impl<B: Bsdf> Bsdf for RecordingBsdf<'_, B> {
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4 {
        let value = self.model.eval(wo, wi, mode);
        self.evaluated(wi, value, None);
        value
    }

    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        self.model.density(wo, wi)
    }

    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        let (value, density) = self.model.eval_and_density(wo, wi, mode);
        self.evaluated(wi, value, Some(density));
        (value, density)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let sample = self.model.sample(wo, u_lobe, u, mode);
        let place = self.place.map(|place| place.extended(sample.as_ref()));
        self.scattered(place, sample);
        sample
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        let sample = self.model.discrete(wo, index, mode);
        if sample.is_some() {
            // All are followed: none has a probability by which to divide.
            let place = self.place.map(|place| Place {
                prefix: None,
                ..place
            });
            self.scattered(place, sample);
        }
        sample
    }

    fn has_continuous(&self) -> bool {
        self.model.has_continuous()
    }

    fn has_discrete(&self) -> bool {
        self.model.has_discrete()
    }

    fn hemisphere(&self) -> Option<Frame> {
        self.model.hemisphere()
    }

    fn null_transmittance(&self) -> Vec4 {
        self.model.null_transmittance()
    }

    fn null_probability(&self) -> Vec4 {
        self.model.null_probability()
    }

    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.model.albedo(wo)
    }

    fn projected_area(&self, direction: Vec3) -> f32 {
        self.model.projected_area(direction)
    }

    fn mixed(&self, mixture: impl FnOnce() -> Mixture) {
        let mixture = mixture();
        self.notebook.write(|notes| notes.mix(self.place, mixture));
    }
}
