//! The camera of the layers.

use etalon_math::lane::Lane;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray};
use glam::{Vec2, Vec3};

/// A camera with one slanted ray.
#[derive(Clone, Copy)]
pub(crate) struct Camera1D {
    pub height: f32,
    pub up: bool,
    /// Before this moment it sees nothing.
    pub sees_after: f32,
}

impl Camera for Camera1D {
    fn ray(&self, _: Vec2, _: Vec2, time: f32) -> CameraRay {
        let z = if self.up { 0.8 } else { -0.8 };
        CameraRay {
            ray: Ray::new(Vec3::Z * self.height, Vec3::new(0.6, 0.0, z), time),
            weight: if time < self.sees_after { 0.0 } else { 1.0 },
        }
    }
    fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
        CameraRays::one_by_one(self, raster, lens, time)
    }

    fn connect(&self, _: Vec3, _: Vec2, _: f32, _: f32) -> Option<CameraSample> {
        None
    }
    fn can_connect(&self) -> bool {
        false
    }
    fn has_lens(&self) -> bool {
        false
    }
    fn intersect_aperture(&self, _: &Ray, _: f32) -> Option<ApertureHit> {
        None
    }
    fn can_receive(&self) -> bool {
        false
    }
}
