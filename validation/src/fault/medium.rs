//! A medium that may emit too much, whether a path flies through it or asks what a point of it emits.

use etalon_sampling::Sampler;
use etalon_transport::{Coefficients, FreeFlight, Medium, Ray, SurfaceInteraction, Transmission};
use glam::{Vec3, Vec4};

/// A medium whose emission is multiplied.
#[derive(Clone, Copy)]
pub struct FaultyMedium<M> {
    pub(super) medium: M,
    /// The factor on its emission.
    pub(super) energy: f32,
}

impl<M: Medium> Medium for FaultyMedium<M> {
    type Phase = M::Phase;
    type Profile = M::Profile;

    fn coefficients(&self, at: Vec3, direction: Vec3) -> Coefficients {
        self.medium.coefficients(at, direction)
    }

    fn phase(&self, at: Vec3) -> Self::Phase {
        self.medium.phase(at)
    }

    fn emission(&self, at: Vec3, direction: Vec3) -> Vec4 {
        self.energy * self.medium.emission(at, direction)
    }

    fn free_flight(
        &self,
        ray: &Ray,
        t_max: f32,
        u: f32,
        stream: &mut impl Sampler,
    ) -> FreeFlight<Self::Phase> {
        let flight = self.medium.free_flight(ray, t_max, u, stream);
        FreeFlight {
            emitted: self.energy * flight.emitted,
            ..flight
        }
    }

    fn reach(&self, ray: &Ray, u: f32) -> Option<f32> {
        self.medium.reach(ray, u)
    }

    fn transmittance(&self, ray: &Ray, t_max: f32, stream: &mut impl Sampler) -> Transmission {
        self.medium.transmittance(ray, t_max, stream)
    }

    fn is_dark(&self) -> bool {
        self.medium.is_dark()
    }

    fn diffusion(&self, at: &SurfaceInteraction) -> Option<Self::Profile> {
        self.medium.diffusion(at)
    }
}
