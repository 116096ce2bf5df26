//! Paths at surfaces of one kind, scattered together in vector lanes.
//!
//! Lane i gets the bits that its path would get alone (see [`etalon_transport::LaneShading`]), so that it does not matter which
//! paths meet. Few that are left over, and those at surfaces without a kind, are scattered one by one.

use crate::path::batch::{Lanes, PathBatch};
use crate::path::hooks::PathHooks;
use crate::steps::candidates::{Candidates, TURN};
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::UnoccludedPath;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathConfig;
use arrayvec::ArrayVec;
use core::ops::ControlFlow;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector};
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    LaneBsdf, LaneKind, LaneReceiver, LaneShading, LaneVertices, LeavingRays, LeftSurface, Lights,
    MediumInterface, ShadowQuery, Surfaces, TexturePoint, World,
};

/// So many paths take as long in lanes as one by one.
const ENOUGH: usize = 4;

/// Where a path has arrived.
enum Arrived {
    /// At a surface of a kind; what is emitted there is added.
    OfKind(LaneKind),
    /// At lights at infinity.
    Escaped,
    /// Where it goes on by itself.
    Alone,
    /// Where it needs nothing more.
    Ended,
}

/// Connections of several vertices to lights, as [`crate::steps::light_connection::LightConnection`] describes them.
struct LaneConnection<F: Lane> {
    /// The lanes that have one.
    found: F::Mask,
    /// Unit directions to the lights.
    direction: F::Vector,
    /// Where on the light, in lanes where it is not at infinity.
    target: F::Vector,
    /// Those lanes.
    has_target: F::Mask,
    path: UnoccludedPath<F>,
}

impl<F: Lane> LaneConnection<F> {
    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        let vector = |yes, no| F::Vector::choose(mask, yes, no);
        let masks = |yes: F::Mask, no: F::Mask| (yes & mask) | (no & !mask);
        Self {
            found: masks(yes.found, no.found),
            direction: vector(yes.direction, no.direction),
            target: vector(yes.target, no.target),
            has_target: masks(yes.has_target, no.has_target),
            path: UnoccludedPath::choose(mask, yes.path, no.path),
        }
    }
}

/// Several vertices of one kind, at which light is sampled.
struct LaneVertex<'v, 'a, F: Lane, L: LaneShading + 'a> {
    lanes: &'a L,
    bsdf: &'v L::Bsdf<'a, F>,
    wavelengths: &'v [Wavelengths],
    wo: F::Vector,
    from: LaneReceiver<F>,
    /// The paths that led there.
    before: PathThroughput<F>,
}

impl<F: Lane, L: LaneShading> LaneVertex<'_, '_, F, L> {
    /// The connection to a light sample.
    #[inline(always)]
    fn connect(&self, wanted: F::Mask, u_light: F, u: [F; 2]) -> LaneConnection<F> {
        let light = (self.lanes).sample_light(&self.from, self.wavelengths, wanted, u_light, u);
        let (value, density) = self.bsdf.eval_and_density(self.wo, light.direction);
        let contribution = value * light.radiance;
        LaneConnection {
            found: light.found & !contribution.is_zero(),
            direction: light.direction,
            target: light.target,
            has_target: light.has_target,
            path: UnoccludedPath::new(
                &self.before,
                contribution,
                (F::Spectrum::uniform(light.chance), light.is_delta),
                self.before.r_u * density,
                [1.0; 2],
            ),
        }
    }

