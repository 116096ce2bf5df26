//! The list of lights, and how each is read.

use crate::{
    AreaLight, BoundingSphere, ConstantLight, DirectionalLight, EnvironmentMap, LightExtent,
    PointLight, SpotLight,
};
use etalon_math::{Density, DirectionCone, SolidAngle};
use etalon_params::{Class, Diagnostic, Params, plugins};
use etalon_sampling::warps::UNIFORM_SPHERE_DENSITY;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightSample, LightSampleContext, ShapeId, Shapes,
    SurfaceInteraction, SurfacePoint, TexturePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// Names of the lights that are built.
pub const BUILT: &[&str] = &["area", "constant", "directional", "envmap", "point", "spot"];

/// Any light.
#[derive(Clone, Debug)]
pub enum Light {
    /// An emitting shape.
    Area(AreaLight),
    /// A light without extent.
    Point(PointLight),
    /// A light without extent, into a cone.
    Spot(SpotLight),
    /// Parallel light from infinity.
    Directional(DirectionalLight),
    /// The same from everywhere at infinity.
    Constant(ConstantLight),
    /// An image at infinity.
    Environment(EnvironmentMap),
}

/// A light as described, and how often it is to be chosen.
#[derive(Clone, Debug)]
pub struct LightDescription {
    /// The light.
    pub light: Light,
    /// How often it is chosen, relative to its power.
    pub sampling_weight: f64,
}

impl LightDescription {
    /// Reads an emitter node; `shape` is the shape it is a child of. Reports every mistake,
    /// unknown properties included; `None` if no light can be made of it.
    pub fn from_params(
        params: &Params<'_>,
        shape: Option<ShapeId>,
        build: &mut dyn Build,
    ) -> Option<Self> {
        let name = params.node.plugin.value.as_str();
        let light = match (name, shape) {
            ("area", Some(shape)) => {
                Some(Light::Area(AreaLight::from_params(params, shape, build)))
            }
            ("area", None) => {
                params.error("an `area` light must be the child of a shape");
                return None;
            }
            (name, Some(_)) if BUILT.contains(&name) => {
                params.error(format!("a `{name}` light cannot be the child of a shape"));
                return None;
            }
            ("point", None) => PointLight::from_params(params, build).map(Light::Point),
            ("spot", None) => SpotLight::from_params(params, build).map(Light::Spot),
            ("directional", None) => {
                DirectionalLight::from_params(params, build).map(Light::Directional)
            }
            ("constant", None) => Some(Light::Constant(ConstantLight::from_params(params, build))),
            ("envmap", None) => EnvironmentMap::from_params(params, build).map(Light::Environment),
            _ => {
                let built = BUILT.iter().copied();
                params
                    .diagnostics
                    .push(plugins::not_built(params.node, built));
                return None;
            }
        };
        let what = "a finite number not below 0";
        let sampling_weight =
            params.float_where("sampling_weight", 1.0, what, |w| w >= 0.0 && w.is_finite());
        for (property, _) in params.children(Class::Medium) {
            let message = "a light inside of a medium is known but not built yet";
            let diagnostic = Diagnostic::error(property.name_span, message);
            params.diagnostics.push(diagnostic);
        }
        params.finish();
        Some(Self {
            light: light?,
            sampling_weight,
        })
    }
}

impl Light {
    /// Whether it is at infinity.
    pub fn is_infinite(&self) -> bool {
        match self {
            Self::Area(_) | Self::Point(_) | Self::Spot(_) => false,
            Self::Directional(_) | Self::Constant(_) | Self::Environment(_) => true,
        }
    }

    /// Whether a ray that misses everything sees it.
    pub fn is_background(&self) -> bool {
        matches!(self, Self::Constant(_) | Self::Environment(_))
    }

    /// Radiance that leaves the surface point `vertex` along `wo`; zero for lights without
    /// surface.
    #[inline]
    pub fn emitted(
        &self,
        textures: &impl Textures,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        match self {
            Self::Area(light) => {
                light.emitted(textures, &SurfacePoint::from(vertex), wo, wavelengths)
            }
            _ => Vec4::ZERO,
        }
    }

    /// Radiance seen along the unit vector `direction` by a ray that misses everything.
    #[inline]
    pub fn background(
        &self,
        textures: &impl Textures,
        direction: Vec3,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        match self {
            Self::Constant(light) => light.background(textures, wavelengths),
            Self::Environment(light) => light.background(direction, wavelengths),
            _ => Vec4::ZERO,
        }
    }

