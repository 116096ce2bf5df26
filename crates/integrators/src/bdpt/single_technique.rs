//! One technique of bidirectional path tracing alone, weighed against the others.
//!
//! Both walks go as far as the technique needs, and no farther. The numbers that decide them are
//! those of [`crate::bdpt`]: a technique that takes a vertex more from the camera and one less
//! from the light finds the rest of either walk where it was.

use super::connect::Connector;
use super::from_camera::FromCamera;
use super::from_light::FromLight;
use super::path_vertex::PathVertex;
use super::technique::Technique;
use crate::steps::camera_ray::camera_ray;
use crate::steps::dimensions as dim;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_transport::{PixelSample, ScattererOf, Sensor, World};
use glam::{Vec2, Vec3, Vec4};

/// The corners of both walks, lent from sample to sample.
pub(crate) struct Lists<B> {
    eye: Vec<PathVertex<B>>,
    light: Vec<PathVertex<B>>,
}

impl<B> Default for Lists<B> {
    fn default() -> Self {
        Self {
            eye: Vec::new(),
            light: Vec::new(),
        }
    }
}

/// Samples a technique; `found` receives the positions and colours of its contributions.
pub(crate) fn sample<'w, W: World, S: Sampler>(
    world: &'w W,
    settings: &PathSettings,
    technique: Technique,
    site: &PixelSample,
    sampler: &mut S,
    lists: &mut Lists<ScattererOf<'w, W>>,
    mut found: impl FnMut(Vec2, Vec3),
) {
    let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
    let sensor = world.sensor().weights(&wavelengths);
    let Lists { eye, light } = lists;
    eye.clear();
    light.clear();
    let mut start = None;
    if let Some(corners) = technique
        .light
        .checked_sub(1)
        .filter(|corners| *corners > 0)
    {
        start = FromLight::start(world, &wavelengths, settings, sampler, ray.time);
        let Some(start) = &mut start else {
            return;
        };
        start.walk(world, &wavelengths, settings, sampler, light, corners);
    }
    sampler.skip_to(dim::LENS);
    let mut connector = Connector {
        world,
        wavelengths: &wavelengths,
        settings,
        merging: None,
        only: Some(technique),
        site,
        lens: sampler.next_2d(),
        start: start.as_ref(),
        light,
        camera_connects: false,
        radiance: Vec4::ZERO,
    };
    if technique.camera == 1 {
        connector.see_all(|raster, value| found(raster, sensor.rgb(value)));
        return;
    }
    let mut walk = FromCamera::start(ray, settings);
    while eye.len() + 2 <= technique.camera
        && walk.advance(world, &wavelengths, settings, sampler, eye, &mut connector)
    {}
    found(site.raster, sensor.rgb(connector.radiance * weight));
}
