//! `orthographic`: parallel rays through a window of the camera's xy plane.
//!
//! The film spans x ∈ [−1, 1] of camera space and, pixels being square, y ∈ [−h/w, h/w]; scale in
//! the pose M resizes it. All rays run along d = M·ẑ/|M·ẑ|. A pixel of camera-space area a
//! is a beam of cross-section a·|det M|/|M·ẑ|, so a connection weighs |M·ẑ|/(a·|det M|)
//! at any distance.
//!
//! As in Mitsuba, rays start at the image of the near plane and end `far_clip − near_clip`
//! farther in *world* units, also if the pose scales z.

use crate::pose::LanePose;
use crate::{ClipRange, FilmWindow, Pose};
use etalon_math::Animated;
use etalon_math::lane::{Lane, Vector};
use etalon_params::Params;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{Vec2, Vec3};

/// A camera without perspective.
#[derive(Clone, Debug, PartialEq)]
pub struct Orthographic {
    pose: Animated<Pose>,
    window: FilmWindow,
    /// Camera-space point seen at raster (0, 0).
    corner: Vec2,
    /// Side of a pixel in camera space.
    pixel: f32,
    near: f32,
    /// Length of the rays (m).
    length: f32,
}

impl Orthographic {
    /// An orthographic camera.
    pub fn new(pose: Animated<Pose>, window: FilmWindow, clip: ClipRange) -> Self {
        let pixel = (2.0 / f64::from(window.size.x)) as f32;
        Self {
            pose,
            window,
            corner: Vec2::new(1.0, (1.0 / window.aspect()) as f32),
            pixel,
            near: clip.near as f32,
            length: (clip.far - clip.near) as f32,
        }
    }

    /// Reads `near_clip`, `far_clip` and `to_world`.
    pub fn from_params(params: &Params<'_>, window: FilmWindow, shutter: &Shutter) -> Option<Self> {
        let clip = ClipRange::from_params(params);
        let pose = Pose::from_params(params, false, shutter)?;
        Some(Self::new(pose, window, clip))
    }
}

impl Orthographic {
    /// The direction of all rays, M·ẑ/|M·ẑ|, and |M·ẑ|.
    #[inline]
    fn axis(pose: &Pose) -> (Vec3, f32) {
        let axis = pose.vector(Vec3::Z);
        let stretch = axis.length();
        (axis / stretch, stretch)
    }
}

impl Camera for Orthographic {
    #[inline]
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        (self.rays::<f32>(raster.into(), lens.into(), time)).lanes()(0, time)
    }

    #[inline(always)]
    fn rays<F: Lane>(&self, [x, y]: [F; 2], _: [F; 2], time: F) -> CameraRays<F> {
        let pose = LanePose::at(&self.pose, time);
        let local = [
            F::splat(self.corner.x) - x * self.pixel,
            F::splat(self.corner.y) - y * self.pixel,
            F::splat(self.near),
        ];
        let axis = pose.vector([F::ZERO, F::ZERO, F::ONE]);
        CameraRays {
            origin: pose.position + pose.vector(local),
            direction: axis.over(axis.norm()),
            t_max: F::splat(self.length),
            weight: F::ONE,
        }
    }

    #[inline]
    fn connect(&self, point: Vec3, _lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        self.pose.at(time, |pose| {
            let local = pose.to_camera(point);
            let (direction, stretch) = Self::axis(pose);
            let t = (local.z - self.near) * stretch;
            if !(t > 0.0 && t < self.length) {
                return None;
            }
            let raster = (self.corner - local.truncate()) / self.pixel;
            self.window.contains(raster, margin).then(|| CameraSample {
                raster,
                direction: -direction,
                target: point - direction * t,
                weight: stretch / (self.pixel * self.pixel * pose.volume),
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
