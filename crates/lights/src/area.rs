//! `area`: a shape that emits the radiance L(x, λ) from its outer side, the same in all
//! directions:
//!
//! ```text
//! Φ = π ∫ L dA
//! ```
//!
//! With `twosided` it emits so from both sides, and Φ is twice that.
//!
//! A moving light has the same radiance at all times. Its power, which is used for light selection only, is that at
//! the start of the shutter interval.
//!
//! Points toward an observer are chosen by the shape; emitted particles start uniformly over the
//! area, with directions in proportion to cos θ.

use crate::light::{anywhere, extent_of_shape};
use crate::light_model::LightModel;
use crate::{BoundingSphere, LightExtent};
use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Lane, Mask, Spectral, Vector};
use etalon_math::offset::offset_origins;
use etalon_math::{Density, DirectionCone, SolidAngle};
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LaneLightSample, LanePoint, LaneReceiver, LightId, LightKind,
    LightSample, LightSampleContext, Ray, SamplePdf, SampledPoint, ShapeId, Shapes, SpectrumKind,
    SurfacePoint, TextureId, Textures, is_varying,
};
use glam::{Vec2, Vec3, Vec4};

/// An emitting shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// The shape.
    pub shape: ShapeId,
    /// Whether its radiance varies over the shape.
    pub varies: bool,
    /// Whether both of its sides emit.
    pub twosided: bool,
    /// Its radiance (W·m⁻²·sr⁻¹·nm⁻¹).
    pub radiance: TextureId,
}

impl AreaLight {
    /// Reads `radiance` and `twosided`.
    pub fn from_params(params: &Params<'_>, shape: ShapeId, build: &mut dyn Build) -> Self {
        Self {
            shape,
            varies: is_varying(params, "radiance", build),
            twosided: params.boolean_or("twosided", false),
            radiance: build.texture(params, "radiance", Some(1.0), SpectrumKind::Emission),
        }
    }

    /// The part of the emitted particles that leave from one side.
    #[inline]
    fn share_of_side(&self) -> f32 {
        if self.twosided { 0.5 } else { 1.0 }
    }

    /// The cosine that counts for one on the outer side.
    #[inline]
    fn cos(&self, cos: f32) -> f32 {
        if self.twosided { cos.abs() } else { cos }
    }
}

/// Whether points of a surface send light to receivers, the directions to them, and the ends of shadow rays.
#[inline(always)]
fn connected<F: Lane>(
    point: &LanePoint<F>,
    from: F::Vector,
    twosided: bool,
) -> (F::Mask, F::Vector, F::Vector) {
    let to = point.position - from;
    let along = point.normal.dot_product(to);
    let against = if twosided { -along.abs() } else { along };
    // Also false where the two coincide, or are farther apart than numbers go.
    let found = point.density.gt(F::ZERO) & against.lt(F::ZERO);
    let target = offset_origins::<F>(point.position, point.error, point.normal, -to);
    (found, to.over(to.norm()), target)
}

impl LightModel for AreaLight {
    const OF_SHAPE: bool = true;

    #[inline]
    fn density(
        &self,
        shapes: &impl Shapes,
        from: &LightSampleContext,
        at: &SurfacePoint,
    ) -> Density<SolidAngle> {
        Density::uniform(shapes.density_toward(self.shape, from, at))
    }

    #[inline]
    fn emitted(
        &self,
        textures: &impl Textures,
        at: &SurfacePoint,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        if self.cos(at.normal.dot(wo)) > 0.0 {
            textures.spectrum(self.radiance, &at.texture, wavelengths.lambda)
        } else {
            Vec4::ZERO
        }
    }

