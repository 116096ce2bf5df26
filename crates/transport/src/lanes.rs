//! The contract of a scene that shades many vertices at once, in vector lanes.
//!
//! A vertex is of a *kind* if its surface scatters light by a model that is written for lanes; as many vertices of one kind as
//! there are lanes are shaded together. Lane i gets the bits that [`World`](crate::World) gives for the same vertex, so it does
//! not matter which vertices are shaded together, or whether any are.

use crate::{
    BsdfSample, Hit, LaneSurface, LaneVertices, LightSample, LightSampleContext, Ray, SamplePdf,
    ShapeId, TexturePoint,
};
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector, per_lane};
use etalon_math::{DeltaProbability, Density};
use etalon_spectrum::Wavelengths;
use glam::{Vec3, Vec4};

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
    /// The cosine `cos` with the normal as an importance: at least that of a grazing direction, and zero only if it is below the
    /// horizon by more than rounding, so that no contributing light is left out.
    #[inline(always)]
    pub fn counted(cos: F) -> F {
        const GRAZING: f32 = 1e-4;
        let below = cos.lt(F::splat(-GRAZING));
        below.select(F::ZERO, cos.max(F::splat(GRAZING)))
    }

    /// [`LaneReceiver::counted`] of light from the unit vector `direction`; 1 where there is no surface.
    #[inline(always)]
    pub fn facing(&self, direction: F::Vector) -> F {
        let cos = self.normal.dot_product(direction);
        let counted = Self::counted(self.one_sided.select(cos, cos.abs()));
        self.normal.is_zero().select(F::ONE, counted)
    }

    /// `from(i)` in lane i.
    #[inline(always)]
    pub fn of_lanes<'r>(from: impl Fn(usize) -> &'r LightSampleContext) -> Self {
        let [px, py, pz, nx, ny, nz, time, _] = F::columns(|i| {
            let from = from(i);
            let ([px, py, pz], [nx, ny, nz]) = (from.position.to_array(), from.normal.to_array());
            [px, py, pz, nx, ny, nz, from.time, 0.0]
        });
        Self {
            position: F::Vector::from_xyz(px, py, pz),
            normal: F::Vector::from_xyz(nx, ny, nz),
            one_sided: F::Mask::from_fn(|i| from(i).one_sided),
            time,
        }
    }

    /// The receiver in any lane.
    #[inline(always)]
    pub fn lanes(self) -> impl Fn(usize) -> LightSampleContext {
        let ([px, py, pz], [nx, ny, nz]) = (self.position.xyz(), self.normal.xyz());
        let rows = F::rows([px, py, pz, nx, ny, nz, self.time, F::ZERO]);
        let one_sided = self.one_sided;
        move |i| {
            let [px, py, pz, nx, ny, nz, time, _] = rows.as_ref()[i];
            LightSampleContext {
                position: Vec3::new(px, py, pz),
                normal: Vec3::new(nx, ny, nz),
                one_sided: one_sided.lane(i),
                time,
                combined: true,
            }
        }
    }

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

/// Light samples, as [`LightSample`] describes them.
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

impl<F: Lane> LaneLightSample<F> {
    /// None in any lane.
    #[inline(always)]
    pub fn none() -> Self {
        let (nowhere, never) = (F::Vector::broadcast(Vec3::ZERO), F::Mask::splat(false));
        Self {
            found: never,
            direction: nowhere,
            target: nowhere,
            has_target: never,
            radiance: F::Spectrum::uniform(F::ZERO),
            chance: F::ZERO,
            is_delta: never,
        }
    }

    /// `sample(i)` in lane i, of lights that are not media.
    #[inline]
    pub fn of_lanes(sample: impl Fn(usize) -> Option<LightSample>) -> Self {
        let samples = per_lane::<F, _>(sample);
        let mask = |of: fn(&LightSample) -> bool| {
            F::Mask::from_fn(|i| samples[i].as_ref().is_some_and(of))
        };
        let place = |i: usize| {
            let Some(sample) = &samples[i] else {
                return [0.0; 8];
            };
            let target = sample.target.unwrap_or(Vec3::ZERO);
            let ([dx, dy, dz], [tx, ty, tz]) = (sample.direction.to_array(), target.to_array());
            // Of such lights it is the same for all wavelengths.
            [dx, dy, dz, tx, ty, tz, sample.chance.lanes().x, 0.0]
        };
        let radiance = |i: usize| {
            let sample = samples[i].as_ref();
            sample.map_or(Vec4::ZERO, |sample| sample.radiance)
        };
        let [dx, dy, dz, tx, ty, tz, chance, _] = F::columns(place);
        Self {
            found: mask(|_| true),
            direction: F::Vector::from_xyz(dx, dy, dz),
            target: F::Vector::from_xyz(tx, ty, tz),
            has_target: mask(|sample| sample.target.is_some()),
            radiance: F::Spectrum::of_lanes(radiance),
            chance,
            is_delta: mask(|sample| sample.chance.is_delta()),
        }
    }

    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    #[must_use]
    pub fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        let vector = |yes, no| F::Vector::choose(mask, yes, no);
        let masks = |yes: F::Mask, no: F::Mask| (yes & mask) | (no & !mask);
        Self {
            found: masks(yes.found, no.found),
            direction: vector(yes.direction, no.direction),
            target: vector(yes.target, no.target),
            has_target: masks(yes.has_target, no.has_target),
            radiance: F::Spectrum::choose(mask, yes.radiance, no.radiance),
            chance: mask.select(yes.chance, no.chance),
            is_delta: masks(yes.is_delta, no.is_delta),
        }
    }
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

