//! `radiancemeter`: the radiance along one ray.

use crate::meter::{aim, axis, has_one_pixel, unconnected};
use crate::{FilmWindow, Pose};
use etalon_math::Animated;
use etalon_math::lane::Lane;
use etalon_params::Params;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{Vec2, Vec3};

/// A ray.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceMeter {
    pose: Animated<Pose>,
}

impl RadianceMeter {
    /// Reads `origin` and `direction`, or `to_world`.
    pub fn from_params(params: &Params<'_>, window: FilmWindow, shutter: &Shutter) -> Option<Self> {
        let pose = aim(params, true, shutter);
        let one = has_one_pixel(params, window);
        pose.filter(|_| one).map(|pose| Self { pose })
    }
}

impl Camera for RadianceMeter {
    fn ray(&self, _: Vec2, _: Vec2, time: f32) -> CameraRay {
        self.pose.at(time, |pose| CameraRay {
            ray: Ray::new(pose.position, axis(pose), time),
            weight: 1.0,
        })
    }

    fn has_lens(&self) -> bool {
        false
    }

    unconnected!();
}
