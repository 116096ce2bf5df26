//! `burley`: normalised diffusion, a profile fitted to random walks,
//!
//! ```text
//! R(r) = A s (e^(−s r/ℓ) + e^(−s r/(3ℓ))) / (8π ℓ r)
//! s = 1.9 − A + 3.5 (A − 0.8)²       light enters in all directions alike
//! s = 1.85 − A + 7 |A − 0.8|³        it enters at a right angle
//! ```
//!
//! with the albedo A of the surface, and ℓ = 1/σ't (P. H. Christensen, B. Burley, Approximate reflectance profiles for efficient
//! subsurface scattering, 2015, eqs. 3, 5 and 6). 2πr R is a mixture of two exponential densities, which are sampled exactly.

use crate::profile_model::{Boundary, Matter, ProfileModel, Radial};
use crate::surface_albedo::inside_boundary;
use core::f32::consts::PI;
use etalon_math::float;

/// The profile of any matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalisedDiffusion;

impl ProfileModel for NormalisedDiffusion {
    type Lane<'a> = Burley;
    const OF_HALF_SPACE: bool = true;

    fn at(&self, matter: &Matter, boundary: &Boundary) -> Burley {
        let albedo = inside_boundary(matter.surface_albedo(), boundary.inside);
        Burley::new(albedo, 1.0 / matter.reduced(), boundary.eta.is_none())
    }
}

/// A profile at one wavelength.
#[derive(Clone, Copy, Debug)]
pub struct Burley {
    albedo: f32,
    /// s / ℓ (m⁻¹).
    rate: f32,
}

impl Burley {
    /// Of a surface of this albedo over matter with the mean free path `length` (m), which light enters in all directions alike if
    /// it is `diffuse`.
    pub(crate) fn new(albedo: f32, length: f32, diffuse: bool) -> Self {
        let off = (albedo - 0.8).abs();
        let s = match diffuse {
            true => 1.9 - albedo + 3.5 * off * off,
            false => 1.85 - albedo + 7.0 * off * off * off,
        };
        Self {
            albedo,
            rate: s / length,
        }
    }
}

impl Radial for Burley {
    fn value(&self, r: f32) -> f32 {
        let [narrow, wide] = [1.0, 1.0 / 3.0].map(|k| float::exp(-self.rate * r * k));
        self.albedo * self.rate * (narrow + wide) / (8.0 * PI * r)
    }

    fn total(&self) -> f32 {
        self.albedo
    }

    fn sample(&self, u: f32) -> f32 {
        let (u, rate) = if u < 0.25 {
            (4.0 * u, self.rate)
        } else {
            ((u - 0.25) / 0.75, self.rate / 3.0)
        };
        -float::ln((1.0 - u).max(1e-7)) / rate
    }
}