impl<F: Lane> LaneBsdfSample<F> {
    /// Directions of a continuum with their values and densities (sr⁻¹). One is found where its density is above 0 at the wavelength
    /// that chose.
    #[inline(always)]
    pub fn continuous(wi: F::Vector, (value, density): (F::Spectrum, F::Spectrum), eta: F) -> Self {
        Self {
            found: density.hero().gt(F::ZERO),
            wi,
            value,
            chance: density,
            is_delta: F::Mask::splat(false),
            eta,
        }
    }

    /// Discrete directions with their values and probabilities. One is found where it has a probability at the wavelength that chose.
    #[inline(always)]
    pub fn discrete(wi: F::Vector, value_and_chance: (F::Spectrum, F::Spectrum), eta: F) -> Self {
        Self {
            is_delta: F::Mask::splat(true),
            ..Self::continuous(wi, value_and_chance, eta)
        }
    }

    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    pub fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        Self {
            found: (mask & yes.found) | (!mask & no.found),
            wi: F::Vector::choose(mask, yes.wi, no.wi),
            value: F::Spectrum::choose(mask, yes.value, no.value),
            chance: F::Spectrum::choose(mask, yes.chance, no.chance),
            is_delta: (mask & yes.is_delta) | (!mask & no.is_delta),
            eta: mask.select(yes.eta, no.eta),
        }
    }
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

    /// As [`Bsdf::albedo`](crate::Bsdf::albedo) says.
    fn albedo(&self, wo: F::Vector) -> F::Spectrum;
}

/// What a scene can do for several vertices at once.
pub trait LaneShading: Sync {
    /// The scattering models of several vertices, which may refer to tables of the scene.
    type Bsdf<'a, F: Lane>: LaneBsdf<F>
    where
        Self: 'a;

    /// The kind of the vertex at a hit, whose surface bounds no medium; `None` if it must be shaded by itself.
    fn kind(&self, hit: &Hit) -> Option<LaneKind>;

    /// The surfaces where rays have their hits, as [`Surfaces::vertex`](crate::Surfaces::vertex) says.
    fn surfaces<'h, F: Lane>(
        &self,
        ray: impl Fn(usize) -> &'h Ray,
        hit: impl Fn(usize) -> &'h Hit,
    ) -> LaneSurface<F>;

    /// The point at a hit, for textures, as that vertex has it.
    fn texture_point(&self, ray: &Ray, hit: &Hit) -> TexturePoint;

    /// The scattering models of vertices of one kind, of the shapes `shape(i)`.
    fn bsdf<F: Lane>(
        &self,
        kind: LaneKind,
        shape: impl Fn(usize) -> ShapeId,
        vertices: LaneVertices<'_, F>,
        wo: F::Vector,
    ) -> Self::Bsdf<'_, F>;

    /// Light samples, as by [`World::sample_light`](crate::World::sample_light), in the lanes where they are `wanted` at least.
    fn sample_light<F: Lane>(
        &self,
        from: &LaneReceiver<F>,
        wavelengths: &[Wavelengths],
        wanted: F::Mask,
        u_light: F,
        u: [F; 2],
    ) -> LaneLightSample<F>;

    /// Radiance of the lights at infinity seen along unit vectors, and the densities (sr⁻¹) with which receivers choose these
    /// directions, as [`Lights::background`](crate::Lights::background) and
    /// [`World::background_density`](crate::World::background_density) say.
    fn background<F: Lane>(
        &self,
        from: &LaneReceiver<F>,
        direction: F::Vector,
        wavelengths: &[Wavelengths],
    ) -> (F::Spectrum, F);
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

    fn albedo(&self, _: F::Vector) -> F::Spectrum {
        match *self {}
    }
}

impl LaneShading for NoLanes {
    type Bsdf<'a, F: Lane> = Self;

    fn kind(&self, _: &Hit) -> Option<LaneKind> {
        match *self {}
    }

    fn surfaces<'h, F: Lane>(
        &self,
        _: impl Fn(usize) -> &'h Ray,
        _: impl Fn(usize) -> &'h Hit,
    ) -> LaneSurface<F> {
        match *self {}
    }

    fn texture_point(&self, _: &Ray, _: &Hit) -> TexturePoint {
        match *self {}
    }

    fn bsdf<F: Lane>(
        &self,
        _: LaneKind,
        _: impl Fn(usize) -> ShapeId,
        _: LaneVertices<'_, F>,
        _: F::Vector,
    ) -> Self {
        match *self {}
    }

    fn sample_light<F: Lane>(
        &self,
        _: &LaneReceiver<F>,
        _: &[Wavelengths],
        _: F::Mask,
        _: F,
        _: [F; 2],
    ) -> LaneLightSample<F> {
        match *self {}
    }

    fn background<F: Lane>(
        &self,
        _: &LaneReceiver<F>,
        _: F::Vector,
        _: &[Wavelengths],
    ) -> (F::Spectrum, F) {
        match *self {}
    }
}
