//! `mie`: the phase function of spheres, such as droplets of a cloud, by [`Sphere`].
//!
//! Their radii r are spread such that ln r is normal about that of `radius` with the standard `deviation`; each sphere counts for
//! the light that it scatters,
//!
//! ```text
//! p(μ) ∝ ∫ (|S₁|² + |S₂|²)(r, μ) dN(r)
//! ```
//!
//! at 24 wavelengths, of which the nearest counts: one table each over 1201 cosines, denser towards both ends, linear in
//! between and scaled to 2π ∫ p dμ = 1. A path is scattered by the table of the wavelength that chooses.

use crate::phases::{PhaseModel, PhasePoint};
use crate::rotational::turned;
use crate::sphere::Sphere;
use core::f64::consts::{PI, TAU};
use etalon_math::{Density, SolidAngle, float64};
use etalon_params::Params;
use etalon_sampling::discrete::PiecewiseLinear;
use etalon_spectrum::{LAMBDA_MAX, LAMBDA_MIN};
use etalon_transport::{PhaseSample, Textures};
use glam::{Vec2, Vec3, Vec4};
use num_complex::Complex64;
use std::sync::Arc;

/// Tables.
const WAVELENGTHS: usize = 24;

/// Cosines of a table, less one.
const STEPS: usize = 1200;

/// Radii on either side of the middle, to three deviations.
const RADII: i32 = 8;

/// The phase function of spheres.
#[derive(Clone, Debug)]
pub struct Mie {
    /// Densities of μ, by wavelength.
    tables: Arc<[PiecewiseLinear]>,
    /// All that tells them from others.
    given: [f64; 5],
}

impl PartialEq for Mie {
    fn eq(&self, other: &Self) -> bool {
        self.given == other.given
    }
}

impl Mie {
    /// Of spheres with radii about `radius` (µm), with a standard `deviation` of the logarithm, of index `inside` + i
    /// `absorption` in a medium of index `outside`; `None` if the tables come to nothing.
    fn new(
        radius: f64,
        deviation: f64,
        inside: f64,
        absorption: f64,
        outside: f64,
    ) -> Option<Self> {
        // Denser in θ near 0 and π.
        let cosines: Vec<f64> = (0..=STEPS)
            .map(|i| {
                let t = i as f64 / STEPS as f64;
                -float64::cos(PI * t * t * (3.0 - 2.0 * t))
            })
            .collect();
        let index = Complex64::new(inside, absorption) / outside;
        let reach = if deviation > 0.0 { RADII } else { 0 };
        let table = |i: usize| {
            let range = LAMBDA_MAX - LAMBDA_MIN;
            let lambda = LAMBDA_MIN + range * (i as f64 + 0.5) / WAVELENGTHS as f64;
            let mut values = vec![0.0; cosines.len()];
            for step in -reach..=reach {
                let z = 3.0 * f64::from(step) / f64::from(RADII);
                let radius = radius * float64::exp(z * deviation);
                let sphere = Sphere::new(TAU * radius * outside * 1e3 / lambda, index);
                let weight = float64::exp(-0.5 * z * z);
                for (value, mu) in values.iter_mut().zip(&cosines) {
                    *value += weight * sphere.intensity(*mu);
                }
            }
            PiecewiseLinear::new(&cosines, &values).ok()
        };
        let tables: Option<Vec<PiecewiseLinear>> = (0..WAVELENGTHS).map(table).collect();
        Some(Self {
            tables: tables?.into(),
            given: [radius, deviation, inside, absorption, outside],
        })
    }

