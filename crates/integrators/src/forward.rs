//! `forward`: light particles that bounce until, by chance, they hit the camera's aperture.
//!
//! The simplest complete algorithm, and nature's own: a particle of flux Φ = Le·|cos θ| / p leaves a
//! light and scatters; if it hits the aperture, it contributes where the lens focuses it,
//!
//! ```text
//! splat = Φ · Π f·|cos θ| / p · dx/dω / (A·cos θ)
//! ```
//!
//! with A the aperture's area, θ the angle of arrival, and dx/dω the film's area per solid angle
//! through that point of the lens ([`etalon_transport::ApertureHit`]). It is `ptracer` without
//! connections, and slow: of the particles in a room of surface S a share of about A/S arrives per
//! bounce. Its advantage over `ptracer` is that it sees by way of mirrors and glass. A pinhole is never
//! hit, so it refuses one.
//!
//! Particles from the sky start on a disk outside the scene and would miss a camera outside it, so the
//! visible sky (paths of one segment) is found by a camera ray per sample, which also gives alpha.
//! Lights without extent are invisible, as for every estimator. With `hide_emitters` the camera sees
//! through lights, as that of `path` does.

use crate::steps::arrival;
use crate::steps::camera_ray::camera_ray;
use crate::steps::light_path::LightPath;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    Bsdf, Camera, Channel, Incompatibility, Integrator, LightKind, LightSearch, Lights, Pass,
    PixelSample, Placing, Ray, SceneCapabilities, Sensor, Sink, Subject, Surfaces, World,
    one_by_one,
};
use glam::Vec4;

/// The tracer of particles that are left alone.
#[derive(Clone, Debug, Default)]
pub struct Forward {
    /// Limits of the path.
    pub settings: PathSettings,
}

impl Forward {
    /// Reads the integrator from its description: Mitsuba's parameters of paths.
    pub fn from_params(params: &Params<'_>) -> Self {
        Self {
            settings: PathSettings::from_params(params),
        }
    }

    /// The sky where the camera sees it through nothing, and the fraction of light that does not
    /// come from behind it all.
    fn straight<W: World>(
        &self,
        world: &W,
        mut ray: Ray,
        wavelengths: &Wavelengths,
    ) -> (Vec4, f32) {
        let hide = self.settings.hide_emitters;
        let mut through = Vec4::ONE;
        let mut depth = 1;
        while depth <= self.settings.max_depth {
            let hit = arrival::next_hit(world, &mut ray, hide && depth == 1);
            if let Some(transmission) =
                arrival::transmittance(world, &ray, hit.as_ref(), wavelengths)
            {
                through *= transmission.transmittance;
            }
            let Some(hit) = hit else {
                if hide || !world.lights().has_background() {
                    break;
                }
                let sky = match depth {
                    1 => world
                        .lights()
                        .background(ray.direction, ray.time, wavelengths),
                    _ => Vec4::ZERO,
                };
                let radiance = PathThroughput::START.contribution(through * sky, Vec4::ZERO);
                return (radiance, 1.0);
            };
            let vertex = world.surfaces().vertex(&ray, &hit);
            let bsdf = world.surfaces().bsdf(&vertex, -ray.direction, wavelengths);
            through *= bsdf.null_probability();
            depth += 1;
            if through == Vec4::ZERO {
                break;
            }
            ray = vertex.spawn(ray.direction);
        }
        (Vec4::ZERO, 1.0 - 0.25 * through.element_sum())
    }

    /// Transmittance of a segment to the camera; `None` if a surface occludes it.
    fn arrives<W: World>(
        &self,
        world: &W,
        segment: Ray,
        wavelengths: &Wavelengths,
    ) -> Option<Vec4> {
        let mut ray = segment;
        let mut arriving = Vec4::ONE;
        loop {
            let hit = world.surfaces().intersect(&ray);
            if let Some(transmission) =
                arrival::transmittance(world, &ray, hit.as_ref(), wavelengths)
            {
                arriving *= transmission.transmittance;
            }
            let Some(hit) = hit else { break };
            if !(self.settings.hide_emitters && world.lights().is_emitter(&hit)) {
                return None;
            }
            // The camera looks through hidden lights.
            let Some(rest) = world.surfaces().vertex(&ray, &hit).rest_of(&segment) else {
                break;
            };
            ray = rest;
        }
        Some(arriving)
    }

    /// One particle, splatted whenever it hits the aperture.
    fn trace<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        site: &PixelSample,
        (wavelengths, sensor, time): (&Wavelengths, &SensorWeights, f32),
        sampler: &mut S,
        sink: &mut K,
    ) {
        let PathSettings {
            max_depth,
            rr_depth,
            hide_emitters,
        } = self.settings;
        let Some((start, mut particle)) = LightPath::emit(world, wavelengths, sampler, time) else {
            return;
        };
        // Whether the particle has only passed surfaces straight since it left the light, and
        // whether its ray starts on a surface that emits.
        let mut straight = true;
        let mut on_light = !start.origin.is_infinite() && start.origin != LightKind::Medium;
        while particle.depth <= max_depth {
            let LightPath { ray, depth, .. } = particle;
            let extent = start.origin.can_be_hit();
            let sky = start.origin.is_infinite();
            let unseen = straight && (!extent || sky && (depth == 1 || hide_emitters));
            let hidden = hide_emitters && on_light;
            if !(unseen || hidden) {
                let reception = world.camera().intersect_aperture(&ray, site.margin);
                let arriving = |t_max| self.arrives(world, Ray { t_max, ..ray }, wavelengths);
                if let Some(found) = reception
                    && let Some(arriving) = arriving(found.t)
                {
                    let weight = arriving * found.weight;
                    let value = particle.throughput.contribution(weight, Vec4::ZERO);
                    let rgb = sensor.rgb(value) / site.pixels as f32;
                    sink.splat(found.raster, rgb.to_array());
                }
            }
            if depth == max_depth {
                return;
            }
            let Some(vertex) = particle.next(world, sampler) else {
                return;
            };
            let Some(sample) = particle.scatter(&vertex, rr_depth) else {
                return;
            };
            straight &= sample.is_null;
            on_light = vertex.point.light.is_some();
        }
    }
}

impl Integrator for Forward {
    const UNBIASED: bool = true;
    const MEDIA: bool = true;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = true;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        true
    }

    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        let mut incompatibilities = capabilities.incompatibilities(LightSearch::Choosing);
        incompatibilities.extend(capabilities.unsplattable());
        incompatibilities.extend(capabilities.rows_in_turn());
        if !capabilities.aperture {
            let message = "`forward` waits for particles to hit the aperture of the camera, and \
                           this camera has none";
            let help = "use a `thinlens` with an `aperture_radius` above 0, or `ptracer`, which \
                        connects particles with any camera";
            incompatibilities.push(Incompatibility::fatal(Subject::Camera, message).help(help));
        }
        incompatibilities
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Blocks
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(&self, _: &W, _: &impl Placing, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        let sensor = world.sensor().weights(&wavelengths);
        let (sky, alpha) = self.straight(world, ray, &wavelengths);
        sink.radiance(sensor.rgb(sky * weight).to_array(), alpha);
        self.trace(
            world,
            site,
            (&wavelengths, &sensor, ray.time),
            sampler,
            sink,
        );
    }

    one_by_one!();
}
