//! Phase functions of one angle, sampled exactly by inverting their distribution function.

use crate::phases::{PhaseModel, PhasePoint};
use crate::{Draine, HenyeyGreenstein, Isotropic, Rayleigh, Tabulated};
use etalon_math::{Density, Frame, SolidAngle, float};
use etalon_transport::{PhaseSample, Textures};
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

/// A phase function of μ = cos of the angle between the direction of travel and `wi`.
pub(crate) trait Rotational {
    /// p(μ) in sr⁻¹.
    fn value(&self, mu: f32) -> f32;
    /// The μ below which a share `u` of the light is scattered.
    fn inverse(&self, u: f32) -> f32;
}

/// The direction into which light that travels along −`wo` turns, by an angle with the cosine `mu`, about its way by `u` in
/// [0, 1).
pub(crate) fn turned(wo: Vec3, mu: f32, u: f32) -> Vec3 {
    let sine = float::safe_sqrt(1.0 - mu * mu);
    let (sin, cos) = float::sin_cos(2.0 * PI * u);
    Frame::from_normal(-wo).to_world(Vec3::new(sine * cos, sine * sin, mu))
}

/// Samples a rotational phase function.
pub(crate) fn sample(phase: &impl Rotational, wo: Vec3, u: Vec2) -> PhaseSample {
    let mu = phase.inverse(u.x).clamp(-1.0, 1.0);
    let value = phase.value(mu);
    PhaseSample {
        wi: turned(wo, mu, u.y),
        value: Vec4::splat(value),
        density: Density::uniform(value),
    }
}

/// Makes rotational functions phase functions.
macro_rules! phases {
    ($($name:ty),*) => {
        $(impl PhaseModel for $name {
            #[inline]
            fn eval(&self, _: &PhasePoint<'_, impl Textures>, wo: Vec3, wi: Vec3) -> Vec4 {
                Vec4::splat(self.value(-wo.dot(wi)))
            }

            #[inline]
            fn density(
                &self,
                _: &PhasePoint<'_, impl Textures>,
                wo: Vec3,
                wi: Vec3,
            ) -> Density<SolidAngle> {
                Density::uniform(self.value(-wo.dot(wi)))
            }

            #[inline]
            fn sample(&self, _: &PhasePoint<'_, impl Textures>, wo: Vec3, u: Vec2) -> PhaseSample {
                sample(self, wo, u)
            }
        })*
    };
}

phases!(Draine, HenyeyGreenstein, Isotropic, Rayleigh, Tabulated);

/// Holds a phase function to account, deterministically: it integrates to one, and the density
/// of the sampled μ (the derivative of the inverse) is its value.
#[cfg(test)]
pub(crate) fn check(phase: &impl Rotational) {
    const N: u32 = 20_000;
    let integral: f64 = (0..N)
        .map(|i| {
            let mu = -1.0 + 2.0 * (i as f32 + 0.5) / N as f32;
            f64::from(phase.value(mu)) * 4.0 * std::f64::consts::PI / f64::from(N)
        })
        .sum();
    assert!((integral - 1.0).abs() < 2e-4, "integral {integral}");
    for i in 1..100 {
        let u = i as f32 / 100.0;
        let step = 1e-3;
        let slope = (phase.inverse(u + step) - phase.inverse(u - step)) / (2.0 * step);
        // p(μ)·2π·dμ = du
        let density = phase.value(phase.inverse(u)) * 2.0 * PI;
        assert!(
            (density * slope - 1.0).abs() < 0.02,
            "u = {u}: {}",
            density * slope
        );
    }
    let wo = Vec3::new(0.6, 0.0, 0.8);
    let sample = sample(phase, wo, Vec2::new(0.3, 0.7));
    assert!((sample.wi.length() - 1.0).abs() < 1e-6);
    let again = phase.value(-wo.dot(sample.wi));
    assert!((again / sample.value.x - 1.0).abs() < 1e-3);
    assert_eq!(sample.density.lanes(), sample.value);
}
