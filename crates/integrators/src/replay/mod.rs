//! One sample drawn again, with everything that its estimator asked and was told.
//!
//! A sample is a pure function of its address, so that a number that was not finite, or a pixel far
//! too bright, can be looked at: the estimator runs in a world that answers as the scene does
//! and writes down the answers. It need not know; every estimator can be replayed. What an estimator
//! does by itself, such as gathering photons, it remarks ([`etalon_transport::TraceEvent`]) in a way that
//! costs nothing where nobody listens.

mod any_sampler;
mod event;
mod event_log;
mod model;
mod recorder;
#[cfg(test)]
mod tests;

pub use event::{Event, Gathered};

use crate::render::RenderPlan;
use crate::render::positions::position;
use any_sampler::AnySampler;
use etalon_sampling::Sampler;
use etalon_transport::{Film, Integrator, Pass, PixelSample, Sink, World};
use event_log::SharedEventLog;
use glam::{UVec2, Vec2};
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
    /// What happened.
    pub events: Vec<Event>,
    /// What the film is given of this sample when nobody listens: deliveries alone, the same as those among `events`.
    pub unheard: Vec<Event>,
}

/// Draws samples again, exactly as [`crate::render()`] with this plan does, but for what an estimator makes of several
/// samples together: `guided` lets those of its training join them on the way to the film.
pub fn replay<W: World, I: Integrator, F: Film>(
    world: &W,
    integrator: &I,
    film: &F,
    plan: &RenderPlan,
    addresses: &[Address],
) -> Vec<Replay> {
    let mut prepared: Option<(Pass, I::State)> = None;
    let replays = addresses.iter().map(|address| {
        let pass = pass_of(integrator, film, plan, address);
        let (_, state) = match prepared.take() {
            Some(same) if same.0 == pass => prepared.insert(same),
            // What is learned does not depend on the passes before.
            _ => prepared.insert((pass, integrator.prepare(world, film, &pass, None))),
        };
        replay_one(world, (integrator, state), film, (plan, &pass), address)
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

/// Draws a sample again in a pass that has been prepared: once unheard, once with somebody who listens.
fn replay_one<W: World, I: Integrator, F: Film>(
    world: &W,
    (integrator, state): (&I, &I::State),
    film: &F,
    (plan, pass): (&RenderPlan, &Pass),
    address: &Address,
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
    let unheard = SharedEventLog::default();
    integrator.sample(
        world,
        state,
        &site,
        &mut sampler.clone(),
        &mut Delivery(&unheard),
    );
    let notebook = SharedEventLog::default();
    let recorder = Recorder::new(world, &notebook);
    integrator.sample(
        &recorder,
        state,
        &site,
        &mut sampler,
        &mut Delivery(&notebook),
    );
    Replay {
        weight: placement.weight,
        events: notebook.take_events(),
        unheard: unheard.take_events(),
    }
}

/// Notes what is delivered.
struct Delivery<'a>(&'a SharedEventLog);

impl Sink for Delivery<'_> {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        self.0.note(Event::Radiance(rgb, alpha));
    }

    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        self.0.note(Event::Splat(raster, rgb));
    }

    fn channel(&mut self, index: usize, value: f32) {
        self.0.note(Event::Channel(index, value));
    }
}
