//! Random walks in a slab.
//!
//! A walk has a depth, a direction and a throughput, and no place along the surface (Guo, Hašan & Zhao 2018, section 4). An event
//! is an arrival at the interface or at the base, or a collision between them. A walk that leaves the slab
//! (`escape`) samples directions. One that must leave in a given direction (`connect`) does so at each event, in the two ways
//! of ibid., section 5.2: through the interface by a direction sampled from outside, or by the
//! direction that the event scattered into. The two are weighted by the balance heuristic (Veach & Guibas 1995). Where interface
//! and base are both smooth neither finds the ways over the base, which are added up.

use crate::layers::Layered;
use crate::layers::base::{Base, Scattered};
use crate::layers::numbers::Numbers;
use etalon_math::{Frame, float};
use etalon_sampling::henyey_greenstein::{
    henyey_greenstein_density, interval_to_henyey_greenstein,
};
use glam::{Vec3, Vec4};

/// A walk with less throughput than this may end by chance.
const ROULETTE: f32 = 0.25;

/// The events before that.
const CERTAIN: u16 = 3;

/// A walk inside.
pub(super) struct Walk {
    /// Where it goes.
    pub(super) direction: Vec3,
    /// Optical depth below the interface.
    pub(super) depth: f32,
    /// Per lane.
    pub(super) throughput: Vec4,
}

/// Where a walk arrives.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Event {
    Interface,
    Medium,
    Base,
}

/// A way out into the given direction, found from outside.
struct Exit {
    /// The direction inside, toward the interface.
    out: Vec3,
    /// The interface's value over the density of `out`.
    weight: f32,
    /// The density of `out`; without a meaning if the interface is smooth.
    density: f32,
}

impl Walk {
    /// Whether it goes on; where that is decided by chance, those that do count for the others.
    #[inline]
    fn survives(&mut self, events: u16, numbers: &mut Numbers) -> bool {
        let most = self.throughput.max_element();
        if events < CERTAIN || most >= ROULETTE {
            return most > 0.0;
        }
        let probability = most / ROULETTE;
        self.throughput /= probability.max(f32::MIN_POSITIVE);
        numbers.next() < probability
    }
}

impl<B: Base> Layered<B> {
    /// Goes to the next event.
    #[inline]
    fn advance(&self, walk: &mut Walk, numbers: &mut Numbers) -> Event {
        let down = walk.direction.z < 0.0;
        let thickness = self.slab.thickness;
        let rest = if down {
            thickness - walk.depth
        } else {
            walk.depth
        };
        if self.slab.scatters() {
            let flown = -float::ln(1.0 - numbers.next()) * walk.direction.z.abs();
            if flown < rest {
                walk.depth += if down { flown } else { -flown };
                return Event::Medium;
            }
        } else {
            walk.throughput *= transmittance(rest, walk.direction);
        }
        walk.depth = if down { thickness } else { 0.0 };
        if down { Event::Base } else { Event::Interface }
    }

    /// The value and the density of scattering into `wi` at an event inside.
    #[inline]
    fn value(&self, event: Event, walk: &Walk, wi: Vec3) -> (Vec4, f32) {
        match event {
            Event::Base => self.base.eval(-walk.direction, wi),
            _ => {
                let phase = henyey_greenstein_density(self.slab.g, walk.direction.dot(wi));
                (self.slab.albedo * phase, phase)
            }
        }
    }

    /// Samples a direction at an event inside.
    #[inline]
    fn scatter(&self, event: Event, walk: &Walk, numbers: &mut Numbers) -> Option<Scattered> {
        let u = numbers.pair();
        if event == Event::Base {
            return self.base.sample(-walk.direction, u);
        }
        let mu = interval_to_henyey_greenstein(self.slab.g, u.x).clamp(-1.0, 1.0);
        let sine = float::safe_sqrt(1.0 - mu * mu);
        let (sin, cos) = float::sin_cos_turns(u.y);
        let turned = Vec3::new(sine * cos, sine * sin, mu);
        Some(Scattered {
            wi: Frame::from_normal(walk.direction).to_world(turned),
            weight: self.slab.albedo,
            density: Some(henyey_greenstein_density(self.slab.g, mu)),
        })
    }

    /// Follows a walk until it leaves: the direction outside, and its throughput. A walk that no event made continuous is `None`,
    /// as is one of too many events.
    pub(super) fn escape(&self, mut walk: Walk, numbers: &mut Numbers) -> Option<(Vec3, Vec4)> {
        let mut continuous = !self.is_mirror();
        for events in 0..=self.slab.max_depth {
            if !walk.survives(events, numbers) {
                return None;
            }
            let event = self.advance(&mut walk, numbers);
            if event == Event::Interface {
                let facet = self.slab.interface.facet(-walk.direction, numbers)?;
                if numbers.next() >= facet.reflectance {
                    let (wi, weight) = facet.transmitted()?;
                    return continuous.then_some((wi, walk.throughput * weight));
                }
                let (direction, weight) = facet.reflected()?;
                walk.direction = direction;
                walk.throughput *= weight;
                continue;
            }
            continuous |= event == Event::Medium;
            let next = self.scatter(event, &walk, numbers)?;
            walk.direction = next.wi;
            walk.throughput *= next.weight;
        }
        None
    }

