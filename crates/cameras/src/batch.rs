//! `batch`: several sensors, whose views stand side by side in one film, from the left.
//!
//! A film of W × H pixels and n sensors gives each W/n × H pixels, whatever film it has of its own. Near a border between two views a wide
//! filter mixes them, as in Mitsuba.

use crate::measured_surface::{MeasuredSurface, SensorShapes};
use crate::meter::unconnected;
use crate::{AnyCamera, FilmWindow};
use etalon_math::lane::Lane;
use etalon_params::{Class, Diagnostic, Params};
use etalon_transport::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample, Ray, Shutter};
use glam::{UVec2, Vec2, Vec3};

/// Several sensors.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch<S> {
    sensors: Vec<AnyCamera<S>>,
    /// Width of a view (px).
    width: f32,
}

impl<S: MeasuredSurface> Batch<S> {
    /// Reads the sensors inside.
    pub fn from_params(
        params: &Params<'_>,
        window: FilmWindow,
        shutter: &Shutter,
        shapes: &mut SensorShapes<'_, S>,
    ) -> Option<Self> {
        let inside = params.children(Class::Sensor);
        let count = u32::try_from(inside.len()).unwrap_or(u32::MAX);
        let UVec2 { x, y } = window.size;
        if count == 0 {
            params.error("a `batch` needs sensors inside");
            return None;
        }
        if x % count != 0 {
            let message = format!("a film {x} pixels wide cannot be divided among {count} sensors");
            let help = format!("give the film a `width` that is a multiple of {count}");
            let error = Diagnostic::error(params.node.plugin.span, message);
            params.diagnostics.push(error.help(help));
            return None;
        }
        let view = FilmWindow::whole(UVec2::new(x / count, y));
        let sensors = inside.iter().map(|(_, node)| {
            let child = Params::new(node, params.diagnostics);
            for class in [Class::Medium, Class::Sampler] {
                for (property, _) in child.children(class) {
                    let message =
                        format!("the {} of a `batch` stands in the `batch`", class.name());
                    (params.diagnostics).push(Diagnostic::error(property.span, message));
                }
            }
            for (property, _) in child.children(Class::Film) {
                let message = "this film is not used: the sensors of a `batch` share its film";
                (params.diagnostics).push(Diagnostic::note(property.span, message));
            }
            let sensor = AnyCamera::read(&child, view, shutter, shapes);
            child.finish_after(sensor.is_some());
            sensor
        });
        // All are read, so that all mistakes are found.
        let sensors: Vec<_> = sensors.collect();
        Some(Self {
            sensors: sensors.into_iter().collect::<Option<_>>()?,
            width: view.size.x as f32,
        })
    }

    /// The sensors, from the left.
    pub(crate) fn sensors(&self) -> &[AnyCamera<S>] {
        &self.sensors
    }

    /// The sensors, from the left.
    pub(crate) fn sensors_mut(&mut self) -> &mut [AnyCamera<S>] {
        &mut self.sensors
    }
}

impl<S: MeasuredSurface> Camera for Batch<S> {
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay {
        let last = self.sensors.len() - 1;
        let index = ((raster.x / self.width).max(0.0) as usize).min(last);
        let within = raster - Vec2::new(index as f32 * self.width, 0.0);
        self.sensors[index].ray(within, lens, time)
    }

    fn has_lens(&self) -> bool {
        self.sensors.iter().any(Camera::has_lens)
    }

    unconnected!();
}
