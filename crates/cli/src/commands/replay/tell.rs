//! What happened in a replay, event by event.

use super::photons::gathered;
use super::words::{carried, chain, chance, lanes, line, mixed, surface, vector, walk};
use etalon_integrators::replay::Event;
use etalon_scene::Names;
use etalon_transport::{Channel, Mixed};

/// Adds what happened.
pub(super) fn tell(text: &mut String, event: &Event, names: &Names, channels: &[Channel]) {
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
        Event::SurfaceInteraction {
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
            mixture,
        } => {
            match sample {
                None => line(text, format!("    {}scattering: absorbed", walk(*number))),
                Some(s) => {
                    let how = if s.is_null {
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
                }
            }
            if let Some(mixture) = mixture {
                line(text, format!("      {}", mixed(mixture)));
            }
            if sample.is_some() {
                line(text, format!("    then {}", carried(*prefix)));
            }
        }
        Event::Evaluated {
            wi,
            value,
            density,
            mixture,
        } => {
            let used = mixture.and_then(|mixture| match mixture.mixed {
                Mixed::Weighed(density) => Some(density),
                Mixed::Sampled { .. } => None,
            });
            let density = used.or(*density).map_or_else(String::new, |density| {
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
            if let Some(mixture) = mixture {
                line(text, format!("      {}", mixed(mixture)));
            }
        }
        Event::Photons {
            radius,
            among,
            photons,
        } => gathered(text, *radius, *among, photons),
        Event::Technique(s, t) => line(text, format!("technique s = {s}, t = {t}")),
        Event::Chain(remark) => line(text, chain(remark)),
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
        Event::Transmission(ray, passage) => line(
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
        Event::CameraSample(None) => line(text, "    the camera does not see it"),
        Event::CameraSample(Some(c)) => line(
            text,
            format!(
                "    the camera sees it at raster ({}, {}), weight {}",
                c.raster.x, c.raster.y, c.weight
            ),
        ),
        Event::ApertureHit(r) => line(
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
