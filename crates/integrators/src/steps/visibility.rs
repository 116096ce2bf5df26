//! What a camera that looks through lights (`hide_emitters`) sees of a point on a surface.
//!
//! It looks through those that are nothing but lights between them and the camera. A light behind a
//! surface that lets light pass is seen, and in the way, like any other surface; so is the point
//! itself, unless it lies on a light that is hidden.

use crate::steps::arrival;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, Lights, Ray, Surfaces, Transmission, World};
use glam::Vec4;

/// A way to the camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CameraVisibility {
    /// Straight travel past all surfaces that are not looked through.
    pub(crate) transmission: Transmission,
    /// Whether a light is looked through.
    pub(crate) through_emitter: bool,
}

/// The way along `segment` to the camera, from a surface that is a light (`on_light`) or not, past at most so many
/// surfaces; `None` if nothing is seen.
pub(crate) fn camera_visibility<W: World>(
    world: &W,
    wavelengths: &Wavelengths,
    segment: Ray,
    on_light: bool,
    mut crossings: u32,
) -> Option<CameraVisibility> {
    let mut ray = segment;
    let mut transmission = Transmission::FREE;
    // Lights that nothing follows so far, and whether the way starts on one of them.
    let (mut lights, mut past_lights) = (0, Transmission::FREE);
    let mut hidden = on_light;
    loop {
        let hit = world.surfaces().intersect(&ray);
        if let Some(stretch) = arrival::transmittance(world, &ray, hit.as_ref(), wavelengths) {
            transmission.then(&stretch);
        }
        let Some(hit) = hit else { break };
        let vertex = world.surfaces().vertex(&ray, &hit);
        let bsdf = world.surfaces().bsdf(&vertex, -ray.direction, wavelengths);
        lights += 1;
        past_lights.transmittance *= bsdf.null_transmittance();
        past_lights.probability *= bsdf.null_probability();
        if !world.lights().is_emitter(&hit) {
            // The lights before this surface are in the way like itself.
            crossings = crossings.checked_sub(lights)?;
            transmission.then(&past_lights);
            if transmission.transmittance == Vec4::ZERO {
                return None;
            }
            (lights, past_lights) = (0, Transmission::FREE);
            hidden = false;
        }
        let Some(rest) = vertex.rest_of(&segment) else {
            break;
        };
        ray = rest;
    }
    (!hidden).then_some(CameraVisibility {
        transmission,
        through_emitter: lights > 0,
    })
}
