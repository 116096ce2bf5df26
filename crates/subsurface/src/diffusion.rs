//! Diffusion profiles: subsurface scattering as a function of the distance between entry and exit.
//!
//! They assume a flat surface of a half-space (`multidipole`: of a slab) of homogeneous matter: fast, but biased. The contract is
//! [`etalon_transport::DiffusionProfile`].

use crate::HenyeyGreenstein;
use crate::anisotropic_dipole::{AnisotropicDipole, Grain};
use crate::beam_diffusion::{Beam, BeamDiffusion};
use crate::burley::Burley;
use crate::dipole::Dipole;
use crate::multipole::Multipole;
use crate::surface_albedo::{inside_boundary, of_half_space};
use core::f32::consts::FRAC_1_PI;
use etalon_math::fresnel;
use etalon_params::Params;
use etalon_transport::{Coefficients, DiffusionProfile, Exit};
use glam::Vec4;
use std::sync::Arc;

/// The share of the light beyond [`DiffusionProfile::reach`].
const BEYOND: f32 = 1e-4;

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
    fn surface_albedo(&self) -> f32 {
        let albedo = self.scattering / (self.absorption + self.scattering);
        of_half_space(albedo, self.g)
    }
}

/// A profile at one wavelength; lengths in m.
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

/// The list of profiles.
#[derive(Clone, Debug)]
pub enum Profile {
    /// See [`crate::dipole`].
    Dipole,
    /// See [`crate::beam_diffusion`].
    BeamDiffusion(Arc<BeamDiffusion>),
    /// See [`crate::burley`].
    Burley,
    /// See [`crate::multipole`].
    Multipole {
        /// The thickness of the slab (m).
        thickness: f32,
    },
    /// See [`crate::anisotropic_dipole`].
    AnisotropicDipole(Grain),
}

impl PartialEq for Profile {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::BeamDiffusion(a), Self::BeamDiffusion(b)) => Arc::ptr_eq(a, b),
            (Self::Multipole { thickness: a }, Self::Multipole { thickness: b }) => a == b,
            (Self::AnisotropicDipole(a), Self::AnisotropicDipole(b)) => a == b,
            _ => core::mem::discriminant(self) == core::mem::discriminant(other),
        }
    }
}

impl Profile {
    /// Names of the profiles that are built.
    pub const BUILT: [&'static str; 5] = [
        "dipole",
        "beamdiffusion",
        "burley",
        "multidipole",
        "adipole",
    ];

    /// The profile that a plugin is, for a medium with this mean cosine below this boundary.
    pub fn from_params(params: &Params<'_>, g: f32, boundary: &Boundary) -> Option<Self> {
        match params.node.plugin.value.as_str() {
            "multidipole" => {
                let what = "a finite number above 0";
                let thickness =
                    params.float_where("thickness", 1.0, what, |d| d > 0.0 && d.is_finite());
                Some(Self::Multipole {
                    thickness: thickness as f32,
                })
            }
            "adipole" => Grain::from_params(params).map(Self::AnisotropicDipole),
            name => Self::of_half_space(name, g, boundary),
        }
    }

    /// A profile that has no parameters of its own.
    fn of_half_space(name: &str, g: f32, boundary: &Boundary) -> Option<Self> {
        match name {
            "dipole" => Some(Self::Dipole),
            "burley" => Some(Self::Burley),
            "beamdiffusion" => {
                let phase = HenyeyGreenstein::new(g)?;
                let table = BeamDiffusion::new(&phase, boundary.eta.unwrap_or(1.0));
                Some(Self::BeamDiffusion(Arc::new(table)))
            }
            _ => None,
        }
    }