    #[inline]
    fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        // What varies over the shape needs more of a point than its place.
        let (point, place) = match self.is_alike(self, scene) {
            true => {
                let from = from.broadcast();
                let point = scene.points_toward::<f32>(|_| self.shape, &from, u.to_array());
                (point, anywhere())
            }
            false => {
                let SampledPoint { point, density } = scene.sample_toward(self.shape, from, u)?;
                let seen = LanePoint {
                    position: point.position,
                    error: point.error,
                    normal: point.normal,
                    density,
                };
                (seen, point.texture)
            }
        };
        let (found, direction, target) = connected::<f32>(&point, from.position, self.twosided);
        let cos = self.cos(-point.normal.dot(direction));
        found.then(|| LightSample {
            direction,
            target: Some(target),
            radiance: match cos > 0.0 {
                true => scene.spectrum(self.radiance, &place, wavelengths.lambda),
                false => Vec4::ZERO,
            },
            chance: SamplePdf::Continuous(Density::uniform(point.density)),
            cos,
            origin: LightKind::Surface,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    #[inline]
    fn is_alike(&self, other: &Self, shapes: &impl Shapes) -> bool {
        let same_sides = self.twosided == other.twosided;
        same_sides && !self.varies && !other.varies && shapes.are_alike([self.shape, other.shape])
    }

    #[inline]
    fn sample_lanes<'l, F: Lane>(
        light: impl Fn(usize) -> &'l Self,
        scene: &(impl Textures + Shapes),
        (from, wavelengths): (&LaneReceiver<F>, &[Wavelengths]),
        wanted: F::Mask,
        u: [F; 2],
    ) -> LaneLightSample<F> {
        let point = scene.points_toward(|i| light(i).shape, from, u);
        // Those that are alike emit from the same sides.
        let (found, direction, target) = connected(&point, from.position, light(0).twosided);
        let shines = wanted & found;
        let dark = F::Spectrum::uniform(F::ZERO);
        let radiance = match shines.any() {
            true => {
                let lambda = |i: usize| wavelengths[i].lambda;
                scene.spectra::<F>(|i| light(i).radiance, |_| anywhere(), lambda)
            }
            false => dark,
        };
        LaneLightSample {
            found,
            direction,
            target,
            has_target: F::Mask::splat(true),
            radiance: F::Spectrum::choose(shines, radiance, dark),
            chance: point.density,
            is_delta: F::Mask::splat(false),
        }
    }

    #[inline]
    fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        _: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let SampledPoint { point, density } = scene.sample_area(self.shape, u_position, time);
        let (mut normal, mut u_direction) = (point.normal, u_direction);
        if self.twosided {
            let behind = u_direction.x >= 0.5;
            normal = if behind { -normal } else { normal };
            u_direction.x = 2.0 * u_direction.x - if behind { 1.0 } else { 0.0 };
        }
        let frame = etalon_math::Frame::from_normal(normal);
        let direction = frame.to_world(square_to_cosine_hemisphere(u_direction));
        let radiance = self.emitted(scene, &point, direction, wavelengths);
        // cos θ cancels against the density cos θ/π.
        (density > 0.0).then(|| Emission {
            ray: Ray::new(point.origin_along(direction), direction, 0.0),
            weight: radiance * (core::f32::consts::PI / (density * self.share_of_side())),
            density: EmissionPdf {
                origin: density,
                ray: normal.dot(direction).max(0.0) * FRAC_1_PI * self.share_of_side(),
            },
            point,
            origin: LightKind::Surface,
            extinction: Vec4::ONE,
            light: LightId::NONE,
        })
    }

    #[inline]
    fn emission_density(
        &self,
        shapes: &impl Shapes,
        _: &BoundingSphere,
        _: Vec3,
        cos: f32,
        time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: 1.0 / shapes.area(self.shape, time),
            ray: self.cos(cos).max(0.0) * FRAC_1_PI * self.share_of_side(),
        }
    }

    fn extent(&self, shapes: &impl Shapes) -> Option<LightExtent> {
        let outer = extent_of_shape(shapes, self.shape, 0.0);
        Some(match self.twosided {
            false => outer,
            true => LightExtent {
                normals: DirectionCone::ALL,
                ..outer
            },
        })
    }

    fn power(&self, scene: &(impl Textures + Shapes), _: &BoundingSphere) -> f64 {
        let area = f64::from(scene.area(self.shape, 0.0));
        let sides = if self.twosided { 2.0 } else { 1.0 };
        core::f64::consts::PI * sides * area * f64::from(scene.mean(self.radiance))
    }
}