    /// Resamples up to `most` light samples for one shadow ray, `counts` of them in each lane: what [`Candidates::draw`] does.
    #[inline(always)]
    fn resample(
        &self,
        events: &BounceSamples<F, [F; 2]>,
        shift: F,
        counts: F,
        most: u32,
    ) -> LaneConnection<F> {
        let below_one = F::splat(ONE_MINUS_EPSILON);
        let one = Lane::eq(counts, F::ONE);
        let mut number = events.light_choice;
        let mut sum = F::ZERO;
        let mut ended = F::Mask::splat(false);
        let mut chosen: Option<(LaneConnection<F>, F)> = None;
        for i in 0..most {
            let i = i as f32;
            let choice = ((shift + i) / counts).min(below_one);
            let [u, v] = [events.light[0] + TURN.x * i, events.light[1] + TURN.y * i]
                .map(|u| (u - u.floor()).min(below_one));
            let wanted = F::splat(i).lt(counts) & !ended;
            let candidate = self.connect(
                wanted,
                one.select(events.light_choice, choice),
                [
                    one.select(events.light[0], u),
                    one.select(events.light[1], v),
                ],
            );
            let active = wanted & candidate.found;
            let expected = candidate.path.unoccluded().sum();
            let infinite = !expected.abs().lt(F::splat(f32::INFINITY));
            let counted = active & !infinite & expected.gt(F::ZERO);
            sum = counted.select(sum + expected, sum);
            let p = expected / sum;
            let taken = number.lt(p);
            let rest = taken
                .select(number / p, (number - p) / (F::ONE - p))
                .min(below_one);
            number = counted.select(rest, number);
            // What is not finite is not for the choice to hide.
            let take = active & (one | infinite | (counted & taken));
            ended = ended | (active & infinite);
            let certain = one | infinite;
            let kept = certain.select(F::ZERO, expected);
            chosen = Some(match chosen {
                None => {
                    let mut candidate = candidate;
                    candidate.found = take;
                    (candidate, kept)
                }
                Some((before, expected)) => (
                    LaneConnection::choose(take, candidate, before),
                    take.select(kept, expected),
                ),
            });
        }
        let (mut connection, expected) = chosen.expect("at least one candidate");
        let weighed = expected.gt(F::ZERO);
        let factor = weighed.select(sum / (expected * counts), F::ONE);
        let beta = &mut connection.path.throughput.beta;
        *beta = *beta * factor;
        connection
    }
}

impl<'w, W: World, S: Sampler, C: PathHooks, const N: usize> PathBatch<'w, W, S, C, N> {
    /// Brings every path to its next vertex, and scatters it there: paths at surfaces of one kind as many together as there are lanes,
    /// every other one alone.
    #[inline]
    pub(super) fn advance_by_kind(
        &mut self,
        (world, lanes, config): (&'w W, &'w W::Lanes, &PathConfig),
    ) {
        let mut groups: [ArrayVec<usize, { Lanes::WIDTH }>; LaneKind::COUNT] =
            core::array::from_fn(|_| ArrayVec::new());
        for segment in 0..self.active.len() {
            match self.arrive((world, lanes, config), segment) {
                Arrived::OfKind(kind) => {
                    let group = &mut groups[usize::from(kind.0)];
                    group.push(segment);
                    if group.is_full() {
                        self.scatter_together::<Lanes>((world, lanes, config), kind, group);
                        group.clear();
                    }
                }
                Arrived::Escaped => self.escaped.push(segment),
                Arrived::Alone => self.advance_alone((world, config), segment),
                Arrived::Ended => {}
            }
        }
        for (kind, group) in groups.iter().enumerate() {
            match group.len() < ENOUGH {
                true => {
                    (group.iter()).for_each(|segment| self.scatter_alone((world, config), *segment))
                }
                false => {
                    let kind = LaneKind(kind as u8);
                    self.scatter_together::<Lanes>((world, lanes, config), kind, group);
                }
            }
        }
        self.see_background(lanes, config);
    }

    /// Brings a path to a surface of some kind, where it can be scattered together with others.
    #[inline]
    fn arrive(
        &mut self,
        (world, lanes, config): (&'w W, &'w W::Lanes, &PathConfig),
        segment: usize,
    ) -> Arrived {
        let (index, ray) = (self.active[segment], &self.rays[segment]);
        let path = &mut self.paths[index];
        let Some(hit) = &self.hits[segment] else {
            return match world.lights().has_background() {
                _ if ray.medium.is_some() => Arrived::Alone,
                true if config.limits.sees_background(path.alpha) => Arrived::Escaped,
                _ => Arrived::Ended,
            };
        };
        let Some(kind) = lanes.kind(hit).filter(|_| !path.is_last(config)) else {
            return Arrived::Alone;
        };
        if ray.medium.is_some() || world.lights().is_emitter(hit) {
            let arrived = super::arrive(world, config, path, (ray, Some(hit)));
            if let ControlFlow::Break(step) = arrived {
                self.take(index, step);
                return Arrived::Ended;
            }
        }
        Arrived::OfKind(kind)
    }

