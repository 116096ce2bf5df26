//! `forward`: light particles that bounce until, by chance, they hit the camera's aperture.
//!
//! The simplest complete algorithm, and the world's own: a particle of flux Φ = Le·|cos θ| / p leaves
//! a light, scatters like light, and whatever arrives on the aperture is counted where the lens
//! focuses it,
//!
//! ```text
//! splat = Φ · Π f·|cos θ| / p · dx/dω / (A·cos θ)
//! ```
//!
//! with A the aperture's area, θ the angle of arrival, and dx/dω the film's area per solid angle
//! through that point of the lens ([`etalon_transport::Reception`]). It is `ptracer` without the
//! connections, and as slow as one would think: of the particles in a room of surface S a share of
//! about A/S arrives per bounce. What it has over `ptracer` is that it sees through mirrors and glass. A pinhole
//! is never hit; asked to render through one, it refuses.
//!
//! Particles start anywhere in the scene but for those from the sky, which start above it and would
//! miss a camera outside: the sky behind everything (paths of one segment) is found by a camera
//! ray per sample, which also tells alpha. Lights without extent are not seen themselves, as by
//! any other estimator. With `hide_emitters` the camera looks through lights, as that of `path`.

use crate::dimensions::Event;
use crate::path::camera_ray;
use crate::prefix::Prefix;
use crate::ptracer::emit;
use crate::settings::{PathSettings, ignore_scheduling};
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_spectrum::{SensorWeights, Wavelengths, sensor_response};
use etalon_transport::{
    Bsdf, Camera, Finding, Integrator, Mode, Objection, Pass, PixelSite, Ray, Sight, Sink, Subject,
    World,
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
        ignore_scheduling(params);
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
            let Some(hit) = world.intersect(&ray) else {
                if hide || !world.has_background() {
                    break;
                }
                let sky = match depth {
                    1 => world.background(ray.direction, wavelengths),
                    _ => Vec4::ZERO,
                };
                return (Prefix::START.estimate(sky, Vec4::ZERO), 1.0);
            };
            let vertex = world.vertex(&ray, &hit);
            if !(hide && depth == 1 && world.is_emitter(&hit)) {
                let bsdf = world.bsdf(&vertex, -ray.direction, wavelengths);
                through *= bsdf.passing_probability();
                depth += 1;
            }
            if through == Vec4::ZERO {
                break;
            }
            ray = vertex.spawn(ray.direction);
        }
        (Vec4::ZERO, 1.0 - 0.25 * through.element_sum())
    }

    /// Whether nothing stands in the way of a ray that the camera receives.
    fn arrives<W: World>(&self, world: &W, mut ray: Ray) -> bool {
        let end = ray.t_max;
        let origin = ray.origin;
        while let Some(hit) = world.intersect(&ray) {
            if !(self.settings.hide_emitters && world.is_emitter(&hit)) {
                return false;
            }
            // The camera looks through hidden lights.
            ray = world.vertex(&ray, &hit).spawn(ray.direction);
            ray.t_max = end - (ray.origin - origin).dot(ray.direction);
            if !(ray.t_max > 0.0) {
                break;
            }
        }
        true
    }

    /// One particle, splatted whenever it hits the aperture.
    fn trace<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        site: &PixelSite,
        (wavelengths, sensor): (&Wavelengths, &SensorWeights),
        sampler: &mut S,
        sink: &mut K,
    ) {
        let PathSettings {
            max_depth,
            rr_depth,
            hide_emitters,
        } = self.settings;
        let Some(start) = emit(world, wavelengths, sampler) else {
            return;
        };
        let mut prefix = Prefix::START;
        prefix.value = start.weight;
        let mut ray = start.ray;
        // Whether the particle has only passed surfaces straight since it left the light, and
        // whether its ray starts on a surface that emits.
        let mut straight = true;
        let mut on_light = !start.origin.is_infinite();
        // Number of segments, that of `ray` included.
        let mut depth = 1;
        while depth <= max_depth {
            let extent = start.origin.can_be_hit();
            let sky = start.origin.is_infinite();
            let unseen = straight && (!extent || sky && (depth == 1 || hide_emitters));
            let hidden = hide_emitters && on_light;
            if !(unseen || hidden) {
                let reception = world.camera().receive(&ray, site.margin);
                if let Some(found) = reception
                    && self.arrives(
                        world,
                        Ray {
                            t_max: found.t,
                            ..ray
                        },
                    )
                {
                    let value = prefix.estimate(Vec4::splat(found.weight), Vec4::ZERO);
                    let rgb = sensor.rgb(value) / site.pixels as f32;
                    sink.splat(found.raster, rgb.to_array());
                }
            }
            if depth == max_depth {
                return;
            }
            let Some(hit) = world.intersect(&ray) else {
                return;
            };
            let vertex = world.vertex(&ray, &hit);
            let wo = -ray.direction;
            let bsdf = world.bsdf(&vertex, wo, wavelengths);
            let event = Event::draw(sampler, depth);
            let sampled = bsdf.sample(wo, event.lobe, event.direction, Mode::Importance);
            let Some(sample) = sampled else {
                return;
            };
            let before = prefix.throughput();
            prefix.extend(sample.value, sample.chance.lanes());
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
            ray = vertex.spawn(sample.wi);
            straight &= sample.passes;
            on_light = world.is_emitter(&hit);
            depth += 1;
        }
    }
}

impl Integrator for Forward {
    const UNBIASED: bool = true;

    type State = ();

    fn splats(&self) -> bool {
        true
    }

    fn objections(&self, sight: &Sight) -> Vec<Objection> {
        let mut objections = sight.objections(Finding::Choosing);
        if !sight.aperture {
            let message = "`forward` waits for particles to hit the aperture of the camera, and \
                           this camera has none";
            let help = "use a `thinlens` with an `aperture_radius` above 0, or `ptracer`, which \
                        connects particles with any camera";
            objections.push(Objection::fatal(Subject::Camera, message).help(help));
        }
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
        let (sky, alpha) = self.straight(world, ray, &wavelengths);
        sink.radiance(sensor.rgb(sky * weight).to_array(), alpha);
        self.trace(world, site, (&wavelengths, &sensor), sampler, sink);
    }
}