    /// The profile of matter with these coefficients.
    pub(crate) fn at(
        &self,
        coefficients: &Coefficients,
        g: f32,
        boundary: Boundary,
    ) -> ProfileAt<'_> {
        let lane = |i: usize| {
            let matter = Matter {
                absorption: coefficients.absorption[i].max(1e-12),
                scattering: coefficients.scattering[i],
                g,
            };
            match self {
                Self::Dipole => Lane::Dipole(Dipole::new(&matter, boundary.inside)),
                Self::BeamDiffusion(table) => Lane::BeamDiffusion(table.of(&matter)),
                Self::Burley => {
                    let albedo = inside_boundary(matter.surface_albedo(), boundary.inside);
                    let length = 1.0 / matter.reduced();
                    Lane::Burley(Burley::new(albedo, length, boundary.eta.is_none()))
                }
                Self::Multipole { thickness } => {
                    Lane::Multipole(Multipole::new(&matter, boundary.inside, *thickness))
                }
                Self::AnisotropicDipole(grain) => Lane::AnisotropicDipole(AnisotropicDipole::new(
                    grain,
                    matter.absorption,
                    matter.scattering,
                    boundary.inside,
                )),
            }
        };
        let lanes = [0, 1, 2, 3].map(lane);
        ProfileAt {
            totals: Vec4::from_array(lanes.map(|lane| lane.radial().total())),
            lanes,
            boundary,
        }
    }

    /// Total exitant flux by this profile, and by the exact albedo of a half-space, per lane: the difference is the bias. `None` for those
    /// of other matter.
    pub fn bias(
        &self,
        coefficients: &Coefficients,
        g: f32,
        boundary: Boundary,
    ) -> Option<[Vec4; 2]> {
        if matches!(self, Self::Multipole { .. } | Self::AnisotropicDipole(_)) {
            return None;
        }
        let exact = |i: usize| {
            let matter = Matter {
                absorption: coefficients.absorption[i],
                scattering: coefficients.scattering[i],
                g,
            };
            inside_boundary(matter.surface_albedo(), boundary.inside)
        };
        let exact = Vec4::from_array([0, 1, 2, 3].map(exact));
        Some([self.at(coefficients, g, boundary).totals, exact])
    }
}

/// Any profile at one wavelength.
#[derive(Clone, Copy, Debug)]
enum Lane<'a> {
    Dipole(Dipole),
    BeamDiffusion(Beam<'a>),
    Burley(Burley),
    Multipole(Multipole),
    AnisotropicDipole(AnisotropicDipole),
}

impl Lane<'_> {
    /// By which distances are chosen: most profiles are functions of the distance alone.
    fn radial(&self) -> &dyn Radial {
        match self {
            Self::Dipole(profile) => profile,
            Self::BeamDiffusion(profile) => profile,
            Self::Burley(profile) => profile,
            Self::Multipole(profile) => &profile.nearest,
            Self::AnisotropicDipole(profile) => &profile.widths,
        }
    }

    fn value(&self, exit: &Exit) -> f32 {
        match self {
            Self::Multipole(profile) => profile.value(exit),
            Self::AnisotropicDipole(profile) => profile.value(exit),
            Self::Dipole(_) | Self::BeamDiffusion(_) | Self::Burley(_) => {
                self.radial().value(exit.offset.length())
            }
        }
    }

    /// The distance within which the share `share` of the light leaves.
    fn reach(&self, share: f32) -> f32 {
        match self {
            Self::Multipole(profile) => profile.reach(share),
            _ => self.radial().sample(share),
        }
    }
}

/// A profile at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct ProfileAt<'a> {
    lanes: [Lane<'a>; 4],
    /// ∫ R 2πr dr, per lane.
    totals: Vec4,
    boundary: Boundary,
}