    /// A direction from `from` to the light, as if it were the only one.
    #[inline]
    pub fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        match self {
            Self::Area(light) => light.sample(scene, from, wavelengths, u),
            Self::Point(light) => light.sample(scene, from.position, wavelengths),
            Self::Spot(light) => light.sample(scene, from.position, wavelengths),
            Self::Directional(light) => Some(light.sample(scene, wavelengths)),
            Self::Constant(light) => light.sample(scene, from, wavelengths, u),
            Self::Environment(light) => light.sample(from, wavelengths, u),
        }
    }

    /// Whether all its samples bring `from` the same irradiance if nothing is in the way.
    #[inline]
    pub fn is_even(&self, from: &LightSampleContext) -> bool {
        match self {
            Self::Point(_) | Self::Spot(_) | Self::Directional(_) => true,
            // Of what receives on both sides it is a part, and the best there is.
            Self::Constant(_) => from.normal != Vec3::ZERO,
            Self::Area(_) | Self::Environment(_) => false,
        }
    }

    /// The density with which [`Light::sample`] from `from` finds the surface point `at`.
    #[inline]
    pub fn density(
        &self,
        shapes: &impl Shapes,
        from: &LightSampleContext,
        at: &SurfacePoint,
    ) -> Density<SolidAngle> {
        match self {
            Self::Area(light) => Density::uniform(shapes.density_toward(light.shape, from, at)),
            _ => Density::ZERO,
        }
    }

    /// The density with which [`Light::sample`] from `from` finds the background in `direction`.
    #[inline]
    pub fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        match self {
            Self::Constant(light) => light.density(from, direction),
            Self::Environment(light) => light.density(from, direction),
            _ => Density::ZERO,
        }
    }

    /// The densities with which [`Light::emit`] makes a particle travel along `direction`, whose
    /// angle with the surface has the cosine `cos`.
    #[inline]
    pub fn emission_density(
        &self,
        shapes: &impl Shapes,
        bounds: &BoundingSphere,
        direction: Vec3,
        cos: f32,
    ) -> EmissionPdf {
        let (origin, ray) = match self {
            Self::Area(light) => return light.emission_density(shapes, cos),
            Self::Point(light) => (1.0, light.direction_density()),
            Self::Spot(light) => (1.0, light.direction_density(direction)),
            Self::Directional(_) => (1.0, bounds.ray_density()),
            Self::Constant(_) => (UNIFORM_SPHERE_DENSITY, bounds.ray_density()),
            Self::Environment(light) => (light.emission_density(-direction), bounds.ray_density()),
        };
        EmissionPdf { origin, ray }
    }

    /// A particle, as if this were the only light.
    #[inline]
    pub fn emit(
        &self,
        scene: &(impl Textures + Shapes),
        bounds: &BoundingSphere,
        wavelengths: &Wavelengths,
        u_position: Vec2,
        u_direction: Vec2,
    ) -> Option<Emission> {
        match self {
            Self::Area(light) => light.emit(scene, wavelengths, u_position, u_direction),
            Self::Point(light) => Some(light.emit(scene, wavelengths, u_direction)),
            Self::Spot(light) => Some(light.emit(scene, wavelengths, u_direction)),
            Self::Directional(light) => Some(light.emit(scene, bounds, wavelengths, u_position)),
            Self::Constant(light) => {
                Some(light.emit(scene, bounds, wavelengths, u_position, u_direction))
            }
            Self::Environment(light) => light.emit(bounds, wavelengths, u_position, u_direction),
        }
    }

    /// Where it is and whither it shines, without its power; `None` for a light at infinity.
    pub fn extent(&self, shapes: &impl Shapes) -> Option<LightExtent> {
        match self {
            Self::Area(light) => Some(light.extent(shapes)),
            Self::Point(light) => Some(extent_of_point(light.position, DirectionCone::ALL, 0.0)),
            Self::Spot(light) => Some(light.extent()),
            Self::Directional(_) | Self::Constant(_) | Self::Environment(_) => None,
        }
    }

    /// The one direction in which a light at infinity is, if there is but one (unit).
    pub fn toward(&self) -> Option<Vec3> {
        match self {
            Self::Directional(light) => Some(-light.direction),
            _ => None,
        }
    }

    /// Emitted power (lights at infinity: what enters the scene), averaged over the wavelengths
    /// (W·nm⁻¹). Exact unless a texture's mean stands for the texture.
    pub fn power(&self, scene: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        match self {
            Self::Area(light) => light.power(scene),
            Self::Point(light) => light.power(scene),
            Self::Spot(light) => light.power(scene),
            Self::Directional(light) => light.power(scene, bounds),
            Self::Constant(light) => light.power(scene, bounds),
            Self::Environment(light) => light.power(bounds),
        }
    }
}

/// Where lights without surface are: in a point.
pub(crate) fn extent_of_point(position: Vec3, shines: DirectionCone, cos_edge: f64) -> LightExtent {
    LightExtent {
        low: position.as_dvec3(),
        high: position.as_dvec3(),
        normals: shines,
        cos_edge,
        power: 0.0,
    }
}

/// The place at which spectra that do not vary in space are looked up.
pub(crate) fn anywhere() -> TexturePoint {
    TexturePoint::at_uv(Vec2::ZERO)
}
