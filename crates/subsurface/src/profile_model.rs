//! Diffusion profiles: subsurface scattering as a function of the distance between entry and exit.
//!
//! They assume a flat surface of a half-space (`multidipole`: of a slab) of homogeneous matter: fast, but biased. What one of them must
//! say is here; [`crate::profiles`] lists them, and makes of them what integrators see ([`etalon_transport::DiffusionProfile`]).

use crate::surface_albedo::of_half_space;
use etalon_transport::Exit;

/// Coefficients of a medium below a surface, at one wavelength.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Matter {
    /// σa (m⁻¹).
    pub(crate) absorption: f32,
    /// σs (m⁻¹).
    pub(crate) scattering: f32,
    /// The mean cosine of the angle of scattering.
    pub(crate) g: f32,
}

impl Matter {
    /// σ't = σa + (1 − g) σs.
    pub(crate) fn reduced(&self) -> f32 {
        self.absorption + (1.0 - self.g) * self.scattering
    }

    /// A of a half-space without a boundary.
    pub(crate) fn surface_albedo(&self) -> f32 {
        let albedo = self.scattering / (self.absorption + self.scattering);
        of_half_space(albedo, self.g)
    }
}

/// A profile of the distance alone, at one wavelength; lengths in m.
pub(crate) trait Radial {
    /// R (m⁻²).
    fn value(&self, r: f32) -> f32;
    /// ∫ R 2πr dr.
    fn total(&self) -> f32;
    /// The distance within which the share `u` of the light leaves, or any other way to choose with that density.
    fn sample(&self, u: f32) -> f32;
}

/// The boundary above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary {
    /// The index inside over that outside, of a dielectric; `None` for one that lets all light pass, in all directions alike.
    pub eta: Option<f32>,
    /// The share of diffuse light from inside that it reflects.
    pub inside: f32,
}

/// A profile as scenes describe it, for any matter.
pub(crate) trait ProfileModel {
    /// The same at one wavelength.
    type Lane<'a>: LaneProfile
    where
        Self: 'a;

    /// Whether it is one of a half-space of isotropic matter, whose exact albedo is known.
    const OF_HALF_SPACE: bool;

    /// The profile of this matter below this boundary.
    fn at(&self, matter: &Matter, boundary: &Boundary) -> Self::Lane<'_>;
}

/// A profile at one wavelength.
pub(crate) trait LaneProfile {
    /// By which distances are chosen.
    fn radial(&self) -> &dyn Radial;

    /// What leaves at a point (m⁻²).
    fn exitance(&self, exit: &Exit) -> f32;

    /// The distance within which the share `share` of the light leaves (m).
    fn reach(&self, share: f32) -> f32;
}

impl<T: Radial> LaneProfile for T {
    fn radial(&self) -> &dyn Radial {
        self
    }

    fn exitance(&self, exit: &Exit) -> f32 {
        self.value(exit.offset.length())
    }

    fn reach(&self, share: f32) -> f32 {
        self.sample(share)
    }
}
