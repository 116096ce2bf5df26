//! `irradiancemeter`: the irradiance on a shape, averaged over its area (W·m⁻²·nm⁻¹ before the film's response).
//!
//! ```text
//! E = 1/A ∫∫ L(x, ω) cos θ dω dA
//! ```
//!
//! A ray starts where the raster position, a part of the film, chooses a point uniformly by area, and goes in a direction that `lens` chooses
//! with the density cos θ/π on the outer side: its radiance counts π times. Several pixels divide the surface among them, by its own
//! parameters.

use crate::FilmWindow;
use crate::measured_surface::MeasuredSurface;
use crate::meter::unconnected;
use core::f32::consts::PI;
use etalon_math::Frame;
use etalon_math::lane::Lane;
use etalon_params::Params;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray};
use glam::{Vec2, Vec3};

/// A surface that light falls on.
#[derive(Clone, Debug, PartialEq)]
pub struct IrradianceMeter<S> {
    surface: S,
    size: Vec2,
}

impl<S: MeasuredSurface> IrradianceMeter<S> {
    /// The meter of the shape that the sensor is a child of.
    pub fn from_params(
        params: &Params<'_>,
        window: FilmWindow,
        carrier: Option<&S>,
    ) -> Option<Self> {
        if params.has("to_world") {
            let message = "an `irradiancemeter` is where its shape is";
            let help = "move the shape, and leave `to_world` out here";
            params.error_with_help("to_world", message, help);
            return None;
        }
        let Some(surface) = carrier else {
            params.error("an `irradiancemeter` must be the child of a shape");
            return None;
        };
        Some(Self {
            surface: surface.clone(),
            size: window.size.as_vec2(),
        })
    }
}

impl<S: MeasuredSurface> Camera for IrradianceMeter<S> {
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        let below_one = Vec2::splat(1.0 - 0.5 * f32::EPSILON);
        let point = self
            .surface
            .point((raster / self.size).clamp(Vec2::ZERO, below_one));
        let local = square_to_cosine_hemisphere(lens);
        let direction = Frame::from_normal(point.normal).to_world(local);
        CameraRay {
            ray: Ray::new(point.origin_along(direction), direction, time),
            weight: PI,
        }
    }

    fn has_lens(&self) -> bool {
        true
    }

    unconnected!();
}
