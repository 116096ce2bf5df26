//! One sample drawn again, with everything that its estimator asked and was told.
//!
//! A sample is a pure function of its address, so that a number that was not finite, or a pixel far
//! too bright, can be looked at: the estimator runs once in a world that answers as the scene does
//! and writes down the answers. It need not know; every estimator can be replayed.

mod any_sampler;
mod recorder;

use crate::prefix::Prefix;
use crate::render::Plan;
use any_sampler::AnySampler;
use etalon_math::{Density, SolidAngle};
use etalon_sampling::{PixelSample, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    BsdfSample, Connection, Emission, Film, Integrator, LightSample, Pass, Passage, PixelSite, Ray,
    Reception, Sink, Vertex, World,
};
use glam::{UVec2, Vec2, Vec3, Vec4};
use recorder::Recorder;

/// Which sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    /// The pixel of the whole film for which it is drawn.
    pub pixel: UVec2,
    /// The replicate.
    pub replicate: u32,
    /// Which of the pixel's samples in the replicate, from 0.
    pub sample: u32,
}

/// What the estimator was told, in the order of its questions. `walk` tells several walks apart,
/// such as those from the camera and from a light; it is `None` for a ray that belongs to none.
#[derive(Clone, Debug)]
pub enum Event {
    /// The wavelengths of the path.
    Wavelengths(Wavelengths),
    /// A walk from the camera begins.
    CameraRay {
        /// The walk.
        walk: usize,
        /// The film position.
        raster: Vec2,
        /// The ray.
        ray: Ray,
    },
    /// A walk from a light begins, or would, if anything were emitted.
    Emitted {
        /// The walk.
        walk: usize,
        /// The particle.
        emission: Option<Emission>,
    },
    /// A ray went on to the next surface, if there is one.
    Ray {
        /// The walk.
        walk: Option<usize>,
        /// The ray.
        ray: Ray,
        /// Distance to the surface (m).
        hit: Option<f32>,
    },
    /// A surface was met.
    Vertex {
        /// The walk.
        walk: Option<usize>,
        /// Where.
        vertex: Box<Vertex>,
        /// Value and densities of the walk so far, Russian roulette apart; `None` if the estimator
        /// drew a direction by itself.
        prefix: Option<Prefix>,
    },
    /// Radiance emitted by the surface.
    Emission(Vec4),
    /// Radiance of the sky along a direction.
    Background(Vec3, Vec4),
    /// A direction was sampled from the scattering model.
    Scattered {
        /// The walk.
        walk: Option<usize>,
        /// The direction; `None` if light is absorbed.
        sample: Option<BsdfSample>,
        /// Value and densities of the walk with it.
        prefix: Option<Prefix>,
    },
    /// The scattering model was asked for a direction.
    Evaluated {
        /// The direction.
        wi: Vec3,
        /// f·|cos θ|, per lane.
        value: Vec4,
        /// The density with which the model would have sampled it, if that was asked.
        density: Option<Density<SolidAngle>>,
    },
    /// A light was sampled.
    Light(Option<LightSample>),
    /// Straight travel to somewhere; `None` if light does not arrive.
    Passage(Ray, Option<Passage>),
    /// A point was connected with the camera; `None` if it does not see it.
    Connection(Option<Connection>),
    /// A particle hit the aperture.
    Reception(Reception),
    /// The pixel's radiance (linear Rec. 709) and alpha, as the estimator delivered them.
    Radiance([f32; 3], f32),
    /// A splat somewhere on the film (pixels).
    Splat(Vec2, [f32; 3]),
    /// A value of one of the estimator's channels.
    Channel(usize, f32),
}

/// A sample drawn again.
#[derive(Clone, Debug)]
pub struct Replay {
    /// What its weight on the film is, see [`etalon_transport::Placement::weight`].
    pub weight: f32,
    /// What happened.
    pub events: Vec<Event>,
}

/// Draws a sample again, exactly as [`crate::render()`] with this plan does.
pub fn replay<W: World, I: Integrator, F: Film>(
    world: &W,
    integrator: &I,
    film: &F,
    plan: &Plan,
    address: &Address,
) -> Replay {
    let size = film.size();
    let samples = plan.samples_per_replicate;
    let lengths = integrator.samples_per_pass();
    let length = lengths.map_or(samples, |length| length.max(1));
    // Where the film deals unevenly there is one pass, however many samples a pixel has.
    let passes = samples.div_ceil(length).max(1);
    let number = (address.sample / length).min(passes - 1);
    let pass = Pass {
        seed: plan.seed,
        replicate: address.replicate,
        number,
        count: passes,
        samples: length.min(samples - number * length),
        image_samples: samples.saturating_mul(plan.replicates),
        origin: film.origin(),
        size,
        margin: film.margin().ceil() as u32,
    };
    // What is learned does not depend on the passes before.
    let state = integrator.prepare(world, &pass, None);
    let sample = PixelSample {
        seed: plan.seed,
        replicate: address.replicate,
        pixel: address.pixel.into(),
        sample: address.sample,
        samples_per_replicate: film.dealt(address.pixel, samples),
    };
    let mut sampler = AnySampler::start(plan.sampler, &sample);
    let placement = film.place(address.pixel, sampler.next_2d());
    let spp = samples as f32 * plan.replicates as f32;
    let site = PixelSite {
        pixel: address.pixel,
        raster: placement.raster,
        margin: film.margin(),
        pixels: film.light_paths(),
        spacing: 1.0 / spp.sqrt(),
        sample: address.sample - number * length,
    };
    let recorder = Recorder::new(world);
    let mut found = Found(Vec::new());
    integrator.sample(&recorder, &state, &site, &mut sampler, &mut found);
    let mut events = recorder.into_events();
    events.append(&mut found.0);
    Replay {
        weight: placement.weight,
        events,
    }
}

/// Notes what is delivered.
struct Found(Vec<Event>);

impl Sink for Found {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        self.0.push(Event::Radiance(rgb, alpha));
    }

    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        self.0.push(Event::Splat(raster, rgb));
    }

    fn channel(&mut self, index: usize, value: f32) {
        self.0.push(Event::Channel(index, value));
    }
}
