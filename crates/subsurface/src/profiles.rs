//! The list of diffusion profiles, and how each is read.

use crate::anisotropic_dipole::Grain;
use crate::beam_diffusion::BeamDiffusion;
use crate::burley::NormalisedDiffusion;
use crate::dipole::DiffusionDipole;
use crate::multipole::Slab;
use crate::profile_model::{Boundary, LaneProfile, Matter, ProfileModel, Radial};
use crate::surface_albedo::inside_boundary;
use core::f32::consts::FRAC_1_PI;
use etalon_math::fresnel;
use etalon_params::Params;
use etalon_transport::{Coefficients, DiffusionProfile, Exit};
use glam::Vec4;

/// The share of the light beyond [`DiffusionProfile::reach`].
const BEYOND: f32 = 1e-4;

macro_rules! profiles {
    ($($(#[doc = $doc:literal])* $plugin:literal => $kind:ident: $read:expr;)*) => {
        /// Any diffusion profile.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Profile {
            $($(#[doc = $doc])* $kind($kind),)*
        }

        impl Profile {
            /// Names of the profiles that are built.
            pub const BUILT: &[&str] = &[$($plugin,)*];

            /// The profile that a plugin is, for a medium with this mean cosine below this boundary.
            pub fn from_params(params: &Params<'_>, g: f32, boundary: &Boundary) -> Option<Self> {
                match params.node.plugin.value.as_str() {
                    $($plugin => {
                        let read: fn(&Params<'_>, f32, &Boundary) -> Option<$kind> = $read;
                        read(params, g, boundary).map(Self::$kind)
                    })*
                    _ => None,
                }
            }

            fn lane(&self, matter: &Matter, boundary: &Boundary) -> Lane<'_> {
                match self { $(Self::$kind(profile) => Lane::$kind(profile.at(matter, boundary)),)* }
            }

            fn is_of_half_space(&self) -> bool {
                match self { $(Self::$kind(_) => $kind::OF_HALF_SPACE,)* }
            }
        }

        /// Any profile at one wavelength.
        #[derive(Clone, Copy, Debug)]
        enum Lane<'a> {
            $($kind(<$kind as ProfileModel>::Lane<'a>),)*
        }

        impl LaneProfile for Lane<'_> {
            fn radial(&self) -> &dyn Radial {
                match self { $(Self::$kind(profile) => profile.radial(),)* }
            }

            fn exitance(&self, exit: &Exit) -> f32 {
                match self { $(Self::$kind(profile) => profile.exitance(exit),)* }
            }

            fn reach(&self, share: f32) -> f32 {
                match self { $(Self::$kind(profile) => profile.reach(share),)* }
            }
        }
    };
}

// The list: a line for each profile.
profiles! {
    /// A source and its image.
    "dipole" => DiffusionDipole: |_, _, _| Some(DiffusionDipole);
    /// Sources all along the way down.
    "beamdiffusion" => BeamDiffusion: |_, g, boundary| BeamDiffusion::below(g, boundary);
    /// Two exponentials.
    "burley" => NormalisedDiffusion: |_, _, _| Some(NormalisedDiffusion);
    /// Of a slab.
    "multidipole" => Slab: |params, _, _| Some(Slab::from_params(params));
    /// Of flakes.
    "adipole" => Grain: |params, _, _| Grain::from_params(params);
}

impl Profile {
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
            self.lane(&matter, &boundary)
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
        if !self.is_of_half_space() {
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
        Vec4::from_array(self.lanes.map(|lane| lane.exitance(exit)))
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

    /// Profiles of half-spaces, with their names.
    fn half_spaces(g: f32, boundary: &Boundary) -> [(&'static str, Profile); 3] {
        let beam = BeamDiffusion::below(g, boundary).expect("a mean cosine");
        [
            ("dipole", Profile::DiffusionDipole(DiffusionDipole)),
            ("beamdiffusion", Profile::BeamDiffusion(beam)),
            ("burley", Profile::NormalisedDiffusion(NormalisedDiffusion)),
        ]
    }

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
        let all = [GLASSY, OPEN].into_iter().flat_map(|boundary| {
            half_spaces(0.3, &boundary).map(|(name, profile)| (name, profile, boundary))
        });
        for (name, profile, boundary) in all {
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
        let all = [GLASSY, OPEN].into_iter().flat_map(|boundary| {
            half_spaces(0.0, &boundary).map(|(name, profile)| (name, profile, boundary))
        });
        for (name, profile, boundary) in all {
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
