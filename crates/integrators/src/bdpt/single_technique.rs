//! One technique of bidirectional path tracing alone, weighed against the others.
//!
//! Both subpaths go as far as the technique needs, and no farther. The numbers that decide them are
//! those of [`crate::bdpt`]: a technique that takes a vertex more from the camera and one less
//! from the light finds the rest of either subpath where it was.

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

/// The vertices of both subpaths, lent from sample to sample.
pub(crate) struct Subpaths<B> {
    camera_subpath: Vec<PathVertex<B>>,
    light_subpath: Vec<PathVertex<B>>,
}

impl<B> Default for Subpaths<B> {
    fn default() -> Self {
        Self {
            camera_subpath: Vec::new(),
            light_subpath: Vec::new(),
        }
    }
}

/// Samples a technique; `add` receives the positions and colours of its contributions.
pub(crate) fn sample_single_technique<'w, W: World, S: Sampler>(
    world: &'w W,
    settings: &PathSettings,
    technique: Technique,
    site: &PixelSample,
    sampler: &mut S,
    subpaths: &mut Subpaths<ScattererOf<'w, W>>,
    mut add: impl FnMut(Vec2, Vec3),
) {
    let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
    let sensor = world.sensor().weights(&wavelengths);
    let Subpaths {
        camera_subpath,
        light_subpath,
    } = subpaths;
    camera_subpath.clear();
    light_subpath.clear();
    let mut start = None;
    if let Some(limit) = technique.light.checked_sub(1).filter(|limit| *limit > 0) {
        start = FromLight::start(world, &wavelengths, settings, sampler, ray.time);
        let Some(start) = &mut start else {
            return;
        };
        start.trace(world, &wavelengths, settings, sampler, light_subpath, limit);
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
        light_subpath,
        camera_connects: false,
        radiance: Vec4::ZERO,
    };
    if technique.camera == 1 {
        connector.connect_to_camera(|raster, value| add(raster, sensor.rgb(value)));
        return;
    }
    let mut subpath = FromCamera::start(ray, settings);
    while camera_subpath.len() + 2 <= technique.camera
        && subpath.advance(
            world,
            &wavelengths,
            settings,
            sampler,
            camera_subpath,
            &mut connector,
        )
    {}
    add(site.raster, sensor.rgb(connector.radiance * weight));
}