    /// An estimate of f(a, b), without direct reflection, by one walk from `a`, both outside.
    pub(super) fn connect(&self, a: Vec3, b: Vec3, numbers: &mut Numbers) -> Vec4 {
        let interface = &self.slab.interface;
        let is_smooth = interface.is_smooth();
        let scale = 1.0 / (interface.eta * interface.eta);
        let entry = self.through(a, numbers);
        let exit = self.through(b, numbers).map(|(inward, weight)| Exit {
            out: -inward,
            weight: weight * scale / inward.z.abs(),
            density: match is_smooth {
                true => 1.0,
                false => interface.eval(b, inward).1,
            },
        });
        let Some((direction, weight)) = entry else {
            return Vec4::ZERO;
        };
        let mut walk = Walk {
            direction,
            depth: 0.0,
            throughput: Vec4::splat(weight),
        };
        let mut sum = Vec4::ZERO;
        for events in 0..self.slab.max_depth {
            if !walk.survives(events, numbers) {
                break;
            }
            let event = self.advance(&mut walk, numbers);
            if event == Event::Interface {
                let facet = interface.facet(-walk.direction, numbers);
                let reflected = facet.and_then(|f| Some((f.reflectance, f.reflected()?)));
                let Some((reflectance, (direction, weight))) = reflected else {
                    break;
                };
                walk.direction = direction;
                walk.throughput *= reflectance * weight;
                continue;
            }
            if let (Some(exit), true) = (&exit, self.is_mirror()) {
                let more = self.slab.max_depth - events - 1;
                let left = self.between_mirrors(event, &walk, (exit.out, b.z), more);
                sum += walk.throughput * left * exit.weight;
            } else if let Some(exit) = &exit {
                let (value, density) = self.value(event, &walk, exit.out);
                let own = if is_smooth { 0.0 } else { density };
                let left = exit.weight * transmittance(walk.depth, exit.out);
                sum += walk.throughput * value * (left * share(exit.density, own));
            }
            let Some(next) = self.scatter(event, &walk, numbers) else {
                break;
            };
            walk.direction = next.wi;
            walk.throughput *= next.weight;
            if !is_smooth && next.wi.z > 0.0 {
                // Importance from inside is radiance from outside.
                let (value, density) = interface.eval(b, -next.wi);
                let left = scale * transmittance(walk.depth, next.wi) * value / next.wi.z;
                let share = next.density.map_or(1.0, |own| share(own, density));
                sum += walk.throughput * (left * share);
            }
        }
        sum
    }

    /// What a collision sends toward `out` between two mirrors, which no other event can: up, or down and by the base, and then
    /// to and fro any number of times, in `more` events at most. The cosine outside is `cos`.
    fn between_mirrors(
        &self,
        event: Event,
        walk: &Walk,
        (out, cos): (Vec3, f32),
        more: u16,
    ) -> Vec4 {
        if event == Event::Base {
            return Vec4::ZERO;
        }
        let thickness = self.slab.thickness;
        let mirrored = self.base.mirrored(out.z).unwrap_or(Vec4::ZERO);
        let across = transmittance(thickness, out);
        let to_and_fro = mirrored * (self.fresnel(cos).0 * across * across);
        let up = self.value(event, walk, out).0 * transmittance(walk.depth, out);
        let down = self.value(event, walk, out.with_z(-out.z)).0;
        let down = down * mirrored * (across * transmittance(thickness - walk.depth, out));
        up * series(to_and_fro, more / 2 + 1) + down * series(to_and_fro, more.div_ceil(2))
    }

    /// A direction inside for `w` outside, and its weight.
    #[inline]
    fn through(&self, w: Vec3, numbers: &mut Numbers) -> Option<(Vec3, f32)> {
        let facet = self.slab.interface.facet(w, numbers)?;
        let (direction, weight) = facet.transmitted()?;
        Some((direction, weight * (1.0 - facet.reflectance)))
    }
}

/// 1 + x + x² …, so many terms.
#[inline]
pub(super) fn series(x: Vec4, terms: u16) -> Vec4 {
    (0..terms).fold(Vec4::ZERO, |sum, _| sum * x + 1.0)
}

/// The share of light that passes an optical depth along a direction.
#[inline]
fn transmittance(depth: f32, direction: Vec3) -> f32 {
    // Also where a direction of no slope has no way to go.
    if depth > 0.0 {
        float::exp(-depth / direction.z.abs())
    } else {
        1.0
    }
}

/// The weight of what has the density `own` among itself and another.
#[inline]
fn share(own: f32, other: f32) -> f32 {
    if own > 0.0 { own / (own + other) } else { 0.0 }
}
