//! The contract of a participating medium, and free flight through one.
//!
//! ```text
//! T(t) = exp(−∫₀ᵗ σt ds),   σt = σa + σs
//! ```
//!
//! A homogeneous medium is flown through in closed form: t from the density σt T(t). Any other by delta tracking
//! (E. Woodcock et al. 1965): tentative collisions come with a constant majorant σ̄ ≥ σt; one is real with the
//! probability σt/σ̄, and null otherwise. Lane 0 of the wavelengths chooses both. What has been chosen has a density for
//! every lane, had it been the one that chose, so that chromatic media are combined by multiple importance sampling
//! over the lanes (B. Miller, I. Georgiev, W. Jarosz, A null-scattering path integral formulation of light transport,
//! 2019, section 5). Transmittance is estimated by ratio tracking (J. Novák, A. Selle, W. Jarosz 2014): the same
//! tentative collisions, all of them null.

use crate::{MediumId, Phase, Ray, Transmission};
use etalon_math::float;
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

impl Coefficients {
    /// σt.
    #[inline]
    pub fn extinction(&self) -> Vec4 {
        self.absorption + self.scattering
    }
}

/// A flight along a ray, to where light is scattered or to the ray's end.
#[derive(Clone, Copy, Debug)]
pub struct FreeFlight<P> {
    /// What the flight does to the light, per lane: transmittance, and σs where it is scattered.
    pub factor: Vec4,
    /// The density of the flight, for each lane had it been the one that chose.
    pub density: Vec4,
    /// The density with which [`Medium::transmittance`] would have made the same choices on the way, per lane.
    pub by_transmittance: Vec4,
    /// How far (m), and by what, if light is scattered.
    pub scattering: Option<(f32, P)>,
}

/// No flight makes more tentative collisions: one in a medium without end has to end.
const MOST_COLLISIONS: u32 = 1 << 20;

/// A participating medium at a path's wavelengths: plain data that knows neither volumes nor scene.
pub trait Medium {
    /// How a point of it scatters light.
    type Phase: Phase + Copy;

    /// σ̄: not below the extinction of any lane anywhere along `ray` up to `t_max` (m⁻¹).
    fn majorant(&self, ray: &Ray, t_max: f32) -> f32;

    /// The coefficients at a point.
    fn coefficients(&self, at: Vec3) -> Coefficients;

    /// The phase function at a point.
    fn phase(&self, at: Vec3) -> Self::Phase;

    /// Whether coefficients are the same everywhere, so that closed forms hold.
    fn is_homogeneous(&self) -> bool {
        false
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
        if self.is_homogeneous() {
            return homogeneous_flight(self, ray, t_max, u);
        }
        let majorant = self.majorant(ray, t_max);
        let mut flight = FreeFlight {
            factor: Vec4::ONE,
            density: Vec4::ONE,
            by_transmittance: Vec4::ONE,
            scattering: None,
        };
        let (mut t, mut number) = (0.0, u);
        for _ in 0..MOST_COLLISIONS {
            t += -float::ln(1.0 - number) / majorant;
            if !(t < t_max) {
                return flight;
            }
            let at = ray.at(t);
            let coefficients = self.coefficients(at);
            let extinction = coefficients.extinction();
            let null = (Vec4::splat(majorant) - extinction).max(Vec4::ZERO);
            let real = stream.next_1d() * majorant < extinction.x;
            let chosen = if real { extinction } else { null };
            let inverse = 1.0 / chosen.x;
            flight.factor *= if real { coefficients.scattering } else { null } * inverse;
            flight.density *= chosen * inverse;
            if real {
                flight.scattering = Some((t, self.phase(at)));
                return flight;
            }
            flight.by_transmittance *= majorant * inverse;
            number = stream.next_1d();
        }
        flight
    }

    /// An estimate of the light that arrives at `t_max`.
    fn transmittance(&self, ray: &Ray, t_max: f32, stream: &mut impl Sampler) -> Transmission {
        if self.is_homogeneous() {
            let transmittance = passing(self.coefficients(ray.origin).extinction(), t_max);
            return Transmission {
                transmittance,
                probability: transmittance,
            };
        }
        let majorant = self.majorant(ray, t_max);
        let (mut t, mut ratio) = (0.0, Vec4::ONE);
        for _ in 0..MOST_COLLISIONS {
            t += -float::ln(1.0 - stream.next_1d()) / majorant;
            if !(t < t_max) || ratio == Vec4::ZERO {
                break;
            }
            let extinction = self.coefficients(ray.at(t)).extinction();
            ratio *= (Vec4::ONE - extinction / majorant).max(Vec4::ZERO);
        }
        Transmission {
            transmittance: ratio,
            probability: ratio,
        }
    }
}

/// T over a distance, per lane.
#[inline]
fn passing(extinction: Vec4, t: f32) -> Vec4 {
    // An endless way through nothing is free.
    let depth = extinction * t.min(f32::MAX);
    Vec4::from_array(depth.to_array().map(|depth| float::exp(-depth)))
}

/// In closed form.
#[inline]
fn homogeneous_flight<M: Medium + ?Sized>(
    medium: &M,
    ray: &Ray,
    t_max: f32,
    u: f32,
) -> FreeFlight<M::Phase> {
    let coefficients = medium.coefficients(ray.origin);
    let extinction = coefficients.extinction();
    let t = -float::ln(1.0 - u) / extinction.x;
    // False where lane 0 is not attenuated, and for NaN.
    if t < t_max {
        let transmittance = passing(extinction, t);
        return FreeFlight {
            factor: transmittance * coefficients.scattering,
            density: transmittance * extinction,
            by_transmittance: Vec4::ONE,
            scattering: Some((t, medium.phase(ray.at(t)))),
        };
    }
    let transmittance = passing(extinction, t_max);
    FreeFlight {
        factor: transmittance,
        density: transmittance,
        by_transmittance: Vec4::ONE,
        scattering: None,
    }
}

/// The medium of worlds that have none; there is no value of it.
#[derive(Clone, Copy, Debug)]
pub enum Vacuum {}

impl Medium for Vacuum {
    type Phase = Self;

    fn majorant(&self, _: &Ray, _: f32) -> f32 {
        match *self {}
    }

    fn coefficients(&self, _: Vec3) -> Coefficients {
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
