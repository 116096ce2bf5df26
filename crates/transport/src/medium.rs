//! The contract of a participating medium.
//!
//! ```text
//! T(t) = exp(−∫₀ᵗ σt ds),   σt = σa + σs
//! ```
//!
//! Lane 0 of the wavelengths chooses how far a flight goes. What has been chosen has a density for
//! every lane, had it been the one that chose, so that chromatic media are combined by multiple importance sampling
//! over the lanes (B. Miller, I. Georgiev, W. Jarosz, A null-scattering path integral formulation of light transport,
//! 2019, section 5).

use crate::{DiffusionProfile, MediumId, NoProfile, Phase, Ray, SurfaceInteraction, Transmission};
use etalon_sampling::Sampler;
use glam::{Vec3, Vec4};

/// The media on both sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MediumInterface {
    /// Where the geometric normal does not point.
    pub inside: MediumId,
    /// Where it points.
    pub outside: MediumId,
}

impl MediumInterface {
    /// Empty space on both sides.
    pub const NONE: Self = Self::within(MediumId::NONE);

    /// A surface within one medium.
    pub const fn within(medium: MediumId) -> Self {
        Self {
            inside: medium,
            outside: medium,
        }
    }

    /// The medium of a ray that leaves with this cosine to the geometric normal.
    #[inline]
    pub fn toward(&self, cos: f32) -> MediumId {
        if cos < 0.0 { self.inside } else { self.outside }
    }
}

/// What a medium does to light per unit of length (m⁻¹), per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// σa.
    pub absorption: Vec4,
    /// σs.
    pub scattering: Vec4,
}

impl core::ops::Mul<f32> for Coefficients {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f32) -> Self {
        Self {
            absorption: self.absorption * factor,
            scattering: self.scattering * factor,
        }
    }
}

impl Coefficients {
    /// σt.
    #[inline]
    pub fn extinction(&self) -> Vec4 {
        self.absorption + self.scattering
    }
}

/// A flight along a ray, to where light is scattered or to the ray's end.
///
/// Values and densities are relative to the density with which [`Medium::transmittance`] makes the same tentative
/// collisions on the way.
#[derive(Clone, Copy, Debug)]
pub struct FreeFlight<P> {
    /// What the flight does to the light, per lane: transmittance, and σs where it is scattered.
    pub factor: Vec4,
    /// The same with what the medium emits where the flight ends in place of σs: zero where it emits nothing.
    pub emitted: Vec4,
    /// The density of passing what lies in between, for each lane had it been the one that chose.
    pub passed: Vec4,
    /// Where and by what light is scattered, if it is.
    pub scattering: Option<Collision<P>>,
}

/// Where a flight ends in a medium.
#[derive(Clone, Copy, Debug)]
pub struct Collision<P> {
    /// How far (m).
    pub t: f32,
    /// σt there (m⁻¹): the density of ending there, for each lane.
    pub extinction: Vec4,
    /// The phase function there.
    pub phase: P,
}

impl<P> FreeFlight<P> {
    /// The density of the flight, for each lane had it been the one that chose.
    #[inline]
    pub fn density(&self) -> Vec4 {
        match &self.scattering {
            None => self.passed,
            Some(collision) => self.passed * collision.extinction,
        }
    }
}

/// A participating medium at a path's wavelengths: plain data that knows neither volumes nor scene.
pub trait Medium: Copy {
    /// How a point of it scatters light.
    type Phase: Phase + Copy;
    /// How light leaves near where it entered.
    type Profile: DiffusionProfile;

    /// The coefficients at a point, for light along `direction` either way.
    fn coefficients(&self, at: Vec3, direction: Vec3) -> Coefficients;

    /// The phase function at a point.
    fn phase(&self, at: Vec3) -> Self::Phase;

    /// σa Lₑ at a point: the radiance that a stretch of it emits along `direction`, per metre (W·m⁻³·sr⁻¹·nm⁻¹). Most emit nothing.
    fn emission(&self, at: Vec3, direction: Vec3) -> Vec4;

    /// Flies along `ray` up to `t_max`, with `u` for the first choice and a stream of random numbers for any number
    /// of others.
    fn free_flight(
        &self,
        ray: &Ray,
        t_max: f32,
        u: f32,
        stream: &mut impl Sampler,
    ) -> FreeFlight<Self::Phase>;

    /// How far a flight along `ray` with the number `u` goes if nothing ends the ray before: no surface beyond matters to it.
    /// `None` if that is not known before it has been flown.
    fn reach(&self, ray: &Ray, u: f32) -> Option<f32>;

    /// An estimate of the light that arrives at `t_max`.
    fn transmittance(&self, ray: &Ray, t_max: f32, stream: &mut impl Sampler) -> Transmission;

    /// Whether no light enters through null surfaces, so that light sampling in it is futile. `false` is a safe answer.
    fn is_dark(&self) -> bool;

    /// The diffusion profile that replaces random walks below the surface point `at`, if it has one.
    fn diffusion(&self, at: &SurfaceInteraction) -> Option<Self::Profile>;
}

/// The medium of worlds that have none; there is no value of it.
#[derive(Clone, Copy, Debug)]
pub enum Vacuum {}

impl Medium for Vacuum {
    type Phase = Self;
    type Profile = NoProfile;

    fn coefficients(&self, _: Vec3, _: Vec3) -> Coefficients {
        match *self {}
    }

    fn phase(&self, _: Vec3) -> Self {
        match *self {}
    }

    fn emission(&self, _: Vec3, _: Vec3) -> Vec4 {
        match *self {}
    }

    fn free_flight(&self, _: &Ray, _: f32, _: f32, _: &mut impl Sampler) -> FreeFlight<Self> {
        match *self {}
    }

    fn reach(&self, _: &Ray, _: f32) -> Option<f32> {
        match *self {}
    }

    fn transmittance(&self, _: &Ray, _: f32, _: &mut impl Sampler) -> Transmission {
        match *self {}
    }

    fn is_dark(&self) -> bool {
        match *self {}
    }

    fn diffusion(&self, _: &SurfaceInteraction) -> Option<NoProfile> {
        match *self {}
    }
}

impl Phase for Vacuum {
    fn eval(&self, _: Vec3, _: Vec3) -> Vec4 {
        match *self {}
    }

    fn density(&self, _: Vec3, _: Vec3) -> etalon_math::Density<etalon_math::SolidAngle> {
        match *self {}
    }

    fn sample(&self, _: Vec3, _: glam::Vec2) -> crate::PhaseSample {
        match *self {}
    }
}
