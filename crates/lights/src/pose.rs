//! `to_world` of lights that have a direction: a position and an orientation.

use crate::LightExtent;
use etalon_math::lane::{Lane, Vector};
use etalon_math::{Animated, DeltaProbability, DirectionCone, FromAffine, Transform};
use etalon_params::Params;
use etalon_transport::{
    Build, Emission, EmissionPdf, LightId, LightKind, LightSample, LightSampleContext, Ray,
    SamplePdf,
};
use glam::{DAffine3, DVec3, Vec3, Vec4};

/// A rotation, perhaps with a reflection, and a position. Scale has no meaning for a light
/// without extent, and is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the light's origin (m).
    pub position: Vec3,
    transform: Transform,
}

impl Pose {
    /// Reads `to_world`, refusing what would change angles.
    pub fn from_params(params: &Params<'_>) -> Option<Self> {
        let matrix = params.transform("to_world");
        let transform = Transform::from_matrix(&matrix);
        let Some(transform) = transform.filter(|t| t.uniform_scale().is_some()) else {
            Self::refuse(params);
            return None;
        };
        Some(Self {
            position: transform.point(Vec3::ZERO),
            transform,
        })
    }

    fn refuse(params: &Params<'_>) {
        params.error_at(
            "to_world",
            format!(
                "`to_world` of `{}` may rotate, mirror, move and scale uniformly, nothing else",
                params.node.plugin.value
            ),
        );
    }

    /// The same for a light that may move.
    pub fn animated(params: &Params<'_>, build: &dyn Build) -> Option<Animated<Self>> {
        let keys = params.keyframes("to_world");
        if keys.len() == 1 {
            return Self::from_params(params).map(Animated::from);
        }
        let motion = build.shutter().motion(params, "to_world")?;
        if !motion.keeps_angles() {
            Self::refuse(params);
            return None;
        }
        Some(Animated::new(motion))
    }

    /// The world direction (unit) of a direction in the light's space.
    #[inline]
    pub fn to_world(&self, direction: Vec3) -> Vec3 {
        self.to_world_lanes::<f32>(direction)
    }

    /// The same of several directions.
    #[inline(always)]
    pub fn to_world_lanes<F: Lane>(&self, direction: F::Vector) -> F::Vector {
        self.transform.vectors::<F>(direction).normalized()
    }

    /// The direction (unit) in the light's space of a world direction.
    #[inline]
    pub fn to_local(&self, direction: Vec3) -> Vec3 {
        self.to_local_lanes::<f32>(direction)
    }

    /// The same of several directions.
    #[inline(always)]
    pub fn to_local_lanes<F: Lane>(&self, direction: F::Vector) -> F::Vector {
        (self.transform.inverse().vectors::<F>(direction)).normalized()
    }
}

impl FromAffine for Pose {
    fn from_affine(map: &DAffine3) -> Self {
        Self {
            position: map.translation.as_vec3(),
            transform: Transform::from_affine(map),
        }
    }
}

/// The light that a receiver gets from a point whose intensity (W·sr⁻¹·nm⁻¹) depends on the direction in its space.
#[inline]
pub fn sample_point(
    pose: &Animated<Pose>,
    from: &LightSampleContext,
    intensity: impl Fn(Vec3) -> Vec4,
) -> Option<LightSample> {
    let (position, local, to_light, direction) = pose.at(from.time, |pose| {
        let to_light = pose.position - from.position;
        let direction = to_light.try_normalize()?;
        let local = pose.to_local(-direction);
        Some((pose.position, local, to_light, direction))
    })?;
    let intensity = intensity(local);
    (intensity != Vec4::ZERO).then(|| LightSample {
        direction,
        target: Some(position),
        radiance: intensity / to_light.length_squared(),
        chance: SamplePdf::Discrete(DeltaProbability::uniform(1.0)),
        cos: 1.0,
        origin: LightKind::Point,
        extinction: Vec4::ONE,
        light: LightId::NONE,
    })
}

/// A particle from that point into a direction of its space, chosen with `density` (sr⁻¹).
#[inline]
pub fn emit_from_point(
    pose: &Animated<Pose>,
    local: Vec3,
    intensity: Vec4,
    density: f32,
    time: f32,
) -> Emission {
    let (position, direction) = pose.at(time, |pose| (pose.position, pose.to_world(local)));
    let ray = Ray::new(position, direction, time);
    Emission {
        point: Emission::point_of(&ray),
        ray,
        weight: intensity / density,
        density: EmissionPdf {
            origin: 1.0,
            ray: density,
        },
        origin: LightKind::Point,
        extinction: Vec4::ONE,
        light: LightId::NONE,
    }
}

/// Where a light without extent may be while the shutter is open, and whither it may shine: as `still` says if
/// it does not move, else in all directions from its way.
pub fn extent_of_way<T: FromAffine>(light: &Animated<T>, still: LightExtent) -> LightExtent {
    let Some(motion) = light.motion() else {
        return still;
    };
    let [low, high] = motion.swept(DVec3::ZERO, DVec3::ZERO);
    LightExtent {
        low,
        high,
        normals: DirectionCone::ALL,
        cos_edge: 0.0,
        ..still
    }
}
