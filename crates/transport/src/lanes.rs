//! The contract of a scene that shades many vertices at once, in vector lanes.
//!
//! A vertex is of a *kind* if its surface scatters light by a model that is written for lanes; as many vertices of one kind as
//! there are lanes are shaded together. Lane i gets the bits that [`World`](crate::World) gives for the same vertex, so it does
//! not matter which vertices are shaded together, or whether any are.

use crate::{BsdfSample, LightSampleContext, SamplePdf, SurfaceInteraction};
use etalon_math::lane::{Lane, Mask, Vector};
use etalon_math::{DeltaProbability, Density};
use etalon_spectrum::Wavelengths;

/// A model of scattering that is written for lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LaneKind(pub u8);

impl LaneKind {
    /// No more than so many kinds exist.
    pub const COUNT: usize = 16;
}

/// Points that receive light, as [`LightSampleContext`] describes them, for estimators that combine light sampling with
/// scattering.
#[derive(Clone, Copy, Debug)]
pub struct LaneReceiver<F: Lane> {
    /// Positions (m, world).
    pub position: F::Vector,
    /// Unit normals.
    pub normal: F::Vector,
    /// Whether only light from the side to which the normal points counts.
    pub one_sided: F::Mask,
    /// Moments within the shutter interval.
    pub time: F,
}

impl<F: Lane> LaneReceiver<F> {
    /// The receiver in lane `index`.
    #[inline]
    pub fn at_lane(&self, index: usize) -> LightSampleContext {
        LightSampleContext {
            position: self.position.at_lane(index),
            normal: self.normal.at_lane(index),
            one_sided: self.one_sided.lane(index),
            time: self.time.lane(index),
            combined: true,
        }
    }
}

/// Points of surfaces, each chosen for a receiver.
#[derive(Clone, Copy, Debug)]
pub struct LanePoint<F: Lane> {
    /// Positions (m, world).
    pub position: F::Vector,
    /// Bounds on the absolute error of each coordinate.
    pub error: F::Vector,
    /// Unit normals, outside.
    pub normal: F::Vector,
    /// The density of each point (sr⁻¹).
    pub density: F,
}

/// Light samples, as [`LightSample`](crate::LightSample) describes them.
#[derive(Clone, Copy, Debug)]
pub struct LaneLightSample<F: Lane> {
    /// The lanes that have one; what others have does not matter.
    pub found: F::Mask,
    /// Unit directions to the light.
    pub direction: F::Vector,
    /// Where the light is, in lanes where it is not at infinity.
    pub target: F::Vector,
    /// Those lanes.
    pub has_target: F::Mask,
    /// Radiance that arrives if nothing is in the way.
    pub radiance: F::Spectrum,
    /// The density (sr⁻¹) of the direction, or its probability.
    pub chance: F,
    /// The lanes where it is a probability.
    pub is_delta: F::Mask,
}

/// Directions sampled from scattering models, as [`BsdfSample`] describes them.
#[derive(Clone, Copy, Debug)]
pub struct LaneBsdfSample<F: Lane> {
    /// The lanes that have one; what others have does not matter.
    pub found: F::Mask,
    /// Unit directions.
    pub wi: F::Vector,
    /// f·|cos θ|, or that without the delta distribution.
    pub value: F::Spectrum,
    /// The density (sr⁻¹) of the direction or its probability, had each wavelength been the one that chose.
    pub chance: F::Spectrum,
    /// The lanes where it is a probability.
    pub is_delta: F::Mask,
    /// The relative index of refraction passed.
    pub eta: F,
}

impl LaneBsdfSample<f32> {
    /// The sample, where there is one lane.
    #[inline]
    pub fn only(self) -> Option<BsdfSample> {
        self.found.then(|| BsdfSample {
            wi: self.wi,
            value: self.value,
            chance: match self.is_delta {
                true => SamplePdf::Discrete(DeltaProbability(self.chance)),
                false => SamplePdf::Continuous(Density::per_lane(self.chance)),
            },
            eta: self.eta,
            is_null: false,
        })
    }
}

/// Scattering models of one kind, none of which lets light pass straight on. Light is followed from the camera.
pub trait LaneBsdf<F: Lane> {
    /// The normals of the hemispheres, on the side of `wo`, into which light is scattered; `None` if that is the sphere.
    fn hemisphere(&self, wo: F::Vector) -> Option<F::Vector>;

    /// Whether they scatter into a continuum of directions, so that light sampling makes sense.
    fn has_continuous(&self) -> bool;

    /// f·|cos θ| and the density (sr⁻¹) of `wi`, per wavelength.
    fn eval_and_density(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum);

    /// Samples a direction.
    fn sample(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F>;
}

/// Vertices of one kind, in as many slices of as many items as there are lanes.
#[derive(Clone, Copy)]
pub struct LaneVertices<'a> {
    /// The vertices.
    pub vertices: &'a [&'a SurfaceInteraction],
    /// The wavelengths of their paths.
    pub wavelengths: &'a [Wavelengths],
}

/// What a scene can do for several vertices at once.
pub trait LaneShading: Sync {
    /// The scattering models of several vertices.
    type Bsdf<F: Lane>: LaneBsdf<F>;

    /// The kind of a vertex; `None` if it must be shaded by itself.
    fn kind(&self, vertex: &SurfaceInteraction) -> Option<LaneKind>;

    /// The scattering models of vertices of one kind.
    fn bsdf<F: Lane>(
        &self,
        kind: LaneKind,
        vertices: LaneVertices<'_>,
        wo: F::Vector,
    ) -> Self::Bsdf<F>;

    /// Light samples, as by [`World::sample_light`](crate::World::sample_light).
    fn sample_light<F: Lane>(
        &self,
        from: &LaneReceiver<F>,
        wavelengths: &[Wavelengths],
        u_light: F,
        u: [F; 2],
    ) -> LaneLightSample<F>;
}

/// The lanes of worlds that shade one vertex at a time; there is no value of it.
#[derive(Clone, Copy, Debug)]
pub enum NoLanes {}

impl<F: Lane> LaneBsdf<F> for NoLanes {
    fn hemisphere(&self, _: F::Vector) -> Option<F::Vector> {
        match *self {}
    }

    fn has_continuous(&self) -> bool {
        match *self {}
    }

    fn eval_and_density(&self, _: F::Vector, _: F::Vector) -> (F::Spectrum, F::Spectrum) {
        match *self {}
    }

    fn sample(&self, _: F::Vector, _: F, _: [F; 2]) -> LaneBsdfSample<F> {
        match *self {}
    }
}

impl LaneShading for NoLanes {
    type Bsdf<F: Lane> = Self;

    fn kind(&self, _: &SurfaceInteraction) -> Option<LaneKind> {
        match *self {}
    }

    fn bsdf<F: Lane>(&self, _: LaneKind, _: LaneVertices<'_>, _: F::Vector) -> Self {
        match *self {}
    }

    fn sample_light<F: Lane>(
        &self,
        _: &LaneReceiver<F>,
        _: &[Wavelengths],
        _: F,
        _: [F; 2],
    ) -> LaneLightSample<F> {
        match *self {}
    }
}
