//! Light samples, and particles that leave lights.

use crate::{LightId, Ray, SamplePdf, SurfacePoint, TexturePoint};
use glam::{Vec2, Vec3, Vec4};

/// A direction toward a light, as seen from some point.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction from the point to the light.
    pub direction: Vec3,
    /// The end of the shadow ray: the light's point, offset from its surface toward the observer;
    /// `None` for a light at infinity.
    pub target: Option<Vec3>,
    /// Incident radiance per lane; for a discrete light, incident irradiance on a surface
    /// perpendicular to `direction` (a point light's I/r²).
    pub radiance: Vec4,
    /// Density of the direction (probability of the choice of light included), or its discrete
    /// probability; of a point of a medium per unit solid angle and length (sr⁻¹·m⁻¹).
    pub chance: SamplePdf,
    /// Cosine of the angle between the light's surface normal and the way to the observer; 1
    /// where it has no surface.
    pub cos: f32,
    /// The kind of light.
    pub origin: LightKind,
    /// σt at a point of an emitting medium (m⁻¹), per lane: the density per length with which a free flight ends there. 1
    /// for all other lights.
    pub extinction: Vec4,
    /// The light; any of them for a sky that is the sum of several.
    pub light: LightId,
}

/// How much unoccluded light samples at one point vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightVariety {
    /// Not at all for a diffuse surface: all bring the same irradiance.
    Even,
    /// All are of one light.
    Single,
    /// They may be of several lights.
    Several,
}

/// The densities of the two choices that start a particle: its origin and its ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionPdf {
    /// Of its origin, including the choice of the light: per unit area of an emitting surface (m⁻²);
    /// per unit solid angle of a direction to the sky (sr⁻¹); a probability for point and directional
    /// lights; per unit volume of a medium (m⁻³).
    pub origin: f32,
    /// Of its ray, given the origin: per unit solid angle (sr⁻¹), or per unit cross-section of
    /// the scene for a light at infinity (m⁻²).
    pub ray: f32,
}

impl EmissionPdf {
    /// Never emitted.
    pub const ZERO: Self = Self {
        origin: 0.0,
        ray: 0.0,
    };
}

/// The kind of light that a sample or a particle comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightKind {
    /// A point of an emitting surface.
    Surface,
    /// A light that is a point: no path finds it by chance.
    Point,
    /// One of the directions of the sky.
    Sky,
    /// The one direction of a light at infinity: no path finds it by chance.
    Parallel,
    /// A surface that shines along its normals alone: no path finds it by chance, nor by a connection.
    Beam,
    /// A point of a medium that emits light.
    Medium,
}

impl LightKind {
    /// Whether it is at infinity.
    #[inline]
    pub fn is_infinite(self) -> bool {
        matches!(self, Self::Sky | Self::Parallel)
    }

    /// Whether its particles of one direction are parallel, so that their density does not fall with distance.
    #[inline]
    pub fn is_parallel(self) -> bool {
        self.is_infinite() || self == Self::Beam
    }

    /// Whether a path can hit it by chance.
    #[inline]
    pub fn can_be_hit(self) -> bool {
        matches!(self, Self::Surface | Self::Sky | Self::Medium)
    }
}

/// A particle leaving a light.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// The ray along which it leaves (its origin is off the light's surface).
    pub ray: Ray,
    /// Its origin; for lights without surface the normal is the ray's direction.
    pub point: SurfacePoint,
    /// Emitted flux per lane over the probability of all choices made: Le·|cos θ| / (p_A·p_ω·p_light)
    /// for a surface, so that averaging `weight` over emissions gives the scene's power.
    pub weight: Vec4,
    /// The densities of those choices.
    pub density: EmissionPdf,
    /// The kind of light.
    pub origin: LightKind,
    /// See [`LightSample::extinction`].
    pub extinction: Vec4,
    /// The light.
    pub light: LightId,
}

impl Emission {
    /// The point at which the ray of a light without surface begins.
    #[inline]
    pub fn point_of(ray: &Ray) -> SurfacePoint {
        SurfacePoint {
            position: ray.origin,
            error: Vec3::ZERO,
            normal: ray.direction,
            texture: TexturePoint::at_uv(Vec2::ZERO),
        }
    }
}
