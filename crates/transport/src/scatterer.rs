//! Scattering at a vertex of a path: by a surface's BSDF or a medium's phase function.
//!
//! Bidirectional paths and particles treat both alike: evaluate, density, sample. A phase function has no cosine, no
//! discrete directions and no null interaction.

use crate::{Bsdf, BsdfOf, BsdfSample, Medium, MediumOf, Phase, SamplePdf, TransportMode};
use etalon_math::{Density, Frame, SolidAngle};
use glam::{Vec2, Vec3, Vec4};

/// A BSDF, or a phase function that is used as one.
#[derive(Clone, Copy, Debug)]
pub enum Scatterer<B, P> {
    /// The BSDF of a surface.
    Surface(B),
    /// The phase function at a point of a medium.
    Space(P),
}

/// The phase functions of a world.
pub type PhaseOf<'w, W> = <MediumOf<'w, W> as Medium>::Phase;

/// The scatterers of a world.
pub type ScattererOf<'w, W> = Scatterer<BsdfOf<'w, W>, PhaseOf<'w, W>>;

impl<B, P> Scatterer<B, P> {
    /// Whether it is a point of a medium.
    #[inline]
    pub fn is_in_space(&self) -> bool {
        matches!(self, Self::Space(_))
    }
}

impl<B: Bsdf, P: Phase> Bsdf for Scatterer<B, P> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4 {
        match self {
            Self::Surface(bsdf) => bsdf.eval(wo, wi, mode),
            Self::Space(phase) => phase.eval(wo, wi),
        }
    }

    #[inline]
    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        match self {
            Self::Surface(bsdf) => bsdf.density(wo, wi),
            Self::Space(phase) => phase.density(wo, wi),
        }
    }

    #[inline]
    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        match self {
            Self::Surface(bsdf) => bsdf.eval_and_density(wo, wi, mode),
            Self::Space(phase) => (phase.eval(wo, wi), phase.density(wo, wi)),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        match self {
            Self::Surface(bsdf) => bsdf.sample(wo, u_lobe, u, mode),
            Self::Space(phase) => {
                let sample = phase.sample(wo, u);
                Some(BsdfSample {
                    wi: sample.wi,
                    value: sample.value,
                    chance: SamplePdf::Continuous(sample.density),
                    eta: 1.0,
                    is_null: false,
                })
            }
        }
    }

    #[inline]
    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        match self {
            Self::Surface(bsdf) => bsdf.discrete(wo, index, mode),
            Self::Space(_) => None,
        }
    }

    #[inline]
    fn projected_area(&self, direction: Vec3) -> f32 {
        match self {
            Self::Surface(_) => 1.0,
            Self::Space(phase) => phase.projected_area(direction),
        }
    }

    #[inline]
    fn has_continuous(&self) -> bool {
        match self {
            Self::Surface(bsdf) => bsdf.has_continuous(),
            Self::Space(_) => true,
        }
    }

    #[inline]
    fn has_discrete(&self) -> bool {
        match self {
            Self::Surface(bsdf) => bsdf.has_discrete(),
            Self::Space(_) => false,
        }
    }

    #[inline]
    fn hemisphere(&self) -> Option<Frame> {
        match self {
            Self::Surface(bsdf) => bsdf.hemisphere(),
            Self::Space(_) => None,
        }
    }

    #[inline]
    fn null_transmittance(&self) -> Vec4 {
        match self {
            Self::Surface(bsdf) => bsdf.null_transmittance(),
            Self::Space(_) => Vec4::ZERO,
        }
    }

    #[inline]
    fn null_probability(&self) -> Vec4 {
        match self {
            Self::Surface(bsdf) => bsdf.null_probability(),
            Self::Space(_) => Vec4::ZERO,
        }
    }

    fn albedo(&self, wo: Vec3) -> Vec4 {
        match self {
            Self::Surface(bsdf) => bsdf.albedo(wo),
            Self::Space(_) => Vec4::ONE,
        }
    }
}
