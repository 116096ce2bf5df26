//! `constant`: the same radiance L(λ) from everywhere at infinity. Its power is that which enters
//! the scene's bounding sphere, Φ = 4π · π r² L.

use crate::Bounds;
use crate::light::anywhere;
use crate::uniformity::refuse_varying;
use etalon_math::{Density, SolidAngle};
use etalon_params::Params;
use etalon_sampling::warps::{UNIFORM_SPHERE_DENSITY, square_to_uniform_sphere};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Chance, Emission, EmissionDensity, LightId, LightSample, Origin, Role, TextureId,
    Textures,
};
use glam::{Vec2, Vec4};

/// A uniform sky all around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantLight {
    /// Its radiance (W·m⁻²·sr⁻¹·nm⁻¹).
    pub radiance: TextureId,
}

impl ConstantLight {
    /// Reads `radiance`. `to_world` turns a uniform sky into itself.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Self {
        refuse_varying(params, "radiance");
        Self {
            radiance: build.texture(params, "radiance", Some(1.0), Role::Emission),
        }
    }

    /// Radiance from any direction.
    #[inline]
    pub fn background(&self, textures: &impl Textures, wavelengths: &Wavelengths) -> Vec4 {
        textures.spectrum(self.radiance, &anywhere(), wavelengths.lambda)
    }

    /// Density of the directions of [`ConstantLight::sample`]: 1/(4π) everywhere.
    #[inline]
    pub fn density(&self) -> Density<SolidAngle> {
        Density::uniform(UNIFORM_SPHERE_DENSITY)
    }

    /// A direction, uniform over the sphere.
    #[inline]
    pub fn sample(
        &self,
        textures: &impl Textures,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> LightSample {
        LightSample {
            direction: square_to_uniform_sphere(u),
            target: None,
            radiance: self.background(textures, wavelengths),
            chance: Chance::Continuous(self.density()),
            cos: 1.0,
            origin: Origin::Sky,
            light: LightId::NONE,
        }
    }

    /// A particle.
    #[inline]
    pub fn emit(
        &self,
        textures: &impl Textures,
        bounds: &Bounds,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
    ) -> Emission {
        let direction = square_to_uniform_sphere(u_direction);
        let factor = bounds.cross_section() as f32 / UNIFORM_SPHERE_DENSITY;
        let ray = bounds.ray_into(direction, u_position);
        Emission {
            point: Emission::point_of(&ray),
            ray,
            weight: self.background(textures, wavelengths) * factor,
            density: EmissionDensity {
                origin: UNIFORM_SPHERE_DENSITY,
                ray: bounds.ray_density(),
            },
            origin: Origin::Sky,
            light: LightId::NONE,
        }
    }

    /// Power that enters the scene, averaged over the wavelengths (W·nm⁻¹).
    pub fn power(&self, textures: &impl Textures, bounds: &Bounds) -> f64 {
        4.0 * core::f64::consts::PI
            * bounds.cross_section()
            * f64::from(textures.mean(self.radiance))
    }
}
