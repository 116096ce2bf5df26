//! One sample drawn again, with everything that its estimator asked and was told.
//!
//! A sample is a pure function of its address, so that a number that was not finite, or a pixel far
//! too bright, can be looked at: the estimator runs in a world that answers as the scene does
//! and writes down the answers. It need not know; every estimator can be replayed.

mod any_sampler;
mod log;
mod recorder;
mod recording_bsdf;

pub use log::Describe;

use crate::render::RenderPlan;
use crate::render::positions::position;
use any_sampler::AnySampler;
use etalon_sampling::Sampler;
use etalon_transport::{Channel, Film, Integrator, Pass, PixelSample, Sink, World};
use glam::{UVec2, Vec2};
use log::SharedLog;
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

/// A sample drawn again.
#[derive(Clone, Debug)]
pub struct Replay {
    /// What its weight on the film is, see [`etalon_transport::FilmSample::weight`].
    pub weight: f32,
    /// What happened, line by line.
    pub text: String,
    /// What the film was given meanwhile.
    pub delivered: Vec<Delivered>,
    /// The same of the sample drawn in the world itself.
    pub unheard: Vec<Delivered>,
}

/// What an estimator gives a film.
#[derive(Clone, Debug)]
pub enum Delivered {
    /// The pixel's radiance (linear Rec. 709) and alpha.
    Radiance([f32; 3], f32),
    /// A splat somewhere on the film (pixels).
    Splat(Vec2, [f32; 3]),
    /// A value of one of the estimator's channels.
    Channel(usize, f32),
}

/// Draws samples again, exactly as [`crate::render()`] with this plan does, except for what an estimator makes of several
/// samples together: `guided` lets those of its training join them on the way to the film. `describe` says what a
/// surface is called.
pub fn replay<W: World, I: Integrator, F: Film>(
    world: &W,
    integrator: &I,
    film: &F,
    plan: &RenderPlan,
    addresses: &[Address],
    describe: &Describe<'_>,
) -> Vec<Replay> {
    let mut prepared: Option<(Pass, I::State)> = None;
    let replays = addresses.iter().map(|address| {
        let pass = pass_of(integrator, film, plan, address);
        let (_, state) = match prepared.take() {
            Some(same) if same.0 == pass => prepared.insert(same),
            // What is learned does not depend on the passes before.
            _ => prepared.insert((pass, integrator.prepare(world, film, &pass, None))),
        };
        let log = SharedLog::new(describe);
        replay_one(
            world,
            (integrator, state),
            film,
            (plan, &pass),
            address,
            log,
        )
    });
    replays.collect()
}

/// The pass that a sample belongs to.
fn pass_of<I: Integrator, F: Film>(
    integrator: &I,
    film: &F,
    plan: &RenderPlan,
    address: &Address,
) -> Pass {
    let samples = plan.samples_per_replicate;
    let lengths = integrator.samples_per_pass();
    let length = lengths.map_or(samples, |length| length.max(1));
    // Where the film deals unevenly there is one pass, however many samples a pixel has.
    let passes = samples.div_ceil(length).max(1);
    let number = (address.sample / length).min(passes - 1);
    Pass {
        seed: plan.seed,
        replicate: address.replicate,
        number,
        count: passes,
        samples: length.min(samples - number * length),
        replicates: plan.replicates,
        image_samples: samples.saturating_mul(plan.replicates),
        origin: film.origin(),
        size: film.size(),
        margin: film.margin().ceil() as u32,
    }
}

/// Draws a sample again in a pass that has been prepared: once in the world itself, once in one that writes down.
fn replay_one<W: World, I: Integrator, F: Film>(
    world: &W,
    (integrator, state): (&I, &I::State),
    film: &F,
    (plan, pass): (&RenderPlan, &Pass),
    address: &Address,
    log: SharedLog<'_>,
) -> Replay {
    let samples = plan.samples_per_replicate;
    let length = integrator.samples_per_pass().map_or(samples, |l| l.max(1));
    let dealt = film.dealt(address.pixel, samples);
    let sample = plan.address(address.replicate, address.pixel, address.sample, dealt);
    let mut sampler = AnySampler::start(plan.sampler, &sample);
    let numbers = sampler.next_2d();
    let numbers = position(film, plan.sampler, &sample, numbers);
    let placement = film.place(address.pixel, numbers);
    let spp = samples as f32 * plan.replicates as f32;
    let site = PixelSample {
        pixel: address.pixel,
        raster: placement.raster,
        margin: film.margin(),
        pixels: film.light_paths(),
        spacing: 1.0 / spp.sqrt(),
        sample: address.sample - pass.number * length,
    };
    let channels = integrator.channels();
    let mut unheard = Delivery::to(None, &channels);
    integrator.sample(world, state, &site, &mut sampler.clone(), &mut unheard);
    let mut delivery = Delivery::to(Some(&log), &channels);
    let recorder = Recorder::new(world, &log);
    integrator.sample(&recorder, state, &site, &mut sampler, &mut delivery);
    Replay {
        weight: placement.weight,
        delivered: delivery.delivered,
        unheard: unheard.delivered,
        text: log.into_text(),
    }
}

/// Keeps what is delivered, and writes it down.
struct Delivery<'a> {
    log: Option<&'a SharedLog<'a>>,
    channels: &'a [Channel],
    delivered: Vec<Delivered>,
}

impl<'a> Delivery<'a> {
    fn to(log: Option<&'a SharedLog<'a>>, channels: &'a [Channel]) -> Self {
        Self {
            log,
            channels,
            delivered: Vec::new(),
        }
    }

    fn line(&self, line: String) {
        if let Some(log) = self.log {
            log.line(line);
        }
    }
}

impl Sink for Delivery<'_> {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        let [r, g, b] = rgb;
        self.line(format!("radiance ({r}, {g}, {b}), alpha {alpha}"));
        self.delivered.push(Delivered::Radiance(rgb, alpha));
    }

    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        let (Vec2 { x, y }, [r, g, b]) = (raster, rgb);
        self.line(format!("splat at raster ({x}, {y}): ({r}, {g}, {b})"));
        self.delivered.push(Delivered::Splat(raster, rgb));
    }

    fn channel(&mut self, index: usize, value: f32) {
        let name = self.channels.get(index).map_or("?", |channel| &channel.0);
        self.line(format!("channel {name}: {value}"));
        self.delivered.push(Delivered::Channel(index, value));
    }
}
