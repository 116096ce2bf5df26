//! What lights give to integrators.

use crate::{Chance, LightId, Ray};
use glam::{Vec3, Vec4};

/// A direction toward a light, as seen from some point.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction from the point to the light.
    pub direction: Vec3,
    /// Where the light's point is, already moved off its surface toward the observer, for the
    /// shadow ray; `None` for a light at infinity.
    pub target: Option<Vec3>,
    /// Incident radiance per lane; for a discrete light, incident irradiance on a surface
    /// perpendicular to `direction` (a point light's I/r²).
    pub radiance: Vec4,
    /// Density of the direction (probability of the choice of light included), or its discrete
    /// probability.
    pub chance: Chance,
    /// The light.
    pub light: LightId,
}

/// A particle leaving a light.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// The ray along which it leaves (its origin is off the light's surface).
    pub ray: Ray,
    /// The light's surface normal there, or the ray's direction where it has none.
    pub normal: Vec3,
    /// Emitted flux per lane over the probability of all choices made: Le·|cos θ| / (p_A·p_ω·p_light)
    /// for a surface, so that averaging `weight` over emissions gives the scene's power.
    pub weight: Vec4,
    /// The light.
    pub light: LightId,
}
