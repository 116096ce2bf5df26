//! `etalon render --replay`: one sample again, told vertex by vertex.
//!
//! Four numbers in brackets belong to the four wavelengths; lane 0, the first, chose. `f/p` is the
//! contribution of the walk so far over the density p₀ of the lane that chose; `p/p₀` are the
//! lanes' densities over the same (see [`etalon_integrators::prefix`]). Neither contains Russian
//! roulette, which only the estimator knows of.

use super::{answer, fail};
use crate::args::ReplayAddress;
use crate::pipeline::{self, Loaded};
use etalon_film::{ExactFilm, SampleCounts};
use etalon_integrators::Plan;
use etalon_integrators::prefix::Prefix;
use etalon_integrators::replay::{Address, Event};
use etalon_scene::Names;
use etalon_transport::{Chance, Channel, Film, Vertex};
use glam::{UVec2, Vec3, Vec4};
use std::fmt::Write;
use std::process::ExitCode;

/// Draws the sample again and says what happened.
pub fn run(
    loaded: &Loaded,
    plan: &Plan,
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
    plan: &Plan,
    counts: Option<SampleCounts>,
    asked: &ReplayAddress,
) -> Result<String, String> {
    let settings = &loaded.compiled.film;
    let pixel = UVec2::from(asked.pixel);
    let from = settings.crop_offset;
    let to = from + settings.crop_size;
    if !(pixel.cmpge(from).all() && pixel.cmplt(to).all()) {
        return Err(format!(
            "`--replay`: there is no pixel ({}, {}): the film has columns {} to {} and rows {} to {}",
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
    let channels = loaded.integrator.channels();
    let film = ExactFilm::new(settings.clone(), &channels).map_err(|error| error.message)?;
    let film = film.dealing(counts);
    let samples = film.dealt(pixel, plan.samples_per_replicate);
    bounded("sample", asked.sample, samples)?;
    let address = Address {
        pixel,
        replicate: asked.replicate,
        sample: asked.sample,
    };
    let replay = loaded
        .integrator
        .replay(&loaded.compiled.scene, &film, plan, &address);
    let mut text = format!(
        "{}: pixel ({}, {}), replicate {} of {}, sample {} of {}, seed {}, {} by {}\n",
        loaded.path.display(),
        pixel.x,
        pixel.y,
        asked.replicate,
        plan.replicates,
        asked.sample,
        samples,
        plan.seed,
        loaded.integrator_name,
        pipeline::sampler_name(plan.sampler),
    );
    if replay.weight != 1.0 {
        line(&mut text, format!("film weight {}", replay.weight));
    }
    for event in &replay.events {
        tell(&mut text, event, &loaded.compiled.names, &channels);
    }
    Ok(text)
}

/// Adds a line.
fn line(text: &mut String, line: impl AsRef<str>) {
    text.push_str(line.as_ref());
    text.push('\n');
}

fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

fn lanes(v: Vec4) -> String {
    format!("[{} {} {} {}]", v.x, v.y, v.z, v.w)
}

/// Density per steradian, or probability.
fn chance(chance: Chance) -> String {
    let kind = if chance.is_discrete() {
        "probability"
    } else {
        "density"
    };
    format!("{kind} {}", lanes(chance.lanes()))
}

fn carried(prefix: Option<Prefix>) -> String {
    match prefix {
        Some(Prefix { value, ratio }) => format!("f/p {}  p/p₀ {}", lanes(value), lanes(ratio)),
        None => "f/p known to the estimator only".to_owned(),
    }
}

/// Which walk; the first is not worth mentioning.
fn walk(walk: Option<usize>) -> String {
    match walk {
        Some(0) => String::new(),
        Some(walk) => format!("walk {}: ", walk + 1),
        None => "no walk: ".to_owned(),
    }
}

/// What a thing is called.
fn named(names: &[String], index: u32) -> String {
    let name = names.get(index as usize);
    name.map_or_else(|| index.to_string(), |name| format!("{index} {name}"))
}

fn surface(vertex: &Vertex, names: &Names) -> String {
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

fn tell(text: &mut String, event: &Event, names: &Names, channels: &[Channel]) {
    match event {
        Event::Wavelengths(w) => line(
            text,
            format!(
                "wavelengths {} nm, density {} nm⁻¹",
                lanes(w.lambda),
                lanes(w.density)
            ),
        ),
        Event::CameraRay {
            walk: number,
            raster,
            ray,
        } => line(
            text,
            format!(
                "{}camera ray at raster ({}, {})",
                walk(Some(*number)),
                raster.x,
                raster.y
            ) + &format!(
                ", from {} along {}",
                vector(ray.origin),
                vector(ray.direction)
            ),
        ),
        Event::Emitted {
            walk: number,
            emission,
        } => line(
            text,
            walk(Some(*number))
                + &match emission {
                    None => "nothing is emitted".to_owned(),
                    Some(e) => format!(
                        "light {} emits {:?} from {} along {}, flux/p {}, densities {} and {}",
                        e.light.0,
                        e.origin,
                        vector(e.ray.origin),
                        vector(e.ray.direction),
                        lanes(e.weight),
                        e.density.origin,
                        e.density.ray
                    ),
                },
        ),
        Event::Ray {
            walk: number,
            ray,
            hit,
        } => line(
            text,
            match hit {
                Some(t) => format!("{}ray of length {t}", walk(*number)),
                None => format!(
                    "{}ray along {} meets nothing",
                    walk(*number),
                    vector(ray.direction)
                ),
            },
        ),
        Event::Vertex {
            walk: number,
            vertex,
            prefix,
        } => {
            line(
                text,
                format!("{}surface at {}", walk(*number), vector(vertex.position)),
            );
            line(text, format!("    {}", surface(vertex, names)));
            line(
                text,
                format!(
                    "    normal {}, shading normal {}, uv ({}, {})",
                    vector(vertex.normal),
                    vector(vertex.shading.n),
                    vertex.uv.x,
                    vertex.uv.y
                ),
            );
            line(text, format!("    {}", carried(*prefix)));
        }
        Event::Emission(radiance) => line(text, format!("    emits {}", lanes(*radiance))),
        Event::Background(direction, radiance) => line(
            text,
            format!("    sky along {}: {}", vector(*direction), lanes(*radiance)),
        ),
        Event::Scattered {
            walk: number,
            sample,
            prefix,
        } => match sample {
            None => line(text, format!("    {}scattering: absorbed", walk(*number))),
            Some(s) => {
                let how = if s.passes {
                    "passes straight"
                } else {
                    "scatters"
                };
                line(
                    text,
                    format!(
                        "    {}{how} along {}, value {}, {}, eta {}",
                        walk(*number),
                        vector(s.wi),
                        lanes(s.value),
                        chance(s.chance),
                        s.eta
                    ),
                );
                line(text, format!("    then {}", carried(*prefix)));
            }
        },
        Event::Evaluated { wi, value, density } => {
            let density = density.map_or_else(String::new, |density| {
                format!(", density {}", lanes(density.lanes()))
            });
            line(
                text,
                format!(
                    "    toward {}: value {}{density}",
                    vector(*wi),
                    lanes(*value)
                ),
            );
        }
        Event::Light(None) => line(text, "    light sampling finds nothing"),
        Event::Light(Some(s)) => line(
            text,
            format!(
                "    light {} sampled along {}: {}, {}",
                s.light.0,
                vector(s.direction),
                lanes(s.radiance),
                chance(s.chance)
            ),
        ),
        Event::Passage(ray, passage) => line(
            text,
            match passage {
                None => format!("    blocked along {}", vector(ray.direction)),
                Some(p) => format!(
                    "    arrives along {}: transmittance {}, probability {}",
                    vector(ray.direction),
                    lanes(p.transmittance),
                    lanes(p.probability)
                ),
            },
        ),
        Event::Connection(None) => line(text, "    the camera does not see it"),
        Event::Connection(Some(c)) => line(
            text,
            format!(
                "    the camera sees it at raster ({}, {}), weight {}",
                c.raster.x, c.raster.y, c.weight
            ),
        ),
        Event::Reception(r) => line(
            text,
            format!(
                "    hits the aperture after {}, seen at raster ({}, {}), weight {}",
                r.t, r.raster.x, r.raster.y, r.weight
            ),
        ),
        Event::Radiance([r, g, b], alpha) => {
            line(text, format!("radiance ({r}, {g}, {b}), alpha {alpha}"));
        }
        Event::Splat(raster, [r, g, b]) => line(
            text,
            format!(
                "splat at raster ({}, {}): ({r}, {g}, {b})",
                raster.x, raster.y
            ),
        ),
        Event::Channel(index, value) => {
            let name = channels.get(*index).map_or("?", |channel| &channel.0);
            line(text, format!("channel {name}: {value}"));
        }
    }
}
