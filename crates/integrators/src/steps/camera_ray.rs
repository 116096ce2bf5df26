//! The camera ray of a sample: what every estimator that looks from the camera begins with.

use crate::steps::dimensions as dim;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Camera, Media, PixelSample, Ray, Sensor, World};
use glam::Vec2;

/// The random numbers of a sample's lens point, wavelengths and time.
#[inline]
pub(crate) fn draw_lens(sampler: &mut impl Sampler) -> (Vec2, f32, f32) {
    sampler.skip_to(dim::LENS);
    (sampler.next_2d(), sampler.next_1d(), sampler.next_1d())
}

/// Draws the wavelengths and the camera ray of a sample: everything before the first surface.
#[inline]
pub(crate) fn camera_ray<W: World, S: Sampler>(
    world: &W,
    site: &PixelSample,
    sampler: &mut S,
) -> (Wavelengths, Ray, f32) {
    let (lens, u, time) = draw_lens(sampler);
    let time = world.moment(site.raster, time);
    let (ray, weight) = ray_at(world, site, lens, time);
    (world.sensor().wavelengths(u), ray, weight)
}

/// The camera ray of a sample through a point of the lens, at the moment `time`.
#[inline]
pub(crate) fn ray_at<W: World>(world: &W, site: &PixelSample, lens: Vec2, time: f32) -> (Ray, f32) {
    let start = world.camera().ray(site.raster, lens, time);
    let ray = Ray {
        medium: world.media().around_camera(),
        ..start.ray
    };
    (ray, start.weight)
}
