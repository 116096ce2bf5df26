//! The camera of the furnace.

use crate::world::Fault;
use etalon_math::lane::Lane;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Radius of the aperture that particles can hit.
const APERTURE: f32 = 0.6;

/// A pinhole camera at the origin that looks along z.
pub(crate) struct Pinhole {
    pub(crate) fault: Fault,
}

impl Camera for Pinhole {
    fn ray(&self, raster: Vec2, _: Vec2, time: f32) -> CameraRay {
        let direction = (raster * 2.0 - 1.0).extend(1.0).normalize();
        CameraRay {
            ray: Ray::new(Vec3::ZERO, direction, time),
            weight: 1.0,
        }
    }

    fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F> {
        CameraRays::one_by_one(self, raster, lens, time)
    }

    fn connect(&self, point: Vec3, _: Vec2, _: f32, _: f32) -> Option<CameraSample> {
        let raster = (point.truncate() / point.z + 1.0) * 0.5;
        let inside = point.z > 0.0 && raster.min_element() >= 0.0 && raster.max_element() <= 1.0;
        let cos = point.z / point.length();
        let power = if self.fault == Fault::Importance {
            2
        } else {
            3
        };
        inside.then(|| CameraSample {
            raster,
            direction: -point.normalize(),
            target: Vec3::ZERO,
            weight: 0.25 / (cos.powi(power) * point.length_squared()),
        })
    }

    /// A wide aperture about the pinhole. Its ray starts in the middle all the same: what it would
    /// see is the same from everywhere.
    fn intersect_aperture(&self, ray: &Ray, _: f32) -> Option<ApertureHit> {
        let t = -ray.origin.z / ray.direction.z;
        let slope = ray.direction.truncate() / ray.direction.z;
        let raster = (slope + 1.0) * 0.5;
        let inside = raster.min_element() >= 0.0 && raster.max_element() <= 1.0;
        let arrives = t > 0.0 && ray.direction.z < 0.0 && ray.at(t).length() < APERTURE;
        let cos = -ray.direction.z;
        let power = if self.fault == Fault::Importance {
            3
        } else {
            4
        };
        (inside && arrives).then(|| ApertureHit {
            raster,
            t,
            weight: 0.25 / (cos.powi(power) * PI * APERTURE * APERTURE),
        })
    }

    fn can_connect(&self) -> bool {
        true
    }

    fn can_receive(&self) -> bool {
        true
    }

    fn has_lens(&self) -> bool {
        false
    }
}
