//! `etalon render --replay`: one sample again, told vertex by vertex (see [`etalon_integrators::replay`]).

use super::{answer, fail};
use crate::args::ReplayAddress;
use etalon_film::{ExactFilm, SampleCounts};
use etalon_integrators::RenderPlan;
use etalon_integrators::replay::Address;
use etalon_render::pipeline::{self, Loaded};
use etalon_scene::Names;
use etalon_transport::{Film, Placing, SurfaceInteraction};
use glam::IVec2;
use std::fmt::Write;
use std::process::ExitCode;

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
    let names = &loaded.compiled.names;
    let replays =
        (loaded.integrator).replay(&loaded.compiled.scene, &film, plan, &[address], &|vertex| {
            described(vertex, names)
        });
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
    if loaded.integrator.prepares() {
        text += "what the estimator prepared is known to it only: f/p is by the densities of the scattering models\n";
    }
    for replay in replays {
        if replay.weight != 1.0 {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "film weight {}", replay.weight);
        }
        text += &replay.text;
        if replay.text.is_empty() {
            text += "nothing is asked and delivered: what the estimator makes of many samples together, others deliver\n";
        }
    }
    Ok(text)
}

/// What a thing is called.
fn named(names: &[String], index: u32) -> String {
    let name = names.get(index as usize);
    name.map_or_else(|| index.to_string(), |name| format!("{index} {name}"))
}

/// What a surface is called.
fn described(vertex: &SurfaceInteraction, names: &Names) -> String {
    let mut text = format!(
        "shape {}, material {}",
        named(&names.shapes, vertex.shape.0),
        named(&names.materials, vertex.material.0)
    );
    // Writing to a string cannot fail.
    if vertex.primitive > 0 {
        let _ = write!(text, ", primitive {}", vertex.primitive);
    }
    if vertex.instance.is_some() {
        let _ = write!(text, ", instance {}", vertex.instance.0);
    }
    if vertex.light.is_some() {
        let _ = write!(text, ", light {}", vertex.light.0);
    }
    text
}
