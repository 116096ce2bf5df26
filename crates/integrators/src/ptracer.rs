//! `ptracer`: light tracing with connections to the camera.
//!
//! The adjoint of path tracing (Dutré, Lafortune, Willems 1993; Veach 1997, section 10.3.2 with
//! t = 1): particles leave the lights, scatter, and every vertex is connected to the camera. With
//! y₀y₁…yₖ the light path, β its flux over its density, and Wₑ the camera's importance,
//!
//! ```text
//! splat = β · f(yₖ₋₁→yₖ→camera)·|cos θ| · V · Wₑ
//! ```
//!
//! at the pixel in which the camera sees yₖ. The lights themselves (paths of one segment) are found by
//! a camera ray per sample, since a connection from a point on a light to the camera has more noise.
//! Light that reaches the camera from a smooth surface is not found. Media scatter particles and
//! attenuate connections. Splats have no alpha: it is the opacity along the camera ray, with the
//! background opaque. With `hide_emitters` the camera sees through lights, as that of `path` does.
//! (Mitsuba's lights then still occlude the surfaces behind them.)

use crate::steps::arrival::{self, Arriving};
use crate::steps::camera_ray::{draw_lens, ray_at};
use crate::steps::dimensions as dim;
use crate::steps::light_mis::LightMis;
use crate::steps::light_path::{LightPath, LightVertex};
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use crate::steps::visibility::camera_visibility;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    Bsdf, Camera, Channel, Incompatibility, Integrator, LightSearch, Lights, Pass, PixelSample,
    Placing, Ray, ScattererOf, SceneCapabilities, Sensor, Sink, Surfaces, TransportMode, World,
    one_by_one,
};
use glam::{Vec2, Vec4};

/// The light tracer.
#[derive(Clone, Debug, Default)]
pub struct ParticleTracer {
    /// Limits of the path.
    pub settings: PathSettings,
}

impl ParticleTracer {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        Self {
            settings: PathSettings::from_params(params),
        }
    }

    /// The lights as the camera sees them: paths of one segment, or more through surfaces that
    /// only let light pass. With the fraction of light that does not come from behind it all.
    fn visible_lights<W: World>(
        &self,
        world: &W,
        mut ray: Ray,
        wavelengths: &Wavelengths,
        sampler: &mut impl Sampler,
    ) -> (Vec4, f32) {
        let visible = !self.settings.hide_emitters;
        let mut throughput = PathThroughput::START;
        let mut radiance = Vec4::ZERO;
        let mut depth = 1;
        while depth <= self.settings.max_depth {
            let hidden = !visible && depth == 1;
            let hit = arrival::next_hit(world, &mut ray, hidden);
            if let Some(transmission) =
                arrival::transmittance(world, &ray, hit.as_ref(), wavelengths)
            {
                // Matter that shines is seen where a flight ends.
                let u = sampler.next_1d();
                let flight = arrival::free_flight(world, &ray, hit.as_ref(), wavelengths, u);
                let arriving = Arriving {
                    wavelengths,
                    throughput: &throughput,
                    light_mis: &LightMis::NONE,
                };
                radiance += flight.map_or(Vec4::ZERO, |flight| {
                    arriving.emitted_by_medium(world, &flight, &ray)
                });
                throughput.beta *= transmission.transmittance;
            }
            let Some(hit) = hit else {
                if visible && world.lights().has_background() {
                    let background =
                        world
                            .lights()
                            .background(ray.direction, ray.time, wavelengths);
                    radiance += throughput.contribution(background, Vec4::ZERO);
                    return (radiance, 1.0);
                }
                break;
            };
            let vertex = world.surfaces().vertex(&ray, &hit);
            let wo = -ray.direction;
            if world.lights().is_emitter(&hit) {
                let emitted = world.lights().emitted(&vertex, wo, wavelengths);
                radiance += throughput.contribution(emitted, Vec4::ZERO);
            }
            let passing = world
                .surfaces()
                .bsdf(&vertex, wo, wavelengths)
                .null_transmittance();
            if passing == Vec4::ZERO {
                return (radiance, 1.0);
            }
            throughput.beta *= passing;
            ray = vertex.spawn(ray.direction);
            depth += 1;
        }
        (radiance, 1.0 - 0.25 * throughput.beta.element_sum())
    }

    /// One particle, splatted wherever the camera sees it scatter.
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
            ..
        } = self.settings;
        if max_depth < 2 {
            return;
        }
        let Some((_, mut particle)) = LightPath::emit(world, wavelengths, sampler, time) else {
            return;
        };
        // As many segments as its depth lie behind once it has arrived.
        while particle.depth < max_depth {
            let Some(vertex) = particle.next(world, sampler) else {
                return;
            };
            if vertex.bsdf.has_continuous() {
                let crossings = max_depth - particle.depth - 1;
                let throughput = &particle.throughput;
                let seen = self.connect(world, wavelengths, site, throughput, &vertex, crossings);
                if let Some((raster, value)) = seen {
                    let rgb = sensor.rgb(value) / site.pixels as f32;
                    sink.splat(raster, rgb.to_array());
                }
            }
            if particle.scatter(&vertex, rr_depth).is_none() {
                return;
            }
        }
    }

    /// Connects the surface that a particle arrives at with the camera: where it lands, and its value per lane.
    fn connect<W: World>(
        &self,
        world: &W,
        wavelengths: &Wavelengths,
        site: &PixelSample,
        throughput: &PathThroughput,
        vertex: &LightVertex<ScattererOf<'_, W>>,
        crossings: u32,
    ) -> Option<(Vec2, Vec4)> {
        let (point, lens) = (&vertex.point, vertex.event.light);
        let connection = (world.camera()).connect(point.position, lens, point.time, site.margin)?;
        // A row that is exposed for a part of the shutter interval sees as much of the particles as if it were all.
        let exposure = world.exposure(connection.raster, point.time);
        let value = (vertex.bsdf).eval(vertex.wo, connection.direction, TransportMode::Importance);
        if value * exposure == Vec4::ZERO {
            return None;
        }
        let ray = point.shadow_ray(connection.direction, Some(connection.target))?;
        let transmission = if self.settings.hide_emitters {
            let on_light = point.light.is_some();
            camera_visibility(world, wavelengths, ray, on_light, crossings)?.transmission
        } else {
            world.transmittance(&ray, wavelengths, crossings)?
        };
        let radiance = value * transmission.transmittance * (connection.weight * exposure);
        Some((
            connection.raster,
            throughput.contribution(radiance, Vec4::ZERO),
        ))
    }
}

impl Integrator for ParticleTracer {
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
        incompatibilities.extend(capabilities.one_way_camera());
        incompatibilities.extend(capabilities.unsplattable());
        incompatibilities.extend(capabilities.unconnected());
        incompatibilities.extend(capabilities.instant_rows());
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
        // The particle flies at any moment, the camera ray at one of its row.
        let (lens, u, time) = draw_lens(sampler);
        let wavelengths = world.sensor().wavelengths(u);
        let (ray, weight) = ray_at(world, site, lens, world.moment(site.raster, time));
        let sensor = world.sensor().weights(&wavelengths);
        let (lights, alpha) = {
            sampler.skip_to(dim::TIME + 1);
            self.visible_lights(world, ray, &wavelengths, sampler)
        };
        sink.radiance(sensor.rgb(lights * weight).to_array(), alpha);
        self.trace(world, site, (&wavelengths, &sensor, time), sampler, sink);
    }

    one_by_one!();
}
