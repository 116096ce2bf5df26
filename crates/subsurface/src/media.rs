//! The list of media, and how each is read.

use crate::phases::PhaseAt;
use crate::profiles::ProfileAt;
use crate::tracking::{self, Tracked, Tracking};
use crate::{Heterogeneous, HeterogeneousAt, Homogeneous, HomogeneousAt};
use etalon_params::{Params, plugins};
use etalon_sampling::Sampler;
use etalon_transport::{
    Build, Coefficients, FreeFlight, Medium, Ray, SurfaceInteraction, TexturePoint, Textures,
    Transmission,
};
use glam::{Vec3, Vec4};

macro_rules! media {
    ($($(#[doc = $doc:literal])* $plugin:literal => $kind:ident($at:ident);)*) => {
        /// Any medium, as the scene describes it.
        #[derive(Clone, Debug, PartialEq)]
        pub enum MediumDescription {
            $($(#[doc = $doc])* $kind($kind),)*
        }

        /// Any medium at the wavelengths of a path.
        #[derive(Debug)]
        pub enum MediumAtWavelengths<'a, T> {
            $($(#[doc = $doc])* $kind($at<'a, T>),)*
        }

        /// Names of the media that are built.
        pub const BUILT: &[&str] = &[$($plugin,)*];

        impl MediumDescription {
            fn read(params: &Params<'_>, build: &mut dyn Build) -> Option<Option<Self>> {
                match params.node.plugin.value.as_str() {
                    $($plugin => Some($kind::from_params(params, build).map(Self::$kind)),)*
                    _ => None,
                }
            }

            /// Whether it emits light.
            pub fn emits(&self) -> bool {
                match self { $(Self::$kind(medium) => medium.emits(),)* }
            }

            /// The corners of its bounding box; `None` if it fills its shape.
            pub fn bounds(&self) -> Option<[Vec3; 2]> {
                match self { $(Self::$kind(medium) => medium.bounds(),)* }
            }

            /// Says that no light enters it through null surfaces.
            pub fn darken(&mut self) {
                match self { $(Self::$kind(medium) => medium.is_dark = true,)* }
            }

            /// The medium at four wavelengths (nm), for a path that enters it at a point of its surface or is in it already.
            #[inline]
            pub fn enter<'a, T: Textures>(
                &'a self,
                at: Option<TexturePoint>,
                textures: &'a T,
                lambda: Vec4,
            ) -> MediumAtWavelengths<'a, T> {
                match self {
                    $(Self::$kind(medium) => {
                        MediumAtWavelengths::$kind(medium.enter(at, textures, lambda))
                    })*
                }
            }
        }

        impl<T> Clone for MediumAtWavelengths<'_, T> {
            #[inline]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<T> Copy for MediumAtWavelengths<'_, T> {}

        impl<'a, T: Textures> Medium for MediumAtWavelengths<'a, T> {
            type Phase = PhaseAt<'a, T>;
            type Profile = ProfileAt<'a>;

            #[inline]
            fn coefficients(&self, at: Vec3, direction: Vec3) -> Coefficients {
                match self { $(Self::$kind(medium) => medium.coefficients(at, direction),)* }
            }

            #[inline]
            fn phase(&self, at: Vec3) -> PhaseAt<'a, T> {
                match self { $(Self::$kind(medium) => medium.phase(at),)* }
            }

            #[inline]
            fn emission(&self, at: Vec3, direction: Vec3) -> Vec4 {
                match self { $(Self::$kind(medium) => medium.emission(at, direction),)* }
            }

            #[inline]
            fn free_flight(
                &self,
                ray: &Ray,
                t_max: f32,
                u: f32,
                stream: &mut impl Sampler,
            ) -> FreeFlight<PhaseAt<'a, T>> {
                match self { $(Self::$kind(medium) => tracking::free_flight(medium, ray, t_max, u, stream),)* }
            }

            #[inline]
            fn reach(&self, ray: &Ray, u: f32) -> Option<f32> {
                match self { $(Self::$kind(medium) => tracking::reach(medium, ray, u),)* }
            }

            #[inline]
            fn transmittance(
                &self,
                ray: &Ray,
                t_max: f32,
                stream: &mut impl Sampler,
            ) -> Transmission {
                match self { $(Self::$kind(medium) => tracking::transmittance(medium, ray, t_max, stream),)* }
            }

            #[inline]
            fn is_dark(&self) -> bool {
                match self { $(Self::$kind(medium) => medium.is_dark(),)* }
            }

            #[inline]
            fn diffusion(&self, at: &SurfaceInteraction) -> Option<ProfileAt<'a>> {
                match self { $(Self::$kind(medium) => medium.diffusion(at),)* }
            }
        }

        impl<T: Textures> MediumAtWavelengths<'_, T> {
            /// How it is travelled through.
            pub fn tracking(&self) -> Tracking {
                match self { $(Self::$kind(medium) => medium.tracking(),)* }
            }

            /// Transmittance in fixed steps (m), per lane.
            pub fn march(&self, ray: &Ray, t_max: f32, step: f32) -> Vec4 {
                match self { $(Self::$kind(medium) => tracking::march(medium, ray, t_max, step),)* }
            }
        }
    };
}

// The list: a line for each medium.
media! {
    /// The same everywhere.
    "homogeneous" => Homogeneous(HomogeneousAt);
    /// Varying in space.
    "heterogeneous" => Heterogeneous(HeterogeneousAt);
}

impl MediumDescription {
    /// Reads a medium. After a mistake, which has been recorded, `None`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let read = match Heterogeneous::of_even_extinction(params, build) {
            None => Self::read(params, build),
            varying => varying.map(|medium| medium.map(Self::Heterogeneous)),
        };
        let Some(medium) = read else {
            let built = BUILT.iter().copied();
            params
                .diagnostics
                .push(plugins::not_built(params.node, built));
            return None;
        };
        // Whether light is sampled at scattering points, as it always is here.
        params.ignore(&["sample_emitters", "has_spectral_extinction"]);
        params.finish_after(medium.is_some());
        medium
    }
}
