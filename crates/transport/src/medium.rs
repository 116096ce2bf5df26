//! The contract of a participating medium, and free flight through one.
//!
//! ```text
//! T(t) = exp(−∫₀ᵗ σt ds),   σt = σa + σs
//! ```
//!
//! A homogeneous medium is flown through in closed form: t from the density σt T(t). Any other by delta tracking
//! (E. Woodcock et al. 1965): tentative collisions come with a majorant σ̄ ≥ σt, constant along stretches of the ray; one is
//! real with the probability σt/σ̄, and null otherwise. Lane 0 of the wavelengths chooses both. What has been chosen has a density for
//! every lane, had it been the one that chose, so that chromatic media are combined by multiple importance sampling
//! over the lanes (B. Miller, I. Georgiev, W. Jarosz, A null-scattering path integral formulation of light transport,
//! 2019, section 5). Transmittance is estimated by ratio tracking (J. Novák, A. Selle, W. Jarosz 2014): the same
//! tentative collisions, all of them null. Residual tracking leaves the density of a control μ̄ ≤ σt, or any other, to the closed
//! form: collisions come with σ̄ − μ̄ in place of σ̄. See [`Tracking`].

use crate::flight::{self, Collisions};
use crate::{MediumId, Phase, Ray, Transmission};
use etalon_sampling::Sampler;
use glam::{Vec3, Vec4};

/// The media on both sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MediumInterface {
    /// The side away from the geometric normal.
    pub inside: MediumId,
    /// The side of the geometric normal.
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

/// Absorption and scattering coefficients of a medium (m⁻¹), per lane.
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
    /// Throughput of the flight, per lane: transmittance, times σs if it ends by scattering.
    pub factor: Vec4,
    /// The same with the emission at its end instead of σs; zero if the medium does not emit there.
    pub emitted: Vec4,
    /// Probability of no real collision before its end, for each lane had it been the one that chose.
    pub passed: Vec4,
    /// The real collision at its end; `None` if the flight reached the end of the ray.
    pub scattering: Option<Collision<P>>,
}

/// A real collision, where a flight ends in a medium.
#[derive(Clone, Copy, Debug)]
pub struct Collision<P> {
    /// Distance along the ray (m).
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

/// A stretch of a ray, from the end of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MajorantSegment {
    /// Its end (m along the ray).
    pub end: f32,
    /// σ̄ in it: not below the extinction of any lane (m⁻¹).
    pub majorant: f32,
    /// A part of that, below σ̄, which residual tracking treats in closed form; zero for all others (m⁻¹).
    pub control: f32,
}

/// How free flights and transmittance are estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Tracking {
    /// In closed form, for homogeneous media.
    Closed,
    /// Delta tracking for flights, ratio tracking for transmittance: tentative collisions at the rate σ̄.
    #[default]
    Ratio,
    /// Delta tracking for both: transmittance is all or nothing (Woodcock et al. 1965).
    Delta,
    /// Residual ratio tracking for transmittance (Novák et al. 2014): a control density μ̄ in closed form, and tentative
    /// collisions at the rate σ̄ − μ̄.
    Residual,
    /// Ray marching in steps of this length (m), with the coefficients at their midpoints: biased.
    RayMarching(f32),
}

/// A participating medium at a path's wavelengths: plain data that knows neither volumes nor scene.
pub trait Medium {
    /// The phase function at a point.
    type Phase: Phase + Copy;

    /// The stretches that cover `ray` up to `t_max`.
    fn majorants(&self, ray: &Ray, t_max: f32) -> impl Iterator<Item = MajorantSegment>;

    /// The coefficients at a point, for light along `direction` either way.
    fn coefficients(&self, at: Vec3, direction: Vec3) -> Coefficients;

    /// The phase function at a point.
    fn phase(&self, at: Vec3) -> Self::Phase;

    /// σa Lₑ at a point: the radiance that a stretch of it emits along `direction`, per metre (W·m⁻³·sr⁻¹·nm⁻¹). Most emit nothing.
    #[inline]
    fn emission(&self, _at: Vec3, _direction: Vec3) -> Vec4 {
        Vec4::ZERO
    }

    /// The method of tracking.
    #[inline]
    fn tracking(&self) -> Tracking {
        Tracking::Ratio
    }

