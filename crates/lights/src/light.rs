//! The list of lights, and how each is read.

use crate::light_model::LightModel;
use crate::pose::Pose;
use crate::{
    AreaLight, BoundingSphere, ConstantLight, DirectionalArea, DirectionalLight, EnvironmentMap,
    Goniometric, LightExtent, PointLight, Projector, SpotLight, SunSky,
};
use etalon_math::lane::Lane;
use etalon_math::{Density, DirectionCone, SolidAngle};
use etalon_params::{Params, plugins};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Build, Emission, EmissionPdf, LaneLightSample, LaneReceiver, LightSample, LightSampleContext,
    ShapeId, Shapes, SurfaceInteraction, SurfacePoint, TexturePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

macro_rules! lights {
    ($($(#[doc = $doc:literal])* $kind:ident($model:ty) { $plugin:literal => $read:expr })*) => {
        /// Any light.
        #[derive(Clone, Debug)]
        pub enum Light {
            $($(#[doc = $doc])* $kind($model),)*
        }

        /// Names of the lights that are built.
        pub const BUILT: &[&str] = &[$($plugin,)*];

        /// Whether the light of this name is the child of a shape; `None` if it is none of the list.
        fn is_of_shape(name: &str) -> Option<bool> {
            match name {
                $($plugin => Some(<$model as LightModel>::OF_SHAPE),)*
                _ => None,
            }
        }

        /// Reads the light of this name; `None` if it is none of the list, or after a mistake.
        fn read(params: &Params<'_>, shape: ShapeId, build: &mut dyn Build) -> Option<Light> {
            match params.node.plugin.value.as_str() {
                $($plugin => {
                    let read: fn(&Params<'_>, ShapeId, &mut dyn Build) -> Option<$model> = $read;
                    read(params, shape, build).map(Light::$kind)
                })*
                _ => None,
            }
        }

        impl Light {
            /// Whether it can be sampled in lanes together with another light; with itself, whether in lanes at all.
            pub(crate) fn is_alike(&self, other: &Self, shapes: &impl Shapes) -> bool {
                match (self, other) {
                    $((Self::$kind(it), Self::$kind(other)) => it.is_alike(other, shapes),)*
                    _ => false,
                }
            }

            /// Samples directions to `light(i)` in lane i, which are all alike, in the lanes where they are `wanted` at least.
            #[inline]
            pub(crate) fn sample_lanes<'l, F: Lane>(
                light: impl Fn(usize) -> &'l Self,
                scene: &(impl Textures + Shapes),
                (from, wavelengths): (&LaneReceiver<F>, &[Wavelengths]),
                wanted: F::Mask,
                u: [F; 2],
            ) -> LaneLightSample<F> {
                match light(0) {
                    $(Self::$kind(_) => {
                        let own = |i: usize| match light(i) {
                            Self::$kind(own) => own,
                            _ => unreachable!("all lights are alike"),
                        };
                        <$model as LightModel>::sample_lanes(own, scene, (from, wavelengths), wanted, u)
                    })*
                }
            }
        }

        /// Dispatches to the model.
        macro_rules! ask {
            ($light:expr, $it:ident => $answer:expr) => {
                match $light {
                    $(Light::$kind($it) => $answer,)*
                }
            };
        }
    };
}

// The list: a line for each light.
lights! {
    /// An emitting shape.
    Area(AreaLight) { "area" => |params, shape, build| Some(AreaLight::from_params(params, shape, build)) }
    /// The same from everywhere at infinity.
    Constant(ConstantLight) { "constant" => |params, _, build| Some(ConstantLight::from_params(params, build)) }
    /// Parallel light from infinity.
    Directional(DirectionalLight) { "directional" => |params, _, build| DirectionalLight::from_params(params, build) }
    /// A shape that shines along its normals.
    DirectionalArea(DirectionalArea) { "directionalarea" => |params, shape, build| Some(DirectionalArea::from_params(params, shape, build)) }
    /// An image at infinity.
    Environment(EnvironmentMap) { "envmap" => |params, _, build| EnvironmentMap::from_params(params, build) }
    /// A light without extent.
    Point(PointLight) { "point" => |params, _, build| PointLight::from_params(params, build) }
    /// A light without extent, into a cone.
    Spot(SpotLight) { "spot" => |params, _, build| SpotLight::from_params(params, build) }
    /// The clear sky and its sun.
    SunSky(SunSky) { "sunsky" => |params, _, build| SunSky::from_params(params, build) }
    /// The clear sky and its sun while days pass.
    TimedSunSky(SunSky) { "timed_sunsky" => |params, _, build| SunSky::timed_from_params(params, build) }
    /// A light without extent, by a table.
    Goniometric(Goniometric) { "goniometric" => |params, _, build| Goniometric::from_params(params, build) }
    /// A picture thrown from a point.
    Projector(Projector) { "projector" => |params, _, build| Projector::from_params(params, build) }
}

/// A light as described, and how often it is to be chosen.
#[derive(Clone, Debug)]
pub struct LightDescription {
    /// The light.
    pub light: Light,
    /// Factor on its power in light selection.
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
        let light = match (is_of_shape(name), shape) {
            (Some(true), None) => {
                params.error(format!(
                    "{} light must be the child of a shape",
                    params.node.with_article()
                ));
                return None;
            }
            (Some(false), Some(_)) => {
                params.error(format!(
                    "{} light cannot be the child of a shape",
                    params.node.with_article()
                ));
                return None;
            }
            (Some(_), shape) => read(params, shape.unwrap_or(ShapeId::NONE), build),
            (None, _) => {
                let built = BUILT.iter().copied();
                let diagnostic = plugins::not_built(params.node, built);
                params.diagnostics.push(diagnostic);
                return None;
            }
        };
        let what = "a finite number not below 0";
        let sampling_weight =
            params.float_where("sampling_weight", 1.0, what, |w| w >= 0.0 && w.is_finite());
        params.finish_after(light.is_some());
        Some(Self {
            light: light?,
            sampling_weight,
        })
    }
}

impl Light {
    /// Whether it is at infinity.
    pub fn is_infinite(&self) -> bool {
        ask!(self, light => light.is_infinite())
    }

    /// Whether a ray that misses everything sees it.
    pub fn is_background(&self) -> bool {
        ask!(self, light => light.is_background())
    }

    /// Whether a ray can find it: a surface, or a background.
    pub fn can_be_hit(&self) -> bool {
        fn of_shape<L: LightModel>(_: &L) -> bool {
            L::OF_SHAPE && !L::BEAM
        }
        self.is_background() || ask!(self, light => of_shape(light))
    }

    /// Whether only particles that start at it find it, see [`LightKind::Beam`](etalon_transport::LightKind::Beam).
    pub fn is_beam(&self) -> bool {
        fn beam<L: LightModel>(_: &L) -> bool {
            L::BEAM
        }
        ask!(self, light => beam(light))
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
        ask!(self, light => light.emitted(textures, &SurfacePoint::from(vertex), wo, wavelengths))
    }

    /// Radiance seen at the moment `time` along the unit vector `direction` by a ray that misses everything.
    #[inline]
    pub fn background(
        &self,
        textures: &impl Textures,
        direction: Vec3,
        time: f32,
        wavelengths: &Wavelengths,
    ) -> Vec4 {
        ask!(self, light => light.background(textures, direction, time, wavelengths))
    }

    /// A direction from `from` to the light, as if it were the only one.
    #[inline(always)] // Asked at every vertex: its answer is large.
    pub fn sample(
        &self,
        scene: &(impl Textures + Shapes),
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u: Vec2,
    ) -> Option<LightSample> {
        ask!(self, light => light.sample(scene, from, wavelengths, u))
    }

    /// Whether all its samples bring `from` the same irradiance if nothing is in the way.
    #[inline]
    pub fn is_even(&self, from: &LightSampleContext) -> bool {
        ask!(self, light => light.is_even(from))
    }

    /// The density with which [`Light::sample`] from `from` finds the surface point `at`.
    #[inline]
    pub fn density(
        &self,
        shapes: &impl Shapes,
        from: &LightSampleContext,
        at: &SurfacePoint,
    ) -> Density<SolidAngle> {
        ask!(self, light => light.density(shapes, from, at))
    }

    /// The density with which [`Light::sample`] from `from` finds the background in `direction`.
    #[inline]
    pub fn background_density(
        &self,
        from: &LightSampleContext,
        direction: Vec3,
    ) -> Density<SolidAngle> {
        ask!(self, light => light.background_density(from, direction))
    }

    /// [`Light::background`] and [`Light::background_density`] in lanes.
    #[inline]
    pub(crate) fn background_lanes<F: Lane>(
        &self,
        textures: &impl Textures,
        from: &LaneReceiver<F>,
        direction: F::Vector,
        wavelengths: &[Wavelengths],
    ) -> (F::Spectrum, F) {
        ask!(self, light => light.background_lanes(textures, from, direction, wavelengths))
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
        time: f32,
    ) -> EmissionPdf {
        ask!(self, light => light.emission_density(shapes, bounds, direction, cos, time))
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
        time: f32,
    ) -> Option<Emission> {
        ask!(self, light => light.emit(scene, bounds, wavelengths, u_position, u_direction, time))
    }

    /// Bounds on position and directions, without its power; `None` for a light at infinity.
    pub fn extent(&self, shapes: &impl Shapes) -> Option<LightExtent> {
        ask!(self, light => light.extent(shapes))
    }

    /// The one direction in which a light at infinity is, if there is but one (unit).
    pub fn toward(&self) -> Option<Vec3> {
        ask!(self, light => light.toward())
    }

    /// Emitted power (for lights at infinity, the power that enters the scene), averaged over the wavelengths
    /// (W·nm⁻¹). Exact except that a texture's mean replaces the texture.
    pub fn power(&self, scene: &(impl Textures + Shapes), bounds: &BoundingSphere) -> f64 {
        ask!(self, light => light.power(scene, bounds))
    }
}

/// The extent of a point light.
pub(crate) fn extent_of_point(position: Vec3, shines: DirectionCone, cos_edge: f64) -> LightExtent {
    LightExtent {
        low: position.as_dvec3(),
        high: position.as_dvec3(),
        normals: shines,
        cos_edge,
        power: 0.0,
    }
}

/// The extent of a light without extent that shines within an angle of this cosine around its z.
pub(crate) fn extent_of_cone(pose: &Pose, cos_edge: f32) -> LightExtent {
    let (shines, cos_edge) = if cos_edge > 0.0 {
        let axis = pose.to_world(Vec3::Z).as_dvec3().normalize();
        (DirectionCone::along(axis), f64::from(cos_edge))
    } else {
        (DirectionCone::ALL, 0.0)
    };
    extent_of_point(pose.position, shines, cos_edge)
}

/// The extent of a shape that emits within an angle of this cosine around its normals.
pub(crate) fn extent_of_shape(shapes: &impl Shapes, shape: ShapeId, cos_edge: f64) -> LightExtent {
    let [low, high] = shapes.bounds(shape).map(|corner| corner.as_dvec3());
    LightExtent {
        low,
        high,
        normals: shapes.normals(shape),
        cos_edge,
        power: 0.0,
    }
}

/// The place at which spectra that do not vary in space are looked up.
pub(crate) fn anywhere() -> TexturePoint {
    TexturePoint::at_uv(Vec2::ZERO)
}
