//! Paths at surfaces of one kind, scattered together in vector lanes.
//!
//! Lane i gets the bits that its path would get alone (see [`etalon_transport::LaneShading`]), so that it does not matter which
//! paths meet. Those that are left over, and those at surfaces without a kind, are scattered one by one.

use crate::path::batch::{Arrived, PathBatch};
use crate::path::hooks::PathHooks;
use crate::steps::candidates::{Candidates, TURN};
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::UnoccludedPath;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathConfig;
use arrayvec::ArrayVec;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::{F32x8, Lane, MOST_LANES, Mask, Select, Spectral, Vector, per_lane};
use etalon_sampling::Sampler;
use etalon_transport::{
    LaneBsdf, LaneKind, LaneReceiver, LaneShading, LaneVertices, MediumInterface, ShadowQuery,
    World,
};
use glam::Vec4;

/// The lanes in use.
type Lanes = F32x8;

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
struct LaneVertex<'a, F: Lane, L: LaneShading> {
    lanes: &'a L,
    bsdf: L::Bsdf<'a, F>,
    vertices: LaneVertices<'a>,
    wo: F::Vector,
    from: LaneReceiver<F>,
    /// The paths that led there.
    before: PathThroughput<F>,
}

impl<F: Lane, L: LaneShading> LaneVertex<'_, F, L> {
    /// The connection to a light sample.
    #[inline(always)]
    fn connect(&self, wanted: F::Mask, u_light: F, u: [F; 2]) -> LaneConnection<F> {
        let waves = self.vertices.wavelengths;
        let light = (self.lanes).sample_light(&self.from, waves, wanted, u_light, u);
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
        events: &LaneEvents<F>,
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

/// The random numbers of several scattering events.
struct LaneEvents<F> {
    light: [F; 2],
    direction: [F; 2],
    light_choice: F,
    lobe: F,
    roulette: F,
}

impl<F: Lane> LaneEvents<F> {
    #[inline(always)]
    fn of_lanes(events: &[BounceSamples]) -> Self {
        Self {
            light: [0, 1].map(|k| F::from_fn(|i| events[i].light[k])),
            direction: [0, 1].map(|k| F::from_fn(|i| events[i].direction[k])),
            light_choice: F::from_fn(|i| events[i].light_choice),
            lobe: F::from_fn(|i| events[i].lobe),
            roulette: F::from_fn(|i| events[i].roulette),
        }
    }
}

impl<'w, W: World, S: Sampler, C: PathHooks, const N: usize> PathBatch<'w, W, S, C, N> {
    /// Scatters paths at surfaces that have a kind, as many together as there are lanes, and calls `alone` for every other one.
    #[inline]
    pub(super) fn scatter_by_kind(
        &mut self,
        (world, config): (&'w W, &PathConfig),
        mut alone: impl FnMut(&mut Self, usize),
    ) {
        let Some(lanes) = world.lanes().filter(|_| C::PLAIN) else {
            (0..self.arrived.len()).for_each(|place| alone(self, place));
            return;
        };
        let mut groups: [ArrayVec<usize, { Lanes::WIDTH }>; LaneKind::COUNT] =
            core::array::from_fn(|_| ArrayVec::new());
        for place in 0..self.arrived.len() {
            let Arrived { path, ray, vertex } = &self.arrived[place];
            let last = self.paths[*path].is_last(config);
            let stays = vertex.media == MediumInterface::within(ray.medium);
            match lanes.kind(vertex).filter(|_| stays && !last) {
                None => alone(self, place),
                Some(kind) => {
                    let group = &mut groups[usize::from(kind.0)];
                    group.push(place);
                    if group.is_full() {
                        self.scatter_together::<Lanes>((world, lanes, config), kind, group);
                        group.clear();
                    }
                }
            }
        }
        for place in groups.iter().flatten() {
            alone(self, *place);
        }
    }

    /// Scatters as many paths as there are lanes, at surfaces of one kind: the ones at these places of `arrived`.
    #[inline(never)]
    fn scatter_together<F: Lane>(
        &mut self,
        (world, lanes, config): (&'w W, &'w W::Lanes, &PathConfig),
        kind: LaneKind,
        places: &[usize],
    ) {
        let Self { paths, arrived, .. } = self;
        let arrived = |i: usize| &arrived[places[i.min(F::WIDTH - 1)]];
        let mut events = [BounceSamples::default(); MOST_LANES];
        for (i, event) in events.iter_mut().enumerate().take(F::WIDTH) {
            *event = paths[arrived(i).path].draw_event();
        }
        let random = LaneEvents::<F>::of_lanes(&events);
        let path = |i: usize| &paths[arrived(i).path];
        let vertices: [_; MOST_LANES] = core::array::from_fn(|i| &arrived(i).vertex);
        let wavelengths: [_; MOST_LANES] = core::array::from_fn(|i| path(i).wavelengths);
        let vertices = LaneVertices {
            vertices: &vertices[..F::WIDTH],
            wavelengths: &wavelengths[..F::WIDTH],
        };
        let wo = F::Vector::of_lanes(|i| -arrived(i).ray.direction);
        let bsdf = lanes.bsdf::<F>(kind, vertices, wo);
        let hemisphere = bsdf.hemisphere(wo);
        let mut throughput = PathThroughput::<F> {
            beta: F::Spectrum::of_lanes(|i| path(i).throughput.beta),
            r_u: F::Spectrum::of_lanes(|i| path(i).throughput.r_u),
        };
        let at = LaneVertex {
            lanes,
            vertices,
            wo,
            from: LaneReceiver {
                position: F::Vector::of_lanes(|i| arrived(i).vertex.position),
                normal: hemisphere
                    .unwrap_or_else(|| F::Vector::of_lanes(|i| arrived(i).vertex.shading.n)),
                one_sided: F::Mask::splat(hemisphere.is_some()),
                time: F::from_fn(|i| arrived(i).vertex.time),
            },
            before: throughput,
            bsdf,
        };
        let counts = per_lane::<F, _>(|i| {
            Candidates::at(path(i).candidates(config), world, &at.from.at_lane(i)).count()
        });
        let sample = at.bsdf.sample(wo, random.lobe, random.direction);
        let eta = F::from_fn(|i| path(i).eta) * sample.eta;
        throughput.scatter(sample.value, sample.chance);
        let survival = throughput.survival(eta);
        let survives = random.roulette.lt(survival);

        if at.bsdf.has_continuous() {
            let connection = match counts.into_iter().max() {
                Some(most) if most > 1 => {
                    let mut shifts = [0.0; MOST_LANES];
                    for i in (0..F::WIDTH).filter(|i| counts[*i] > 1) {
                        shifts[i] = paths[arrived(i).path].sampler.next_1d();
                    }
                    let counts = F::from_fn(|i| counts[i] as f32);
                    at.resample(&random, F::load(&shifts), counts, most)
                }
                _ => at.connect(F::Mask::splat(true), random.light_choice, random.light),
            };
            for i in (0..F::WIDTH).filter(|i| connection.found.lane(*i)) {
                let Arrived { path, vertex, .. } = arrived(i);
                let direction = connection.direction.at_lane(i);
                let has_target = connection.has_target.lane(i);
                let target = has_target.then(|| connection.target.at_lane(i));
                let Some(ray) = vertex.shadow_ray(direction, target) else {
                    continue;
                };
                let depth = paths[*path].depth;
                self.waiting.push((*path, connection.path.at_lane(i)));
                self.shadow_rays.push(ShadowQuery {
                    ray,
                    wavelengths: wavelengths[i],
                    crossings: config.null_crossings(depth),
                });
            }
        }

        for i in 0..F::WIDTH {
            let Arrived {
                path: index,
                vertex,
                ..
            } = arrived(i);
            let path = &mut paths[*index];
            path.alpha = 1.0;
            if !sample.found.lane(i) {
                continue;
            }
            let is_delta = sample.is_delta.lane(i);
            path.scatter_count += 1;
            path.scattered |= !is_delta;
            path.light_mis = match is_delta {
                true => LightMis::NONE,
                false => LightMis {
                    from: at.from.at_lane(i),
                    r_l: path.throughput.r_u / sample.chance.hero().lane(i),
                },
            };
            path.throughput = throughput.at_lane(i);
            path.eta = eta.lane(i);
            if path.depth >= config.limits.rr_depth {
                if !survives.lane(i) {
                    continue;
                }
                path.throughput.roulette(survival.lane(i));
            }
            path.depth += 1;
            if path.throughput.beta != Vec4::ZERO {
                self.continued
                    .push((*index, vertex.spawn(sample.wi.at_lane(i))));
            }
        }
    }
}
