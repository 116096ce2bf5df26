//! `distant`: the radiance that leaves a scene in one direction, seen from infinity.
//!
//! Rays run along d = M·ẑ/|M·ẑ| and count alike:
//!
//! - without `target`, they are uniform on the cross-section of the scene's bounding sphere, which is the sphere around its bounding box;
//! - with a point, they all meet it;
//! - with a shape, they meet points of it that are uniform by area. The shape is no part of the scene.

use crate::measured_surface::{MeasuredSurface, SensorShapes};
use crate::meter::{aim, axis, has_one_pixel, unconnected};
use crate::{FilmWindow, Pose};
use etalon_math::lane::Lane;
use etalon_math::{Animated, Frame};
use etalon_params::{Class, Params};
use etalon_sampling::warps::square_to_concentric_disk;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{Vec2, Vec3};

/// What the rays meet.
#[derive(Clone, Debug, PartialEq)]
enum Target<S> {
    Scene,
    Point(Vec3),
    Surface(S),
}

/// Parallel rays from infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct Distant<S> {
    pose: Animated<Pose>,
    target: Target<S>,
    /// Centre and radius of the scene's bounding sphere (m).
    centre: Vec3,
    radius: f32,
}

impl<S: MeasuredSurface> Distant<S> {
    /// Reads `direction` or `to_world`, and `target`.
    pub fn from_params(
        params: &Params<'_>,
        window: FilmWindow,
        shutter: &Shutter,
        shapes: &mut SensorShapes<'_, S>,
    ) -> Option<Self> {
        let pose = aim(params, false, shutter);
        let one = has_one_pixel(params, window);
        let target = match params.child(Class::Shape) {
            Some(node) => Target::Surface((shapes.read)(node)?),
            None => match params.vector("target") {
                Some(point) if point.is_finite() => Target::Point(point.as_vec3()),
                Some(_) => {
                    params.error_at("target", "`target` must be finite");
                    return None;
                }
                None => Target::Scene,
            },
        };
        pose.filter(|_| one).map(|pose| Self {
            pose,
            target,
            centre: Vec3::ZERO,
            radius: 0.0,
        })
    }

    /// Tells it the bounds of the scene.
    pub(crate) fn surround(&mut self, [low, high]: [Vec3; 2]) {
        let half = (high - low) * 0.5;
        // Nothing is nowhere.
        if half.min_element() >= 0.0 {
            self.centre = low + half;
            self.radius = half.length();
        }
    }
}

impl<S: MeasuredSurface> Camera for Distant<S> {
    fn ray(&self, _: Vec2, lens: Vec2, time: f32) -> CameraRay {
        let direction = self.pose.at(time, axis);
        let met = match &self.target {
            Target::Scene => {
                let frame = Frame::from_normal(direction);
                let Vec2 { x, y } = square_to_concentric_disk(lens) * self.radius;
                self.centre + frame.s * x + frame.t * y
            }
            Target::Point(point) => *point,
            Target::Surface(surface) => surface.point(lens).position,
        };
        // Ahead of everything.
        let behind = (met - self.centre).dot(direction) + 1.001 * self.radius;
        let origin = met - direction * behind.max(0.0);
        CameraRay {
            ray: Ray::new(origin, direction, time),
            weight: 1.0,
        }
    }

    fn has_lens(&self) -> bool {
        !matches!(self.target, Target::Point(_))
    }

    unconnected!();
}
