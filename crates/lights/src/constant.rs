//! `constant`: the same radiance L(λ) from everywhere at infinity. Its power is that which enters
//! the scene's bounding sphere, Φ = 4π · π r² L.
//!
//! A receiver with the normal n chooses the direction ω with the density
//!
//! ```text
//! one side:     max(0, n·ω)/π
//! both sides:   ½ |n·ω|/2π + ½ 1/4π
//! in space:     1/4π
//! ```
//!
//! The first is proportional to the irradiance. The second has a uniform part: a receiver with two sides may
//! have lobes with other normals, whose cosines do not vanish with n·ω.

use crate::light::anywhere;
use crate::light_model::LightModel;
use crate::{BoundingSphere, sky};
use etalon_math::lane::{Lane, LaneFrame, Mask, Select, Spectral, Vector};
use etalon_math::{Density, SolidAngle};
use etalon_params::Params;
use etalon_sampling::warps::{
    UNIFORM_SPHERE_DENSITY, cosine_density, cosine_hemisphere, square_to_uniform_sphere,
    uniform_sphere,
};
use etalon_spectrum::Wavelengths;
use etalon_transport::refuse_varying;
use etalon_transport::{
    Build, Emission, EmissionPdf, LaneLightSample, LaneReceiver, LightSample, LightSampleContext,
    Shapes, SpectrumKind, TextureId, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// A uniform sky all around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantLight {
    /// Its radiance (W·m⁻²·sr⁻¹·nm⁻¹).
    pub radiance: TextureId,
}

impl ConstantLight {
    /// Reads `radiance`. `to_world` turns a uniform sky into itself.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Self {
        refuse_varying(params, "radiance", build);
        Self {
            radiance: build.texture(params, "radiance", Some(1.0), SpectrumKind::Emission),
        }
    }
}

/// The density (sr⁻¹) with which a receiver chooses a direction.
#[inline(always)]
fn density_toward<F: Lane>(from: &LaneReceiver<F>, direction: F::Vector) -> F {
    let cos = from.normal.dot_product(direction);
    let on_both = (cosine_density(cos.abs()) * 0.5 + UNIFORM_SPHERE_DENSITY) * 0.5;
    let on_surface = from.one_sided.select(cosine_density(cos), on_both);
    let uniform = F::splat(UNIFORM_SPHERE_DENSITY);
    from.normal.is_zero().select(uniform, on_surface)
}

/// A direction with this density.
#[inline(always)]
fn direction_toward<F: Lane>(from: &LaneReceiver<F>, [u, v]: [F; 2]) -> F::Vector {
    let in_space = from.normal.is_zero();
    // On both sides, the first number chooses among four quarters, and is used again within its own.
    let quarter = u * 4.0;
    let first = quarter.lt(F::ONE);
    let above = quarter - first.select(F::ZERO, F::ONE);
    let about = cosine_hemisphere([from.one_sided.select(u, above), v]);
    let about = LaneFrame::<F>::from_normal(from.normal).to_world(about);
    let below = !(from.one_sided | first);
    let about = F::Vector::choose(below, -about, about);
    let anywhere = in_space | (!from.one_sided & quarter.ge(F::splat(2.0)));
    if !anywhere.any() {
        return about;
    }
    let again = in_space.select(u, quarter * 0.5 - 1.0);
    F::Vector::choose(anywhere, uniform_sphere([again, v]), about)
}

impl LightModel for ConstantLight {
    fn is_infinite(&self) -> bool {
        true
    }

    fn is_background(&self) -> bool {
        true
    }

    #[inline]
    fn is_even(&self, from: &LightSampleContext) -> bool {
        // On both sides the density is only partly proportional to the cosine; no better one is known.
        from.normal != Vec3::ZERO
    }

    #[inline]
    fn emission_density(
        &self,
        _: &impl Shapes,
        bounds: &BoundingSphere,
        _: Vec3,
        _cos: f32,
        _time: f32,
    ) -> EmissionPdf {
        EmissionPdf {
            origin: UNIFORM_SPHERE_DENSITY,
            ray: bounds.ray_density(),
        }
    }

    #[inline]
    fn background(
        &self,
        textures: &impl Textures,
        _: Vec3,
        _time: f32,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        textures.spectrum(self.radiance, &anywhere(), wavelengths.lambda)
    }

    #[inline]
    fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        Density::uniform(density_toward::<f32>(&from.broadcast(), direction))
    }

    #[inline]
    fn background_lanes<F: Lane>(
        &self,
        textures: &impl Textures,
        from: &LaneReceiver<F>,
        direction: F::Vector,
        wavelengths: &[Wavelengths],
    ) -> (F::Spectrum, F) {
        let lambda = |i: usize| wavelengths[i].lambda;
        (
            textures.spectra::<F>(|_| self.radiance, |_| anywhere(), lambda),
            density_toward(from, direction),
        )
    }

    #[inline]
    fn sample(
        &self,
        textures: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        let from = from.broadcast();
        let direction = direction_toward::<f32>(&from, u.to_array());
        let density = density_toward::<f32>(&from, direction);
        (density > 0.0).then(|| {
            let radiance = self.background(textures, direction, from.time, wavelengths);
            sky::sample(direction, radiance, Density::uniform(density))
        })
    }

    fn is_alike(&self, other: &Self, _: &impl Shapes) -> bool {
        self == other
    }

    #[inline]
    fn sample_lanes<'l, F: Lane>(
        light: impl Fn(usize) -> &'l Self,
        textures: &(impl Textures + Shapes),
        (from, wavelengths): (&LaneReceiver<F>, &[Wavelengths]),
        wanted: F::Mask,
        u: [F; 2],
    ) -> LaneLightSample<F> {
        let direction = direction_toward(from, u);
        let density = density_toward(from, direction);
        let dark = F::Spectrum::uniform(F::ZERO);
        let radiance = match wanted.any() {
            true => {
                let lambda = |i: usize| wavelengths[i].lambda;
                textures.spectra::<F>(|i| light(i).radiance, |_| anywhere(), lambda)
            }
            false => dark,
        };
        LaneLightSample {
            found: density.gt(F::ZERO),
            direction,
            radiance,
            chance: density,
            ..LaneLightSample::none()
        }
    }

    #[inline]
    fn emit(
        &self,
        textures: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
        time: f32,
    ) -> Option<Emission> {
        let direction = square_to_uniform_sphere(u_direction);
        let radiance = self.background(textures, direction, time, wavelengths);
        let density = UNIFORM_SPHERE_DENSITY;
        Some(sky::emit(bounds, -direction, u_position, radiance, density))
    }

    fn power(&self, textures: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        4.0 * core::f64::consts::PI
            * bounds.cross_section()
            * f64::from(textures.mean(self.radiance))
    }
}
