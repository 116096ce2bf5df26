//! The methods of a light, with defaults that most of them share.

use crate::{BoundingSphere, LightExtent};
use etalon_math::lane::{Lane, Spectral, Vector};
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Emission, EmissionPdf, LaneLightSample, LaneReceiver, LightSample, LightSampleContext, Shapes,
    SurfacePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// A light, as if it were the only one.
pub(crate) trait LightModel {
    /// Whether it is read as the child of a shape, which then is a surface that emits.
    const OF_SHAPE: bool = false;

    /// Whether its particles are [`LightKind::Beam`](etalon_transport::LightKind::Beam)s.
    const BEAM: bool = false;

    /// Whether it is at infinity; it then has no [`LightModel::extent`].
    fn is_infinite(&self) -> bool {
        false
    }

    /// Whether a ray that misses everything sees it.
    fn is_background(&self) -> bool {
        false
    }

    /// Radiance that leaves the surface point `at` along `wo`.
    #[inline]
    fn emitted(&self, _: &impl Textures, _at: &SurfacePoint, _wo: Vec3, _: &Wavelengths) -> Vec4 {
        Vec4::ZERO
    }

    /// Radiance seen at the moment `time` along the unit vector `direction` by a ray that misses everything.
    #[inline]
    fn background(&self, _: &impl Textures, _direction: Vec3, _time: f32, _: &Wavelengths) -> Vec4 {
        Vec4::ZERO
    }

    /// [`LightModel::background`] and [`LightModel::background_density`] in lanes.
    #[inline]
    fn background_lanes<F: Lane>(
        &self,
        textures: &impl Textures,
        from: &LaneReceiver<F>,
        direction: F::Vector,
        wavelengths: &[Wavelengths],
    ) -> (F::Spectrum, F) {
        let along = |i: usize| direction.at_lane(i);
        let density = |i: usize| {
            self.background_density(&from.at_lane(i), along(i))
                .lanes()
                .x
        };
        (
            F::Spectrum::of_lanes(|i| {
                self.background(textures, along(i), from.time.lane(i), &wavelengths[i])
            }),
            F::from_fn(density),
        )
    }

    /// A direction from `from` to the light.
    fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample>;

    /// Whether it can be sampled in lanes together with another light; with itself, whether in lanes at all.
    #[inline]
    fn is_alike(&self, _other: &Self, _: &impl Shapes) -> bool {
        false
    }

    /// Samples directions to `light(i)` in lane i, which are all alike, in the lanes where they are `wanted` at least.
    fn sample_lanes<'l, F: Lane>(
        _light: impl Fn(usize) -> &'l Self,
        _: &(impl Textures + Shapes),
        _: (&LaneReceiver<F>, &[Wavelengths]),
        _wanted: F::Mask,
        _u: [F; 2],
    ) -> LaneLightSample<F>
    where
        Self: 'l,
    {
        unreachable!("it is sampled one by one")
    }

    /// Whether all its samples bring `from` the same irradiance if nothing is in the way.
    #[inline]
    fn is_even(&self, _from: &LightSampleContext) -> bool {
        false
    }

    /// The density with which [`LightModel::sample`] from `from` finds the surface point `at`.
    #[inline]
    fn density(
        &self,
        _: &impl Shapes,
        _from: &LightSampleContext,
        _at: &SurfacePoint,
    ) -> Density<SolidAngle> {
        Density::ZERO
    }

    /// The density with which [`LightModel::sample`] from `from` finds the background in `direction`.
    #[inline]
    fn background_density(
        &self,
        _from: &LightSampleContext,
        _direction: Vec3,
    ) -> Density<SolidAngle> {
        Density::ZERO
    }

    /// A particle at the moment `time`; the time of its ray is the caller's.
    fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission>;

    /// The densities with which [`LightModel::emit`] makes a particle travel along `direction`, whose
    /// angle with the surface has the cosine `cos`.
    fn emission_density(
        &self,
        shapes: &impl Shapes,
        bounds: &BoundingSphere,
        direction: Vec3,
        cos: f32,
        time: f32,
    ) -> EmissionPdf;

    /// Bounds on position and directions, without its power; `None` at infinity.
    fn extent(&self, _: &impl Shapes) -> Option<LightExtent> {
        None
    }

    /// The one direction in which a light at infinity is, if there is but one (unit).
    fn toward(&self) -> Option<Vec3> {
        None
    }

    /// Emitted power (for lights at infinity, the power that enters the scene), averaged over the wavelengths
    /// (W·nm⁻¹). Exact except that a texture's mean replaces the texture.
    fn power(&self, scene: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64;
}