    /// Flies along `ray` up to `t_max`, with `u` for the first choice and a stream of random numbers for any number
    /// of others.
    fn free_flight(
        &self,
        ray: &Ray,
        t_max: f32,
        u: f32,
        stream: &mut impl Sampler,
    ) -> FreeFlight<Self::Phase> {
        match self.tracking() {
            Tracking::Closed => return flight::closed(self, ray, t_max, u),
            Tracking::RayMarching(step) => return flight::marched(self, ray, t_max, step, u),
            Tracking::Ratio | Tracking::Delta | Tracking::Residual => {}
        }
        let mut flight = FreeFlight {
            factor: Vec4::ONE,
            emitted: Vec4::ZERO,
            passed: Vec4::ONE,
            scattering: None,
        };
        let mut collisions = Collisions::new(self.majorants(ray, t_max), t_max, u, false);
        while let Some(MajorantSegment {
            end: t,
            majorant,
            control,
        }) = collisions.next()
        {
            let at = ray.at(t);
            let coefficients = self.coefficients(at, ray.direction);
            let extinction = coefficients.extinction();
            if stream.next_1d() * majorant < extinction.x {
                let passed = flight::passing_control(collisions.controlled);
                flight.passed *= passed;
                flight.factor *= passed;
                flight.emitted = flight.factor * self.emission(at, ray.direction);
                flight.factor *= coefficients.scattering;
                flight.scattering = Some(Collision {
                    t,
                    extinction,
                    phase: self.phase(at),
                });
                return flight;
            }
            let null = flight::ratio(extinction, majorant, control);
            flight.factor *= null;
            flight.passed *= null;
            collisions.go_on(stream.next_1d());
        }
        let passed = flight::passing_control(collisions.controlled);
        flight.passed *= passed;
        flight.factor *= passed;
        flight
    }

    /// Length of the free flight along an unbounded `ray` for the number `u`: no surface beyond needs to be intersected.
    /// `None` if it is known only by tracking.
    #[inline]
    fn reach(&self, ray: &Ray, u: f32) -> Option<f32> {
        (self.tracking() == Tracking::Closed).then(|| {
            let coefficients = self.coefficients(ray.origin, ray.direction);
            flight::reach(coefficients.extinction(), u)
        })
    }

    /// An estimate of the transmittance up to `t_max`.
    fn transmittance(&self, ray: &Ray, t_max: f32, stream: &mut impl Sampler) -> Transmission {
        let closed = match self.tracking() {
            Tracking::Closed => {
                let extinction = self.coefficients(ray.origin, ray.direction).extinction();
                Some(flight::passing(extinction, t_max))
            }
            Tracking::RayMarching(step) => Some(flight::march(self, ray, t_max, step)),
            Tracking::Ratio | Tracking::Delta | Tracking::Residual => None,
        };
        if let Some(transmittance) = closed {
            return Transmission {
                transmittance,
                probability: transmittance,
            };
        }
        let all_or_nothing = self.tracking() == Tracking::Delta;
        let mut ratio = Vec4::ONE;
        // Probability of having survived the all-or-nothing choices.
        let mut kept = 1.0;
        let majorants = self.majorants(ray, t_max);
        let mut collisions = Collisions::new(majorants, t_max, stream.next_1d(), true);
        while let Some(MajorantSegment {
            end: t,
            majorant,
            control,
        }) = collisions.next()
        {
            let extinction = self.coefficients(ray.at(t), ray.direction).extinction();
            let null = flight::ratio(extinction, majorant, control);
            ratio *= null;
            if all_or_nothing {
                // By the lane that is attenuated least, so that no lane is lost.
                let most = null.max_element();
                if stream.next_1d() >= most {
                    ratio = Vec4::ZERO;
                } else {
                    kept *= most;
                }
            }
            if ratio == Vec4::ZERO {
                break;
            }
            collisions.go_on(stream.next_1d());
        }
        ratio *= flight::passing_control(collisions.controlled);
        Transmission {
            transmittance: ratio / kept,
            probability: ratio,
        }
    }
}

/// The medium of worlds that have none; there is no value of it.
#[derive(Clone, Copy, Debug)]
pub enum Vacuum {}

impl Medium for Vacuum {
    type Phase = Self;

    fn majorants(&self, _: &Ray, _: f32) -> impl Iterator<Item = MajorantSegment> {
        core::iter::empty()
    }

    fn coefficients(&self, _: Vec3, _: Vec3) -> Coefficients {
        match *self {}
    }

    fn phase(&self, _: Vec3) -> Self {
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
