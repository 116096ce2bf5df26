//! The list of phase functions, and how each is read.

use crate::{HenyeyGreenstein, Isotropic, Rayleigh};
use etalon_math::{Density, SolidAngle};
use etalon_params::{Class, Params, plugins};
use etalon_transport::{Phase, PhaseSample};
use glam::{Vec2, Vec3, Vec4};

macro_rules! phases {
    ($($(#[doc = $doc:literal])* $plugin:literal => $kind:ident: $read:expr;)*) => {
        /// Any phase function.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum AnyPhase {
            $($(#[doc = $doc])* $kind($kind),)*
        }

        /// Names of the phase functions that are built.
        pub const BUILT: &[&str] = &[$($plugin,)*];

        impl AnyPhase {
            fn read(params: &Params<'_>) -> Option<Option<Self>> {
                match params.node.plugin.value.as_str() {
                    $($plugin => {
                        let read: fn(&Params<'_>) -> Option<$kind> = $read;
                        Some(read(params).map(Self::$kind))
                    })*
                    _ => None,
                }
            }
        }

        impl Phase for AnyPhase {
            #[inline]
            fn eval(&self, wo: Vec3, wi: Vec3) -> Vec4 {
                match self { $(Self::$kind(phase) => phase.eval(wo, wi),)* }
            }

            #[inline]
            fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
                match self { $(Self::$kind(phase) => phase.density(wo, wi),)* }
            }

            #[inline]
            fn sample(&self, wo: Vec3, u: Vec2) -> PhaseSample {
                match self { $(Self::$kind(phase) => phase.sample(wo, u),)* }
            }
        }
    };
}

// The list: a line for each phase function.
phases! {
    /// The same in all directions.
    "isotropic" => Isotropic: |_| Some(Isotropic);
    /// Henyey and Greenstein's.
    "hg" => HenyeyGreenstein: HenyeyGreenstein::from_params;
    /// Rayleigh's.
    "rayleigh" => Rayleigh: |_| Some(Rayleigh);
}

impl AnyPhase {
    /// The phase function of a medium: its only child of that class, isotropic without one. After a mistake, which
    /// has been recorded, `None`.
    pub fn of_medium(medium: &Params<'_>) -> Option<Self> {
        let Some(node) = medium.child(Class::Phase) else {
            return Some(Self::Isotropic(Isotropic));
        };
        let params = Params::new(node, medium.diagnostics);
        let Some(phase) = Self::read(&params) else {
            let built = BUILT.iter().copied();
            medium.diagnostics.push(plugins::not_built(node, built));
            return None;
        };
        params.finish();
        phase
    }
}