    /// Reads `radius`, `deviation`, `int_ior`, `ext_ior` and `absorption`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let within = |low: f64, high: f64| move |x: f64| x > low && x <= high;
        let radius = "a radius in µm, above 0 and at most 100";
        let radius = params.float_where("radius", 5.0, radius, within(0.0, 100.0));
        let deviation = "a number from 0 to 1";
        let deviation =
            params.float_where("deviation", 0.2, deviation, |x| (0.0..=1.0).contains(&x));
        let index = "an index of refraction, above 0 and at most 10";
        let inside = params.float_where("int_ior", 1.333, index, within(0.0, 10.0));
        let outside = params.float_where("ext_ior", 1.0, index, within(0.0, 10.0));
        let absorption = "the imaginary part of an index, from 0 to 10";
        let absorption =
            params.float_where("absorption", 0.0, absorption, |k| (0.0..=10.0).contains(&k));
        if inside == outside && absorption == 0.0 {
            params.error("spheres of the index of what is around them scatter nothing");
            return None;
        }
        let phase = Self::new(radius, deviation, inside, absorption, outside);
        if phase.is_none() {
            params.error("these spheres are too small to tell how they scatter");
        }
        phase
    }

    fn table(&self, lambda: f32) -> &PiecewiseLinear {
        let part = (f64::from(lambda) - LAMBDA_MIN) / (LAMBDA_MAX - LAMBDA_MIN);
        let place = part * WAVELENGTHS as f64;
        &self.tables[(place as usize).min(WAVELENGTHS - 1)]
    }

    /// p(μ) in sr⁻¹ at each wavelength.
    fn value(&self, mu: f64, lambda: Vec4) -> Vec4 {
        let mu = mu.clamp(-1.0, 1.0);
        Vec4::from_array(
            lambda
                .to_array()
                .map(|lambda| (self.table(lambda).density(mu) / TAU) as f32),
        )
    }
}

/// The cosine of the angle by which the direction of travel turns.
fn turn(wo: Vec3, wi: Vec3) -> f64 {
    -wo.as_dvec3().dot(wi.as_dvec3())
}

impl PhaseModel for Mie {
    fn eval(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, wi: Vec3) -> Vec4 {
        self.value(turn(wo, wi), at.lambda)
    }

    fn density(
        &self,
        at: &PhasePoint<'_, impl Textures>,
        wo: Vec3,
        wi: Vec3,
    ) -> Density<SolidAngle> {
        Density::per_lane(self.eval(at, wo, wi))
    }

    fn sample(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, u: Vec2) -> PhaseSample {
        let mu = self.table(at.lambda.x).sample(f64::from(u.x));
        let wi = turned(wo, mu.clamp(-1.0, 1.0) as f32, u.y);
        let value = self.eval(at, wo, wi);
        PhaseSample {
            wi,
            value,
            density: Density::per_lane(value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2π ∫ p dμ = 1 at every wavelength, and the μ below which a share of the light is scattered has that share below it. The
    /// mutant whose tables are of θ in place of μ misses by far.
    #[test]
    fn is_a_phase_function_at_every_wavelength() {
        let mie = Mie::new(5.0, 0.2, 1.333, 0.0, 1.0).expect("sound");
        assert_eq!(mie.tables.len(), WAVELENGTHS);
        for lambda in [360.0_f32, 500.0, 655.0, 830.0] {
            let table = mie.table(lambda);
            // In θ, where the peak is wide.
            let count = 100_000;
            let angle = |i: i32| PI * (f64::from(i) + 0.5) / f64::from(count);
            let part = |i: i32| table.density(float64::cos(angle(i))) * float64::sin(angle(i));
            let below = |share: f64| {
                let mu = table.sample(share);
                let beyond = (0..count).filter(|i| float64::cos(angle(*i)) < mu);
                beyond.map(part).sum::<f64>() * PI / f64::from(count)
            };
            for share in [0.1, 0.5, 0.9, 0.999_999] {
                assert!(
                    (below(share) - share).abs() < 2e-3,
                    "{lambda}, {share}: {}",
                    below(share)
                );
            }
        }
        // Droplets of a cloud send most light nearly straight on: half of it is diffraction.
        assert!(mie.table(550.0).sample(0.5) > 0.99);
        assert!(mie.value(1.0, Vec4::splat(550.0)).x > 100.0);
    }

    /// What is far smaller than the wavelength scatters as Rayleigh's, 3/(16π) (1 + μ²).
    #[test]
    fn small_spheres_scatter_as_molecules() {
        let mie = Mie::new(0.005, 0.0, 1.5, 0.0, 1.0).expect("sound");
        for mu in [-0.9, -0.3, 0.0, 0.6, 0.99] {
            let expected = 3.0 / (16.0 * PI) * (1.0 + mu * mu);
            let found = f64::from(mie.value(mu, Vec4::splat(550.0)).y);
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{mu}: {found} {expected}"
            );
        }
    }
}
