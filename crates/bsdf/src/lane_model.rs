//! The list of models that are written for vector lanes, and their dispatch.
//!
//! To write one of [`crate::models`] for lanes, make its type generic, implement [`LaneBxdf`], let its `impl Bxdf` follow from
//! one lane, and add one line to the list at the end of this file. The test harness follows from it.

use crate::lane_bsdf_at_point::LaneBxdf;
use crate::models::{
    conductor, dielectric, diffuse, plastic, principled, roughconductor, roughdielectric,
    roughplastic,
};
use crate::{Material, TextureSite};
use arrayvec::ArrayVec;
use etalon_math::lane::{Lane, MOST_LANES};
use etalon_transport::{LaneBsdfSample, LaneKind, Textures};

macro_rules! lane_models {
    ($($model:ident $module:ident $(<$life:lifetime>)?,)*) => {
        /// A model at several points, in lanes.
        #[derive(Clone, Copy, Debug)]
        pub enum LaneModel<'a, F: Lane> {
            $(#[doc = concat!("See [`", stringify!($module), "`].")]
            $model($module::$model<$($life,)? F>),)*
        }

        /// The kinds of vertices that can be shaded in lanes.
        #[derive(Clone, Copy)]
        enum LaneIndex {
            $($model,)*
        }

        impl<'a, F: Lane> LaneModel<'a, F> {
            /// The plain material of `at(i)`, of this kind, at its point, in lane i.
            #[inline]
            pub(crate) fn new<'s, T: Textures + 's>(
                kind: LaneKind,
                at: impl Fn(usize) -> (&'a Material, &'s TextureSite<'s, T>),
            ) -> Self {
                $(if kind.0 == LaneIndex::$model as u8 {
                    let own = |i| match at(i) {
                        (Material::$model(description), site) => (description, site),
                        _ => unreachable!("all lanes are of one kind"),
                    };
                    let all: ArrayVec<_, MOST_LANES> = (0..F::WIDTH).map(own).collect();
                    return Self::$model($module::Description::in_lanes(|i| all[i]));
                })*
                unreachable!("a kind that no material has")
            }

            /// Whether it scatters into a continuum of directions.
            #[inline]
            pub(crate) fn has_continuous(&self) -> bool {
                match self { $(Self::$model(_) => <$module::$model<$($life,)? F> as LaneBxdf<F>>::CONTINUOUS,)* }
            }

            /// Whether light may pass to the other side.
            #[inline]
            pub(crate) fn transmits(&self) -> bool {
                match self { $(Self::$model(_) => <$module::$model<$($life,)? F> as LaneBxdf<F>>::TRANSMITS,)* }
            }

            #[inline]
            pub(crate) fn eval_and_density(
                &self,
                wo: F::Vector,
                wi: F::Vector,
            ) -> (F::Spectrum, F::Spectrum) {
                match self { $(Self::$model(model) => model.eval_lanes(wo, wi),)* }
            }

            #[inline]
            pub(crate) fn sample(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F> {
                match self { $(Self::$model(model) => model.sample_lanes(wo, u_lobe, u),)* }
            }

            #[inline]
            pub(crate) fn albedo(&self, wo: F::Vector) -> F::Spectrum {
                match self { $(Self::$model(model) => model.albedo_lanes(wo),)* }
            }
        }

        impl Material {
            /// The kind of its points; `None` if they must be shaded one by one.
            pub fn lane_kind(&self) -> Option<LaneKind> {
                match self {
                    // Whether light passes must be the same for all of a kind.
                    Self::Principled(description) if description.transmits() => None,
                    $(Self::$model(_) => Some(LaneKind(LaneIndex::$model as u8)),)*
                    Self::TwoSided(sides) => sides.lane_kind(),
                    _ => None,
                }
            }
        }

        const _: () = assert!([$(LaneIndex::$model),*].len() <= LaneKind::COUNT);
    };
}

impl Material {
    /// Whether the back is not that of the surface itself.
    #[inline]
    pub(crate) fn has_two_sides(&self) -> bool {
        matches!(self, Self::TwoSided(_))
    }

    /// The plain material of the front or the back, of one that has a kind.
    #[inline]
    pub(crate) fn lane_side(&self, back: bool) -> &Self {
        match self {
            Self::TwoSided(sides) => sides.lane_side(back),
            _ => self,
        }
    }
}

// The list: a line for each model.
lane_models! {
    Diffuse diffuse,
    RoughConductor roughconductor,
    RoughPlastic roughplastic <'a>,
    RoughDielectric roughdielectric,
    Conductor conductor,
    Dielectric dielectric,
    Plastic plastic,
    Principled principled,
}
