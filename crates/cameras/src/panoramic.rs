//! Cameras at a point that see more than half of all directions: `spherical` and `fisheye`.
//!
//! A [`Projection`] takes unit directions d of camera space to the film, with the Jacobian J(d) in px²·sr⁻¹. The world
//! sees d along M·d, with M the linear part of the pose, whose solid angles are |det M|/|M·d|³ times as large, so a point at the
//! distance r is connected with the weight
//!
//! ```text
//! J(d) · |M·d|³ / (|det M| r²)
//! ```
//!
//! Near and far clipping are at distances from the camera, not at planes.

use crate::{ClipRange, FilmWindow, Pose};
use core::fmt::Debug;
use etalon_math::Animated;
use etalon_math::lane::Lane;
use etalon_params::Params;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{Vec2, Vec3};

/// A map between directions and a film.
pub trait Projection: Copy + Debug + PartialEq + Send + Sync {
    /// Whether a direction can be seen at several raster positions.
    const REPEATS: bool;

    /// The unit direction of camera space seen at a raster position, which may be outside of the film; `None` where nothing is seen.
    fn direction(&self, raster: Vec2) -> Option<Vec3>;

    /// A raster position at most `margin` pixels outside of the crop window that sees a unit direction, chosen by a number in [0, 1)
    /// if there are several, and the Jacobian there (px²·sr⁻¹) over the probability of the choice.
    fn raster(&self, direction: Vec3, choice: f32, margin: f32) -> Option<(Vec2, f32)>;
}

/// A camera at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Panoramic<P> {
    pose: Animated<Pose>,
    projection: P,
    near: f32,
    far: f32,
}

impl<P: Projection> Panoramic<P> {
    /// Reads `near_clip`, `far_clip` and `to_world`; `project` reads the projection.
    pub fn from_params(
        params: &Params<'_>,
        window: FilmWindow,
        shutter: &Shutter,
        project: impl FnOnce(&Params<'_>, FilmWindow) -> P,
    ) -> Option<Self> {
        let projection = project(params, window);
        let clip = ClipRange::from_params(params);
        Some(Self {
            pose: Pose::from_params(params, true, shutter)?,
            projection,
            near: clip.near as f32,
            far: clip.far as f32,
        })
    }
}

impl<P: Projection> Camera for Panoramic<P> {
    #[inline]
    fn ray(&self, raster: Vec2, _: Vec2, time: f32) -> CameraRay {
        let local = self.projection.direction(raster);
        self.pose.at(time, |pose| {
            let seen = pose.vector(local.unwrap_or(Vec3::Z));
            let length = seen.length();
            let mut ray = Ray::new(pose.position + seen * self.near, seen / length, time);
            // Beyond the image circle a ray ends where it starts, and does not count.
            ray.t_max = local.map_or(0.0, |_| (self.far - self.near) * length);
            CameraRay {
                ray,
                weight: f32::from(u8::from(local.is_some())),
            }
        })
    }

    fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
        CameraRays::one_by_one(self, raster, lens, time)
    }

    #[inline]
    fn connect(&self, point: Vec3, lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        self.pose.at(time, |pose| {
            let local = pose.to_camera(point);
            let depth = local.length();
            if !(depth > self.near && depth < self.far) {
                return None;
            }
            let (raster, per_angle) = self.projection.raster(local / depth, lens.x, margin)?;
            let to_point = point - pose.position;
            let distance = to_point.length();
            let stretch = distance / depth;
            Some(CameraSample {
                raster,
                direction: -to_point / distance,
                target: pose.position + to_point * (self.near / depth),
                weight: per_angle * stretch * stretch * stretch
                    / (pose.volume * distance * distance),
            })
        })
    }

    fn can_connect(&self) -> bool {
        true
    }

    fn has_lens(&self) -> bool {
        // It chooses among raster positions.
        P::REPEATS
    }

    fn intersect_aperture(&self, _: &Ray, _: f32) -> Option<ApertureHit> {
        None
    }

    fn can_receive(&self) -> bool {
        false
    }
}