    /// Scatters one path at the surface that it has reached.
    fn scatter_alone(&mut self, (world, config): (&'w W, &PathConfig), segment: usize) {
        let (path, ray) = (self.active[segment], &self.rays[segment]);
        let hit = self.hits[segment]
            .as_ref()
            .expect("it has reached a surface");
        let vertex = world.surfaces().vertex(ray, hit);
        let step = super::scatter(world, config, &mut self.paths[path], (ray, &vertex));
        self.take(path, step);
    }

    /// Adds what the paths that have escaped see.
    #[inline(never)]
    fn see_background(&mut self, lanes: &W::Lanes, config: &PathConfig) {
        for begin in (0..self.escaped.len()).step_by(Lanes::WIDTH) {
            let group = self.escaped[begin..].iter().take(Lanes::WIDTH).copied();
            let group: ArrayVec<usize, { Lanes::WIDTH }> = group.collect();
            match group.len() < ENOUGH {
                true => (group.iter()).for_each(|segment| {
                    self.see_background_together::<f32>(lanes, config, &[*segment]);
                }),
                false => self.see_background_together::<Lanes>(lanes, config, &group),
            }
        }
        self.escaped.clear();
    }

    /// Adds what up to as many paths as there are lanes see.
    #[inline(always)]
    fn see_background_together<F: Lane>(
        &mut self,
        lanes: &W::Lanes,
        config: &PathConfig,
        segments: &[usize],
    ) {
        let segment = |i: usize| segments[i.min(segments.len() - 1)];
        let index = F::array(|i| self.active[segment(i)]);
        let path = |i: usize| &self.paths[index.as_ref()[i]];
        let wavelengths = F::array(|i| path(i).wavelengths);
        let direction = F::Vector::of_lanes(|i| self.rays[segment(i)].direction);
        let from = LaneReceiver::<F>::of_lanes(|i| &path(i).light_mis.from);
        let (radiance, density) = lanes.background(&from, direction, wavelengths.as_ref());
        let throughput = PathThroughput::<F>::of_lanes(|i| &path(i).throughput);
        let r_l = F::Spectrum::of_lanes(|i| path(i).light_mis.r_l);
        let never = F::Spectrum::uniform(F::ZERO);
        let by_light_sampling = F::Spectrum::choose(r_l.is_zero(), never, r_l * density);
        let seen = throughput.contribution(radiance, by_light_sampling);
        for i in 0..segments.len() {
            let path = &mut self.paths[index.as_ref()[i]];
            path.see_background(config, seen.at_lane(i));
        }
    }

    /// Scatters up to as many paths as there are lanes, at the ends of these segments, on surfaces of one kind. What more lanes there
    /// are repeat the last, and nothing becomes of them.
    #[inline(never)]
    fn scatter_together<F: Lane>(
        &mut self,
        (world, lanes, config): (&'w W, &'w W::Lanes, &PathConfig),
        kind: LaneKind,
        segments: &[usize],
    ) {
        let Self {
            paths,
            active,
            rays,
            hits,
            ..
        } = self;
        let count = segments.len();
        let segment = |i: usize| segments[i.min(count - 1)];
        let ray = |i: usize| &rays[segment(i)];
        let hit = |i: usize| hits[segment(i)].as_ref().expect("it has reached a surface");
        let index = F::array(|i| active[segment(i)]);
        let index = index.as_ref();
        let mut event = BounceSamples::default();
        let random = BounceSamples::of_lanes(|i| {
            if i < count {
                event = paths[index[i]].draw_event();
            }
            event
        });
        let path = |i: usize| &paths[index[i]];
        let surface = lanes.surfaces::<F>(ray, hit);
        let leaving = surface.leaving;
        let left = F::array(|i| LeftSurface {
            shape: hit(i).shape,
            primitive: surface.primitives[i],
            time: ray(i).time,
            media: MediumInterface::within(ray(i).medium),
        });
        let left = left.as_ref();
        let wavelengths = F::array(|i| path(i).wavelengths);
        let wavelengths = wavelengths.as_ref();
        let texture_point = |i| TexturePoint::from(&world.surfaces().vertex(ray(i), hit(i)));
        let vertices = LaneVertices {
            surface: &surface,
            texture_point: &texture_point,
            wavelengths,
        };
        let wo = -F::Vector::of_lanes(|i| ray(i).direction);
        let bsdf = lanes.bsdf::<F>(kind, |i| hit(i).shape, vertices, wo);
        let hemisphere = bsdf.hemisphere(wo);
        let before = PathThroughput::<F>::of_lanes(|i| &path(i).throughput);
        let at = LaneVertex {
            lanes,
            wavelengths,
            wo,
            from: LaneReceiver {
                position: leaving.position,
                normal: hemisphere.unwrap_or(surface.shading.n),
                one_sided: F::Mask::splat(hemisphere.is_some()),
                time: F::from_fn(|i| ray(i).time),
            },
            before,
            bsdf: &bsdf,
        };
        let sample = bsdf.sample(wo, random.lobe, random.direction);

        if bsdf.has_continuous() {
            let counts = F::array(|i| {
                Candidates::at(path(i).candidates(config), world, &at.from.at_lane(i)).count()
            });
            let counts = counts.as_ref();
            let connection = match counts.iter().max() {
                Some(&most) if most > 1 => {
                    let shift = F::from_fn(|i| match counts[i] {
                        0 | 1 => 0.0,
                        _ if i >= count => 0.0,
                        _ => paths[index[i]].sampler.next_1d(),
                    });
                    let counts = F::from_fn(|i| counts[i] as f32);
                    at.resample(&random, shift, counts, most)
                }
                _ => at.connect(F::Mask::splat(true), random.light_choice, random.light),
            };
            let (has_target, infinite) =
                (connection.has_target, leaving.spawn(connection.direction));
            let (shadow_rays, found) = match has_target.any() {
                false => (infinite, connection.found),
                true => {
                    let (segments, exist) = leaving.toward(connection.target);
                    let rays = LeavingRays::choose(has_target, segments, infinite);
                    (rays, connection.found & (exist | !has_target))
                }
            };
            let (shadow_ray, unoccluded) = (shadow_rays.lanes(), connection.path.lanes());
            for i in (0..count).filter(|i| found.lane(*i)) {
                self.waiting.push((index[i], unoccluded(i)));
                self.shadow_rays.push(ShadowQuery {
                    ray: shadow_ray(i, left[i]),
                    wavelengths: wavelengths[i],
                    crossings: config.null_crossings(paths[index[i]].depth),
                });
            }
        }

        let mut after = before;
        after.scatter(sample.value, sample.chance);
        let eta = F::from_fn(|i| paths[index[i]].eta) * sample.eta;
        let survival = after.survival(eta);
        let played = F::Mask::from_fn(|i| paths[index[i]].depth >= config.limits.rr_depth);
        let mut survived = after;
        survived.roulette(survival);
        after.beta = F::Spectrum::choose(played, survived.beta, after.beta);
        let survives = !played | random.roulette.lt(survival);
        let goes_on = sample.found & survives & !after.beta.is_zero();

        let (after, next) = (after.lanes(), leaving.spawn(sample.wi).lanes());
        let light_mis = LightMis::lanes(before, at.from, sample.chance.hero(), sample.is_delta);
        for i in 0..count {
            let path = &mut paths[index[i]];
            path.alpha = 1.0;
            if !sample.found.lane(i) {
                continue;
            }
            path.scatter_count += 1;
            path.scattered |= !sample.is_delta.lane(i);
            path.light_mis = light_mis(i);
            path.throughput = after(i);
            path.eta = eta.lane(i);
            path.depth += 1;
            if goes_on.lane(i) {
                self.continued.push(index[i]);
                self.next_rays.push(next(i, left[i]));
            }
        }
    }
}
