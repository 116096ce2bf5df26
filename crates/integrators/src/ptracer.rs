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
//! which lands on whatever pixel the camera sees yₖ in. The lights themselves (paths of one
//! segment) are found by a camera ray per sample, since a connection from a point on a light to
//! the camera would only repeat it with more noise. Nothing is found that reaches the camera off
//! a smooth surface. Splats have no alpha: what counts is how much of the camera ray's light is
//! stopped, the background included. With `hide_emitters` lights are not seen directly; they
//! still stand in the way of what is behind them, as in Mitsuba.

use crate::dimensions::{self as dim, Event};
use crate::path::camera_ray;
use crate::prefix::Prefix;
use crate::settings::{PathSettings, ignore_scheduling};
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_spectrum::{SensorWeights, Wavelengths, sensor_response};
use etalon_transport::{
    Bsdf, Camera, Emission, Finding, Integrator, Mode, Objection, Pass, PixelSite, Ray, Sight,
    Sink, Vertex, World,
};
use glam::{Vec2, Vec3, Vec4};

/// The light tracer.
#[derive(Clone, Debug, Default)]
pub struct ParticleTracer {
    /// Limits of the path.
    pub settings: PathSettings,
}

/// The light's choices come first; scattering events follow at the usual places.
const EMISSION_POSITION: u32 = dim::SCATTERING;
const EMISSION_DIRECTION: u32 = dim::SCATTERING + 2;
const EMISSION_LIGHT: u32 = dim::SCATTERING + 4;

impl ParticleTracer {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        ignore_scheduling(params);
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
    ) -> (Vec4, f32) {
        let visible = !self.settings.hide_emitters;
        let mut prefix = Prefix::START;
        let mut radiance = Vec4::ZERO;
        for depth in 1..=self.settings.max_depth {
            let Some(hit) = world.intersect(&ray) else {
                if visible && world.has_background() {
                    let background = world.background(ray.direction, wavelengths);
                    radiance += prefix.estimate(background, Vec4::ZERO);
                    return (radiance, 1.0);
                }
                break;
            };
            let vertex = world.vertex(&ray, &hit);
            let wo = -ray.direction;
            if world.is_emitter(&hit) && (visible || depth > 1) {
                let emitted = world.emitted(&vertex, wo, wavelengths);
                radiance += prefix.estimate(emitted, Vec4::ZERO);
            }
            let passing = world.bsdf(&vertex, wo, wavelengths).passing();
            if passing == Vec4::ZERO {
                return (radiance, 1.0);
            }
            prefix.value *= passing;
            ray = vertex.spawn(ray.direction);
        }
        (radiance, 1.0 - 0.25 * prefix.value.element_sum())
    }

    /// One particle, splatted wherever the camera sees it scatter.
    #[allow(clippy::too_many_arguments)]
    fn trace_particle<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        site: &PixelSite,
        wavelengths: &Wavelengths,
        sensor: &SensorWeights,
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
        let Some(start) = emit(world, wavelengths, sampler) else {
            return;
        };
        let mut prefix = Prefix::START;
        prefix.value = start.weight;
        let mut ray = start.ray;
        // `depth` segments lie behind once the ray has arrived.
        let mut depth = 1;
        while depth < max_depth {
            let Some(hit) = world.intersect(&ray) else {
                return;
            };
            let vertex = world.vertex(&ray, &hit);
            let wo = -ray.direction;
            let bsdf = world.bsdf(&vertex, wo, wavelengths);
            let event = Event::draw(sampler, depth);
            if bsdf.has_continuous() {
                let crossings = max_depth - depth - 1;
                if let Some((raster, value)) = connect(
                    world,
                    wavelengths,
                    site,
                    &prefix,
                    &vertex,
                    &bsdf,
                    wo,
                    event.light,
                    crossings,
                ) {
                    let rgb = sensor.rgb(value) / site.pixels as f32;
                    sink.splat(raster, rgb.to_array());
                }
            }
            let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, Mode::Importance)
            else {
                return;
            };
            let before = prefix.throughput();
            prefix.extend(sample.value, sample.chance.lanes());
            ray = vertex.spawn(sample.wi);
            if depth >= rr_depth {
                // Relative to the flux before: emitted flux has no natural scale.
                let survival = (prefix.throughput() / before).min(0.95);
                if !(event.roulette < survival) {
                    return;
                }
                prefix.survive(survival);
            }
            if prefix.value == Vec4::ZERO {
                return;
            }
            depth += 1;
        }
    }
}

/// A particle, with the random numbers that are reserved for its start.
pub(crate) fn emit<W: World, S: Sampler>(
    world: &W,
    wavelengths: &Wavelengths,
    sampler: &mut S,
) -> Option<Emission> {
    sampler.skip_to(EMISSION_POSITION);
    let u_position = sampler.next_2d();
    sampler.skip_to(EMISSION_DIRECTION);
    let u_direction = sampler.next_2d();
    sampler.skip_to(EMISSION_LIGHT);
    let u_light = sampler.next_1d();
    world.emit(wavelengths, u_light, u_position, u_direction)
}

/// Connects a particle's vertex with the camera: where it lands, and its value per lane.
#[allow(clippy::too_many_arguments)]
fn connect<W: World>(
    world: &W,
    wavelengths: &Wavelengths,
    site: &PixelSite,
    prefix: &Prefix,
    vertex: &Vertex,
    bsdf: &W::Bsdf<'_>,
    wo: Vec3,
    lens: Vec2,
    crossings: u32,
) -> Option<(Vec2, Vec4)> {
    let camera = world.camera();
    let connection = camera.connect(vertex.position, lens, site.margin)?;
    let value = bsdf.eval(wo, connection.direction, Mode::Importance);
    if value == Vec4::ZERO {
        return None;
    }
    let origin = vertex.origin_toward(connection.target);
    let ray = Ray::between(origin, connection.target, vertex.time)?;
    let passage = world.passage(&ray, wavelengths, crossings)?;
    let radiance = value * passage.transmittance * connection.weight;
    Some((connection.raster, prefix.estimate(radiance, Vec4::ZERO)))
}

impl Integrator for ParticleTracer {
    const UNBIASED: bool = true;

    type State = ();

    fn splats(&self) -> bool {
        true
    }

    fn objections(&self, sight: &Sight) -> Vec<Objection> {
        let mut objections = sight.objections(Finding::Choosing);
        objections.extend(sight.unconnected());
        objections
    }

    fn prepare<W: World>(&self, _: &W, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSite,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        let sensor = sensor_response(&wavelengths);
        let (lights, alpha) = self.visible_lights(world, ray, &wavelengths);
        sink.radiance(sensor.rgb(lights * weight).to_array(), alpha);
        self.trace_particle(world, site, &wavelengths, &sensor, sampler, sink);
    }
}
