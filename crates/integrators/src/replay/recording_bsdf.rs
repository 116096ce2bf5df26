//! A scattering model that answers as another does, and writes down what it said.

use super::log::{Place, SharedLog, chance, lanes, vector, walk};
use etalon_math::{Density, Frame, SolidAngle};
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, BsdfSample, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A scattering model that writes down what it says.
#[derive(Clone, Copy)]
pub(super) struct RecordingBsdf<'a, B> {
    pub(super) model: B,
    pub(super) wavelengths: Wavelengths,
    pub(super) place: Option<Place>,
    pub(super) log: &'a SharedLog<'a>,
}

impl<B> RecordingBsdf<'_, B> {
    /// The model was asked for a direction, along which the estimator may go on by itself.
    fn evaluated(&self, wi: Vec3, value: Vec4, density: Option<Density<SolidAngle>>) {
        let density = density.map_or_else(String::new, |density| {
            format!(", density {}", lanes(density.lanes()))
        });
        let mut log = self.log.write();
        log.wavelengths(&self.wavelengths);
        log.line(format!(
            "    toward {}: value {}{density}",
            vector(wi),
            lanes(value)
        ));
        if let Some(place) = self.place {
            log.may_go(place.after(None), wi);
        }
    }

    /// A direction was found that leads on to `place`.
    fn scattered(&self, place: Option<Place>, sample: Option<&BsdfSample>) {
        let mut log = self.log.write();
        log.wavelengths(&self.wavelengths);
        let walk = walk(place);
        let Some(s) = sample else {
            return log.line(format!("    {walk}scattering: absorbed"));
        };
        let how = match s.is_null {
            true => "passes straight",
            false => "scatters",
        };
        log.line(format!(
            "    {walk}{how} along {}, value {}, {}, eta {}",
            vector(s.wi),
            lanes(s.value),
            chance(s.chance),
            s.eta
        ));
        if let Some(place) = place {
            log.line(format!("    then {}", place.carried()));
            log.may_go(place, s.wi);
        }
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
        let step = sample.as_ref().map(|s| (s.value, s.chance));
        self.scattered(self.place.map(|place| place.after(step)), sample.as_ref());
        sample
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        let sample = self.model.discrete(wo, index, mode);
        if sample.is_some() {
            // All are followed: none has a probability by which to divide.
            let place = self.place.map(|place| place.after(None));
            self.scattered(place, sample.as_ref());
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
}