impl DiffusionProfile for ProfileAt<'_> {
    fn value(&self, exit: &Exit) -> Vec4 {
        Vec4::from_array(self.lanes.map(|lane| lane.value(exit)))
    }

    fn density(&self, distance: f32) -> Vec4 {
        let some = self.totals.cmpgt(Vec4::ZERO);
        let values = Vec4::from_array(self.lanes.map(|lane| lane.radial().value(distance)));
        Vec4::select(some, values / self.totals, Vec4::ZERO)
    }

    fn sample(&self, u: f32) -> Option<f32> {
        (self.totals.x > 0.0).then(|| self.lanes[0].radial().sample(u))
    }

    fn reach(&self) -> f32 {
        let far = |lane: Lane<'_>| lane.reach(1.0 - BEYOND);
        self.lanes.map(far).into_iter().fold(0.0, f32::max)
    }

    fn leaving(&self, cos: f32) -> f32 {
        match self.boundary.eta {
            None => FRAC_1_PI,
            Some(eta) => {
                // c = 1 − Fₑ, of diffuse light from outside.
                let passing = (1.0 - self.boundary.inside) * eta * eta;
                (1.0 - fresnel::dielectric(cos, eta).0) * FRAC_1_PI / passing
            }
        }
    }

    fn relative_index(&self) -> f32 {
        self.boundary.eta.unwrap_or(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF_SPACES: [&str; 3] = ["dipole", "beamdiffusion", "burley"];
    const GLASSY: Boundary = Boundary {
        eta: Some(1.3),
        inside: 0.4726,
    };
    const OPEN: Boundary = Boundary {
        eta: None,
        inside: 0.0,
    };

    /// 2πr R integrates to the total, and samples are distributed by it: of each twentieth of the light as much is found within as
    /// without (midpoints in ln r, to 0.5 %).
    #[test]
    fn distances_are_chosen_as_light_leaves() {
        let coefficients = Coefficients {
            absorption: Vec4::new(0.001, 0.1, 0.5, 1.0),
            scattering: Vec4::new(1.0, 1.0, 0.5, 0.1),
        };
        for (name, boundary) in HALF_SPACES
            .into_iter()
            .flat_map(|n| [(n, GLASSY), (n, OPEN)])
        {
            let profile = Profile::of_half_space(name, 0.3, &boundary).expect("built");
            let at = profile.at(&coefficients, 0.3, boundary);
            for (index, lane) in at.lanes.iter().enumerate() {
                let radial = lane.radial();
                let count = 20_000;
                let mut chosen: Vec<f32> = (0..count)
                    .map(|i| radial.sample((i as f32 + 0.5) / count as f32))
                    .collect();
                chosen.sort_by(f32::total_cmp);
                let (mut sum, steps) = (0.0_f64, 200_000);
                let mut next = 1;
                for i in 0..steps {
                    let r = 1e-5
                        * etalon_math::float64::pow(1e10, (f64::from(i) + 0.5) / f64::from(steps));
                    let width = r * 10.0 * std::f64::consts::LN_10 / f64::from(steps);
                    sum += std::f64::consts::TAU * r * f64::from(radial.value(r as f32)) * width;
                    if next < 20 && r >= f64::from(chosen[next * count / 20]) {
                        let share = sum / f64::from(radial.total());
                        let expected = next as f64 / 20.0;
                        assert!(
                            (share - expected).abs() < 5e-3,
                            "{name} {index}: {share} {expected}"
                        );
                        next += 1;
                    }
                }
                let off = sum / f64::from(radial.total()) - 1.0;
                assert!(off.abs() < 5e-3, "{name} {boundary:?} {index}: {off}");
            }
        }
    }

    /// No profile gives back more than has entered, matter that absorbs nothing gives back nearly all, and each is near the albedo
    /// of a half-space where scattering prevails.
    #[test]
    fn what_leaves_is_near_the_albedo_of_a_half_space() {
        let coefficients = Coefficients {
            absorption: Vec4::new(0.0, 0.001, 0.01, 0.1),
            scattering: Vec4::ONE,
        };
        for (name, boundary) in HALF_SPACES
            .into_iter()
            .flat_map(|n| [(n, GLASSY), (n, OPEN)])
        {
            let profile = Profile::of_half_space(name, 0.0, &boundary).expect("built");
            let [found, exact] = (profile.bias(&coefficients, 0.0, boundary)).expect("known");
            let off = (found / exact - 1.0).abs();
            assert!(found.max_element() <= 1.0001, "{name}: {found}");
            assert!(
                off.max_element() < 0.25 && off.x < 0.05,
                "{name} {boundary:?}: {found} {exact}"
            );
        }
    }
}
