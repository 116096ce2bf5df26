//! `perspective`: the pinhole camera.
//!
//! A raster position x sees along P = M·(X, Y, 1), with M the linear part of the pose. A
//! pixel's worth of directions covers
//!
//! ```text
//! dω = |det M| · dX dY / |P|³
//! ```
//!
//! so a point at distance r and camera-space depth z, where |P| = r/z, is connected with weight
//! (dx/dω)/r² = r / (z³ · |det M| · pixel area). This is the importance of Veach (1997, section
//! 8.2) in units of pixels.

use crate::pose::LanePose;
use crate::{ClipRange, FilmWindow, ImagePlane, Pose};
use etalon_math::Animated;
use etalon_math::lane::{Lane, Vector};
use etalon_params::Params;
use etalon_params::field_of_view::half_width_from_params;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{DVec2, Vec2, Vec3};

/// A pinhole camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Perspective {
    pose: Animated<Pose>,
    image: ImagePlane,
    near: f32,
    far: f32,
}

impl Perspective {
    /// A pinhole camera with tan(φ/2) of the horizontal field of view on `image`.
    pub fn new(pose: Animated<Pose>, image: ImagePlane, clip: ClipRange) -> Self {
        Self {
            pose,
            image,
            near: clip.near as f32,
            far: clip.far as f32,
        }
    }

    /// Reads `fov`, `fov_axis`, `focal_length`, `near_clip`, `far_clip`,
    /// `principal_point_offset_x`, `principal_point_offset_y` and `to_world`.
    pub fn from_params(params: &Params<'_>, window: FilmWindow, shutter: &Shutter) -> Option<Self> {
        let finite = |name| params.float_where(name, 0.0, "a finite number", f64::is_finite);
        let offset = DVec2::new(
            finite("principal_point_offset_x"),
            finite("principal_point_offset_y"),
        );
        let half_width = half_width_from_params(params, window.aspect());
        let clip = ClipRange::from_params(params);
        let pose = Pose::from_params(params, true, shutter)?;
        Some(Self::new(
            pose,
            ImagePlane::new(window, half_width, offset),
            clip,
        ))
    }
}

impl Camera for Perspective {
    #[inline]
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        (self.rays::<f32>(raster.into(), lens.into(), time)).lanes()(0, time)
    }

    #[inline(always)]
    fn rays<F: Lane>(&self, raster: [F; 2], _: [F; 2], time: F) -> CameraRays<F> {
        let pose = LanePose::at(&self.pose, time);
        let [x, y] = self.image.points(raster);
        let seen = pose.vector([x, y, F::ONE]);
        let length = seen.norm();
        CameraRays {
            origin: pose.position + seen * F::splat(self.near),
            direction: seen.over(length),
            t_max: F::splat(self.far - self.near) * length,
            weight: F::ONE,
        }
    }

    #[inline]
    fn connect(&self, point: Vec3, _lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        self.pose.at(time, |pose| {
            let local = pose.to_camera(point);
            let depth = local.z;
            if !(depth > self.near && depth < self.far) {
                return None;
            }
            let raster = self.image.raster(local.truncate() / depth);
            if !self.image.window.contains(raster, margin) {
                return None;
            }
            let to_point = point - pose.position;
            let distance = to_point.length();
            let seen = to_point / depth;
            Some(CameraSample {
                raster,
                direction: -to_point / distance,
                target: pose.position + seen * self.near,
                weight: distance / (depth * depth * depth * pose.volume * self.image.pixel_area()),
            })
        })
    }

    fn can_connect(&self) -> bool {
        true
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
