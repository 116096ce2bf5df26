//! The list of phase functions, and how each is read.

use crate::{Blend, Draine, HenyeyGreenstein, Isotropic, Mie, Rayleigh, Sggx, Tabulated};
use etalon_math::{Density, SolidAngle};
use etalon_params::{Class, Params, plugins};
use etalon_transport::{Build, Phase, PhaseSample, Textures};
use glam::{Vec2, Vec3, Vec4};

/// The point and wavelengths at which a phase function is evaluated.
#[derive(Debug)]
pub struct PhasePoint<'a, T> {
    /// Textures, for parameters that vary in space.
    pub textures: &'a T,
    /// The point (m, world).
    pub position: Vec3,
    /// The wavelengths (nm).
    pub lambda: Vec4,
}

// By hand, as `T` need not be `Copy`.
impl<T> Clone for PhasePoint<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for PhasePoint<'_, T> {}

/// The methods of [`Phase`] before a point is fixed.
pub(crate) trait PhaseModel {
    /// p(wo, wi) in sr⁻¹, per lane.
    fn eval(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, wi: Vec3) -> Vec4;

    /// The density with which [`PhaseModel::sample`] finds `wi`.
    fn density(
        &self,
        at: &PhasePoint<'_, impl Textures>,
        wo: Vec3,
        wi: Vec3,
    ) -> Density<SolidAngle>;

    /// Samples a direction with `u` uniform in [0, 1)².
    fn sample(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, u: Vec2) -> PhaseSample;

    /// See [`Phase::projected_area`].
    #[inline]
    fn projected_area(&self, _: &PhasePoint<'_, impl Textures>, _: Vec3) -> f32 {
        1.0
    }
}

macro_rules! phases {
    ($($(#[doc = $doc:literal])* $plugin:literal => $kind:ident: $read:expr;)*) => {
        /// Any phase function.
        #[derive(Clone, Debug, PartialEq)]
        pub enum PhaseFunction {
            $($(#[doc = $doc])* $kind($kind),)*
        }

        /// Names of the phase functions that are built.
        pub const BUILT: &[&str] = &[$($plugin,)*];

        impl PhaseFunction {
            fn read(params: &Params<'_>, build: &mut dyn Build) -> Option<Option<Self>> {
                match params.node.plugin.value.as_str() {
                    $($plugin => {
                        let read: fn(&Params<'_>, &mut dyn Build) -> Option<$kind> = $read;
                        Some(read(params, build).map(Self::$kind))
                    })*
                    _ => None,
                }
            }
        }

        impl PhaseModel for PhaseFunction {
            #[inline]
            fn eval(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, wi: Vec3) -> Vec4 {
                match self { $(Self::$kind(phase) => phase.eval(at, wo, wi),)* }
            }

            #[inline]
            fn density(
                &self,
                at: &PhasePoint<'_, impl Textures>,
                wo: Vec3,
                wi: Vec3,
            ) -> Density<SolidAngle> {
                match self { $(Self::$kind(phase) => phase.density(at, wo, wi),)* }
            }

            #[inline]
            fn sample(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, u: Vec2) -> PhaseSample {
                match self { $(Self::$kind(phase) => phase.sample(at, wo, u),)* }
            }

            #[inline]
            fn projected_area(&self, at: &PhasePoint<'_, impl Textures>, direction: Vec3) -> f32 {
                match self { $(Self::$kind(phase) => phase.projected_area(at, direction),)* }
            }
        }
    };
}

// The list: a line for each phase function.
phases! {
    /// The same in all directions.
    "isotropic" => Isotropic: |_, _| Some(Isotropic);
    /// Henyey and Greenstein's.
    "hg" => HenyeyGreenstein: |params, _| HenyeyGreenstein::from_params(params);
    /// Rayleigh's.
    "rayleigh" => Rayleigh: |_, _| Some(Rayleigh);
    /// Draine's.
    "draine" => Draine: |params, _| Some(Draine::from_params(params));
    /// Of spheres.
    "mie" => Mie: |params, _| Mie::from_params(params);
    /// A table.
    "tabphase" => Tabulated: |params, _| Tabulated::from_params(params);
    /// Of flakes.
    "sggx" => Sggx: Sggx::from_params;
    /// Two others.
    "blendphase" => Blend: Blend::from_params;
}

impl PhaseFunction {
    /// The phase function of a medium: its only child of that class, isotropic without one. After a mistake, which
    /// has been recorded, `None`.
    pub fn of_medium(medium: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let Some(node) = medium.child(Class::Phase) else {
            return Some(Self::Isotropic(Isotropic));
        };
        Self::from_params(&Params::new(node, medium.diagnostics), build)
    }

    /// The mean cosine of the angle of scattering, where it is known.
    pub(crate) fn mean_cosine(&self) -> Option<f32> {
        match self {
            Self::HenyeyGreenstein(phase) => Some(phase.mean_cosine()),
            Self::Isotropic(_) | Self::Rayleigh(_) => Some(0.0),
            _ => None,
        }
    }

    /// Reads a phase function. After a mistake, which has been recorded, `None`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let Some(phase) = Self::read(params, build) else {
            let built = BUILT.iter().copied();
            (params.diagnostics).push(plugins::not_built(params.node, built));
            return None;
        };
        params.finish_after(phase.is_some());
        phase
    }

    /// The phase function of a point at four wavelengths (nm).
    #[inline]
    pub fn at<'a, T>(&'a self, textures: &'a T, position: Vec3, lambda: Vec4) -> PhaseAt<'a, T> {
        PhaseAt {
            phase: self,
            point: PhasePoint {
                textures,
                position,
                lambda,
            },
        }
    }
}

/// A phase function at a point.
#[derive(Debug)]
pub struct PhaseAt<'a, T> {
    phase: &'a PhaseFunction,
    point: PhasePoint<'a, T>,
}

impl<T> Clone for PhaseAt<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for PhaseAt<'_, T> {}

impl<T: Textures> Phase for PhaseAt<'_, T> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec4 {
        self.phase.eval(&self.point, wo, wi)
    }

    #[inline]
    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        self.phase.density(&self.point, wo, wi)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2) -> PhaseSample {
        self.phase.sample(&self.point, wo, u)
    }

    #[inline]
    fn projected_area(&self, direction: Vec3) -> f32 {
        self.phase.projected_area(&self.point, direction)
    }
}
