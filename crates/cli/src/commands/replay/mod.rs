//! `etalon render --replay`: one sample again, told vertex by vertex.
//!
//! Four numbers in brackets belong to the four wavelengths; lane 0, the first, chose. `f/p` is the
//! contribution of the walk so far over the density p₀ of the lane that chose; `p/p₀` are the
//! lanes' densities over the same (see [`etalon_integrators::path_throughput`]). Neither contains Russian
//! roulette, which only the estimator knows of.

mod photons;
mod tell;
mod words;

use super::{answer, fail};
use crate::arg_values::ReplayAddress;
use etalon_film::{ExactFilm, SampleCounts};
use etalon_integrators::RenderPlan;
use etalon_integrators::replay::Address;
use etalon_render::pipeline::{self, Loaded};
use etalon_transport::{Film, Placing};
use glam::IVec2;
use std::process::ExitCode;
use tell::tell;
use words::line;

/// Draws the sample again and says what happened.
pub fn run(
    loaded: &Loaded,
    plan: &RenderPlan,
    counts: Option<SampleCounts>,
    address: &ReplayAddress,
) -> ExitCode {
    match told(loaded, plan, counts, address) {
        Ok(text) => answer(&text, ExitCode::SUCCESS),
        Err(message) => fail(message),
    }
}

fn told(
    loaded: &Loaded,
    plan: &RenderPlan,
    counts: Option<SampleCounts>,
    asked: &ReplayAddress,
) -> Result<String, String> {
    let settings = &loaded.compiled.film;
    let channels = loaded.integrator.channels();
    let film = ExactFilm::new(settings.clone(), &channels).map_err(|error| error.message)?;
    let film = film.dealing(counts);
    let place = IVec2::from(asked.pixel);
    let from = settings.crop_offset.as_ivec2();
    let to = from + settings.crop_size.as_ivec2();
    let rim = film.rim() as i32;
    let (low, high) = (from - rim, to + rim);
    if !(place.cmpge(low).all() && place.cmplt(high).all()) {
        let around = match rim {
            0 => String::new(),
            rim => format!(", and samples up to {rim} pixels around them"),
        };
        let pixel = place;
        return Err(format!(
            "`--replay`: there is no pixel ({}, {}): the film has columns {} to {} and rows {} to {}{around}",
            pixel.x,
            pixel.y,
            from.x,
            to.x - 1,
            from.y,
            to.y - 1
        ));
    }
    let bounded = |what: &str, given: u32, count: u32| match given < count {
        true => Ok(()),
        false => Err(format!(
            "`--replay`: there is no {what} {given}: with these options there are {count}, counted \
             from 0"
        )),
    };
    bounded("replicate", asked.replicate, plan.replicates)?;
    let pixel = place.as_uvec2();
    let samples = film.dealt(pixel, plan.samples_per_replicate);
    bounded("sample", asked.sample, samples)?;
    let address = Address {
        pixel,
        replicate: asked.replicate,
        sample: asked.sample,
    };
    let addresses = core::slice::from_ref(&address);
    let replays = loaded
        .integrator
        .replay(&loaded.compiled.scene, &film, plan, addresses);
    let mut text = format!(
        "{}: pixel ({}, {}), replicate {} of {}, sample {} of {}, seed {}, {} by {}\n",
        loaded.path.display(),
        place.x,
        place.y,
        asked.replicate,
        plan.replicates,
        asked.sample,
        samples,
        plan.seed,
        loaded.integrator_name,
        pipeline::sampler_name(plan.sampler),
    );
    for replay in &replays {
        if replay.weight != 1.0 {
            line(&mut text, format!("film weight {}", replay.weight));
        }
        for event in &replay.events {
            tell(&mut text, event, &loaded.compiled.names, &channels);
        }
    }
    Ok(text)
}
