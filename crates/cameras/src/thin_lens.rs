//! `thinlens`: a perspective camera with an ideal thin lens (depth of field).
//!
//! A point a of the aperture (uniform on a disk of radius R in the plane z = 0) and a raster
//! position see along P = M·((f·(X, Y) − a)/f, 1): all rays of one raster position meet at the
//! focal plane z = f (Cook, Porter, Carpenter 1984). For a fixed a the lens is a pinhole at a
//! whose image plane is shifted, so the Jacobian is that of the pinhole camera with r measured
//! from a; the aperture point is drawn with the same density for rays and for connections, which
//! therefore cancels.
//!
//! A particle that by chance arrives at a along −P carries flux through the aperture, whose area
//! in the world is A = πR²·|M x̂ × M ŷ|. Since a pixel is the mean over A of the radiance, a unit of
//! flux counts
//!
//! ```text
//! dx/dω / (A·cos θ) = |P|⁴ / (πR²·|det M|²·pixel area),   as cos θ = |det M| / (|P|·|M x̂ × M ŷ|)
//! ```

use crate::lens::Lens;
use crate::pose::LanePose;
use crate::{ClipRange, FilmWindow, ImagePlane, Pose};
use etalon_math::Animated;
use etalon_math::lane::{Lane, Vector};
use etalon_params::Params;
use etalon_sampling::warps::concentric_disk;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{DVec2, Vec2, Vec3};

/// A camera with an ideal lens.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinLens {
    pose: Animated<Pose>,
    image: ImagePlane,
    near: f32,
    far: f32,
    aperture_radius: f32,
    /// 1/f (m⁻¹).
    focus: f32,
}

impl ThinLens {
    /// A lens of `aperture_radius` (m; zero makes a pinhole) focused on the plane at
    /// `focus_distance` (m, positive) along the camera's axis.
    pub fn new(
        pose: Animated<Pose>,
        image: ImagePlane,
        clip: ClipRange,
        aperture_radius: f64,
        focus_distance: f64,
    ) -> Self {
        Self {
            pose,
            image,
            near: clip.near as f32,
            far: clip.far as f32,
            aperture_radius: aperture_radius as f32,
            focus: (1.0 / focus_distance) as f32,
        }
    }

    /// Reads the parameters of [`Lens`], where `focus_distance` is the far clipping distance by default, as Mitsuba
    /// has it, and those of `perspective`. The principal point's offset is an
    /// extension: Mitsuba's lens has none.
    pub fn from_params(params: &Params<'_>, window: FilmWindow, shutter: &Shutter) -> Option<Self> {
        let finite = |name| params.float_where(name, 0.0, "a finite number", f64::is_finite);
        let offset = DVec2::new(
            finite("principal_point_offset_x"),
            finite("principal_point_offset_y"),
        );
        let clip = ClipRange::from_params(params);
        let lens = Lens::from_params(params, window.aspect(), clip.far);
        let pose = Pose::from_params(params, true, shutter)?;
        let Lens {
            aperture_radius,
            focus_distance,
            half_width,
        } = lens?;
        let image = ImagePlane::new(window, half_width, offset);
        Some(Self::new(
            pose,
            image,
            clip,
            aperture_radius,
            focus_distance,
        ))
    }

    /// The aperture point (camera space, z = 0) chosen by `lens`.
    #[inline]
    fn aperture<F: Lane>(&self, lens: [F; 2]) -> [F; 2] {
        concentric_disk(lens).map(|coordinate| coordinate * self.aperture_radius)
    }
}

impl Camera for ThinLens {
    #[inline]
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        (self.rays::<f32>(raster.into(), lens.into(), time)).lanes()(0, time)
    }

    #[inline(always)]
    fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
        let pose = LanePose::at(&self.pose, time);
        let [a, b] = self.aperture(lens);
        let [x, y] = self.image.points(raster);
        let seen = pose.vector([x - a * self.focus, y - b * self.focus, F::ONE]);
        let length = seen.norm();
        let start = pose.vector([a, b, F::ZERO]) + seen * F::splat(self.near);
        CameraRays {
            origin: pose.position + start,
            direction: seen.over(length),
            t_max: F::splat(self.far - self.near) * length,
            weight: F::ONE,
        }
    }

    #[inline]
    fn connect(&self, point: Vec3, lens: Vec2, time: f32, margin: f32) -> Option<CameraSample> {
        self.pose.at(time, |pose| {
            let local = pose.to_camera(point);
            let depth = local.z;
            if !(depth > self.near && depth < self.far) {
                return None;
            }
            let aperture = Vec2::from(self.aperture(lens.to_array()));
            let slope = (local.truncate() - aperture) / depth;
            let raster = self.image.raster(slope + aperture * self.focus);
            if !self.image.window.contains(raster, margin) {
                return None;
            }
            let origin = pose.position + pose.vector(aperture.extend(0.0));
            let to_point = point - origin;
            let distance = to_point.length();
            Some(CameraSample {
                raster,
                direction: -to_point / distance,
                target: origin + to_point * (self.near / depth),
                weight: distance / (depth * depth * depth * pose.volume * self.image.pixel_area()),
            })
        })
    }

    #[inline]
    fn intersect_aperture(&self, ray: &Ray, margin: f32) -> Option<ApertureHit> {
        self.pose.at(ray.time, |pose| {
            // In camera space the ray is o + t·d and the aperture lies in z = 0, looking toward +z.
            let origin = pose.to_camera(ray.origin);
            let direction = pose.to_camera(pose.position + ray.direction);
            let seen = origin.z > self.near && origin.z < self.far;
            if !(seen && direction.z < 0.0 && self.aperture_radius > 0.0) {
                return None;
            }
            let slope = direction.truncate() / direction.z;
            let aperture = origin.truncate() - slope * origin.z;
            if !(aperture.length_squared() < self.aperture_radius * self.aperture_radius) {
                return None;
            }
            let raster = self.image.raster(slope + aperture * self.focus);
            if !self.image.window.contains(raster, margin) {
                return None;
            }
            let depth_per_length = -direction.z;
            let area = core::f32::consts::PI * self.aperture_radius * self.aperture_radius;
            let volume = pose.volume;
            let fourth_power = (depth_per_length * depth_per_length).powi(2);
            Some(ApertureHit {
                raster,
                t: (origin.z - self.near) / depth_per_length,
                weight: 1.0 / (fourth_power * volume * volume * self.image.pixel_area() * area),
            })
        })
    }

    fn can_receive(&self) -> bool {
        self.aperture_radius > 0.0
    }

    fn can_connect(&self) -> bool {
        true
    }

    fn has_lens(&self) -> bool {
        self.aperture_radius > 0.0
    }
}
