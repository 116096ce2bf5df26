//! `dipole`: light below a surface as if it came from a source in the matter and one, negative, mirrored above it,
//!
//! ```text
//! R(r) = α'/4π Σ z (σtr + 1/d) e^(−σtr d) / d²       over z = zᵣ, zᵥ with d² = r² + z²
//! zᵣ = 1/σ't,   zᵥ = zᵣ (1 + 4/3 A),   A = (1 + F)/(1 − F),   σtr = √(3 σa σ't)
//! ```
//!
//! with σ's = (1 − g) σs, σ't = σa + σ's, α' = σ's/σ't and F the reflectance of the boundary for diffuse light from inside (H. W. Jensen,
//! S. R. Marschner, M. Levoy, P. Hanrahan, A practical model for subsurface light transport, 2001, eqs. 3 and 4). What
//! leaves beyond a distance is known in closed form, ½α' Σ z e^(−σtr d)/d, and inverted by Newton's method.

use crate::profile_model::{Boundary, Matter, ProfileModel, Radial};
use core::f32::consts::PI;
use etalon_math::float;

/// The profile of any matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffusionDipole;

impl ProfileModel for DiffusionDipole {
    type Lane<'a> = Dipole;
    const OF_HALF_SPACE: bool = true;

    fn at(&self, matter: &Matter, boundary: &Boundary) -> Dipole {
        Dipole::new(matter, boundary.inside)
    }
}

/// A profile at one wavelength.
#[derive(Clone, Copy, Debug)]
pub struct Dipole {
    /// α'.
    pub(crate) albedo: f32,
    /// σtr (m⁻¹).
    pub(crate) transport: f32,
    /// zᵣ and zᵥ (m).
    pub(crate) depths: [f32; 2],
}

/// Two dipoles with the flux of each, by which profiles without an inverse of their own choose distances.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DipolePair {
    parts: [Dipole; 2],
    fluxes: [f32; 2],
}

impl DipolePair {
    pub(crate) fn new(parts: [Dipole; 2], fluxes: [f32; 2]) -> Self {
        let some = |i: usize| {
            if parts[i].total() > 0.0 {
                fluxes[i]
            } else {
                0.0
            }
        };
        Self {
            parts,
            fluxes: [some(0), some(1)],
        }
    }
}

impl Radial for DipolePair {
    fn value(&self, r: f32) -> f32 {
        let part = |i: usize| match self.fluxes[i] > 0.0 {
            true => self.fluxes[i] * self.parts[i].value(r) / self.parts[i].total(),
            false => 0.0,
        };
        part(0) + part(1)
    }

    fn total(&self) -> f32 {
        self.fluxes[0] + self.fluxes[1]
    }

    fn sample(&self, u: f32) -> f32 {
        let first = self.fluxes[0] / self.total();
        match u < first {
            true => self.parts[0].sample(u / first),
            false => self.parts[1].sample((u - first) / (1.0 - first)),
        }
    }
}

impl Dipole {
    /// The profile of a medium below a boundary with the reflectance `inside` for diffuse light from inside.
    pub(crate) fn new(matter: &Matter, inside: f32) -> Self {
        let reduced = matter.reduced();
        let depth = 1.0 / reduced;
        let a = (1.0 + inside) / (1.0 - inside);
        Self {
            albedo: (1.0 - matter.g) * matter.scattering / reduced,
            transport: float::safe_sqrt(3.0 * matter.absorption * reduced),
            depths: [depth, depth * (1.0 + 4.0 / 3.0 * a)],
        }
    }

    /// The light of each source that leaves anywhere, over ½α'.
    fn shares(&self) -> [f32; 2] {
        self.depths.map(|z| float::exp(-self.transport * z))
    }

    /// The d beyond which the share `u` of the flux from the source at `z` leaves: with y = ln(d/z), σtr z eʸ + y = σtr z − ln u.
    fn beyond(&self, z: f32, u: f32) -> f32 {
        let (depth, falls) = (self.transport * z, -float::ln(u));
        let target = depth + falls;
        // The left side is convex, and the root not above this, so that Newton's method comes down to it.
        let mut y = falls.min(float::ln(target / depth.max(1e-20)));
        for _ in 0..8 {
            let grown = depth * float::exp(y);
            y -= (grown + y - target) / (grown + 1.0);
        }
        z * float::exp(y.max(0.0))
    }
}

/// The flux (m⁻²) through a plane at the height `z` over a source of the flux 4π, at the distance `d` from it.
pub(crate) fn flux(transport: f32, z: f32, d: f32) -> f32 {
    z * (transport + 1.0 / d) * float::exp(-transport * d) / (d * d)
}

impl Radial for Dipole {
    fn value(&self, r: f32) -> f32 {
        let part = |z: f32| flux(self.transport, z, (r * r + z * z).sqrt());
        self.albedo / (4.0 * PI) * self.depths.map(part).iter().sum::<f32>()
    }

    fn total(&self) -> f32 {
        0.5 * self.albedo * self.shares().iter().sum::<f32>()
    }

    fn sample(&self, u: f32) -> f32 {
        let [near, far] = self.shares();
        let real = near / (near + far);
        let (z, u) = if u < real {
            (self.depths[0], u / real)
        } else {
            (self.depths[1], (u - real) / (1.0 - real))
        };
        let d = self.beyond(z, (1.0 - u).max(1e-7));
        float::safe_sqrt(d * d - z * z)
    }
}
