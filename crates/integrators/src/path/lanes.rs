//! Paths at surfaces of one kind, scattered together in vector lanes.
//!
//! Lane i gets the bits that its path would get alone (see [`etalon_transport::LaneShading`]), so that it does not matter which
//! paths meet. Few that are left over, and those at surfaces without a kind, are scattered one by one.

use crate::path::batch::{Lanes, PathBatch};
use crate::path::hooks::{LaneHooks, PathHooks};
use crate::path::lane_vertex::LaneVertex;
use crate::steps::candidates::Candidates;
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathConfig;
use arrayvec::ArrayVec;
use core::ops::ControlFlow;
use etalon_math::lane::{Lane, Mask, Spectral, Vector};
use etalon_sampling::Sampler;
use etalon_transport::{
    LaneBsdf, LaneKind, LaneReceiver, LaneShading, LaneVertices, LeavingRays, LeftSurface, Lights,
    MediumInterface, ShadowQuery, Surfaces, World,
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
        // A camera ray comes from no receiver, but at a moment.
        let from = LaneReceiver {
            time: F::from_fn(|i| self.rays[segment(i)].time),
            ..LaneReceiver::<F>::of_lanes(|i| &path(i).light_mis.from)
        };
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
        let texture_point = |i| lanes.texture_point(ray(i), hit(i));
        let vertices = LaneVertices {
            surface: &surface,
            texture_point: &texture_point,
            wavelengths,
        };
        let wo = -F::Vector::of_lanes(|i| ray(i).direction);
        let mut hooks = C::in_lanes::<F>(|i| &path(i).hooks);
        let bsdf = hooks.wrap_bsdf(&surface, wo, || {
            lanes.bsdf::<F>(kind, |i| hit(i).shape, vertices, wo)
        });
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
            let light = &connection.light;
            let (has_target, infinite) = (light.has_target, leaving.spawn(light.direction));
            let (shadow_rays, found) = match has_target.any() {
                false => (infinite, light.found),
                true => {
                    let (segments, exist) = leaving.toward(light.target);
                    let rays = LeavingRays::choose(has_target, segments, infinite);
                    (rays, light.found & (exist | !has_target))
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
        let played = F::Mask::from_fn(|i| paths[index[i]].depth >= config.limits.rr_depth);
        hooks.on_scatter(&bsdf, wo, &sample);
        let survival = hooks.survival(played, &after, eta);
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
            path.hooks.take_lane(&hooks, i);
            if goes_on.lane(i) {
                self.continued.push(index[i]);
                self.next_rays.push(next(i, left[i]));
            }
        }
    }
}
