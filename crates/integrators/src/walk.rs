//! One path of the path tracer, from surface to surface.

use crate::candidates::{Aim, Candidates};
use crate::companion::Companion;
use crate::dimensions::Event;
use crate::path::camera_ray;
use crate::prefix::Prefix;
use crate::rival::Rival;
use crate::settings::{LightCandidates, PathSettings};
use core::ops::Range;
use etalon_sampling::Sampler;
use etalon_spectrum::{Wavelengths, sensor_response};
use etalon_transport::{
    Bsdf, Hit, LightSample, Mode, PixelSite, Ray, Receiver, Sink, Vertex, World,
};
use glam::{Vec3, Vec4};

/// A path being followed.
pub(crate) struct Walk<'a, S, C = ()> {
    sampler: &'a mut S,
    wavelengths: Wavelengths,
    /// The factor by which what is found counts.
    weight: f32,
    ray: Ray,
    /// What `ray` hits, once that was asked.
    hit: Option<Hit>,
    prefix: Prefix,
    rival: Rival,
    /// The product of the indices of refraction passed.
    eta: f32,
    /// Number of segments, that of `ray` included.
    depth: u32,
    /// Surfaces behind at which it scattered, not counting those that it passed straight.
    corners: u32,
    /// Whether the path goes on with `ray`.
    goes_on: bool,
    connection: Option<Connection>,
    /// How many light samples compete for the shadow ray of the next surface. One, once the path was scattered at
    /// random: what is farther down the path adds less noise than the samples take time.
    candidates: LightCandidates,
    /// The radiance found, per lane, over the sum of all densities' ratios (see
    /// [`Prefix::estimate`]).
    radiance: Vec4,
    /// 1 if the path met anything that it did not pass straight, the background included; where
    /// its length ends at a surface, the probability of that.
    alpha: f32,
    companion: C,
}

/// A light sample before its shadow ray is traced.
struct Connection {
    ray: Ray,
    crossings: u32,
    aim: Aim,
}

impl<'a, S: Sampler, C: Companion> Walk<'a, S, C> {
    /// The path of a sample, before its first surface is known.
    #[inline]
    pub(crate) fn start<W: World>(
        world: &W,
        settings: &PathSettings,
        site: &PixelSite,
        sampler: &'a mut S,
        companion: C,
    ) -> Self {
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        Self {
            sampler,
            wavelengths,
            weight,
            ray,
            hit: None,
            prefix: Prefix::START,
            rival: Rival::NONE,
            eta: 1.0,
            depth: 1,
            corners: 0,
            goes_on: settings.max_depth > 0,
            connection: None,
            candidates: LightCandidates::ONE,
            radiance: Vec4::ZERO,
            alpha: 0.0,
            companion,
        }
    }

    /// The same with several light samples for one shadow ray.
    #[inline]
    pub(crate) fn with_candidates(self, candidates: LightCandidates) -> Self {
        Self { candidates, ..self }
    }

    /// The companion, at the end.
    #[inline]
    pub(crate) fn into_companion(self) -> C {
        self.companion
    }

    /// Whether the path goes on.
    #[inline]
    pub(crate) fn goes_on(&self) -> bool {
        self.goes_on
    }

    /// How opaque what it met is.
    #[inline]
    pub(crate) fn alpha(&self) -> f32 {
        self.alpha
    }

    /// Delivers what was found.
    #[inline]
    pub(crate) fn deliver(&self, sink: &mut impl Sink) {
        sink.radiance(self.colour().to_array(), self.alpha);
    }

    /// The colour found.
    #[inline]
    pub(crate) fn colour(&self) -> Vec3 {
        sensor_response(&self.wavelengths).rgb(self.radiance * self.weight)
    }

    /// Follows the path alone and to its end, but keeps of what it finds only the paths with as
    /// many corners as `wanted` says.
    pub(crate) fn follow<W: World>(
        &mut self,
        world: &W,
        settings: &PathSettings,
        wanted: &Range<u32>,
    ) {
        while self.goes_on && self.corners < wanted.end {
            self.advance(world);
            let (radiance, corners) = (self.radiance, self.corners);
            self.meet(world, settings);
            if corners < wanted.start {
                self.radiance = radiance;
            }
            if wanted.contains(&(corners + 1)) {
                self.see_light(world);
            } else {
                self.connection = None;
            }
        }
    }

    /// Finds the next surface.
    #[inline]
    pub(crate) fn advance<W: World>(&mut self, world: &W) {
        self.hit = world.intersect(&self.ray);
    }

    /// Meets the surface found: adds what it emits, prepares a light sample, and scatters.
    #[inline]
    pub(crate) fn meet<W: World>(&mut self, world: &W, settings: &PathSettings) {
        self.goes_on = false;
        let direction = self.ray.direction;
        let Some(hit) = self.hit else {
            // A hidden sky stays hidden to rays that only went straight.
            let visible = !settings.hide_emitters || self.alpha > 0.0;
            if visible && world.has_background() {
                self.alpha = 1.0;
                let radiance = world.background(direction, &self.wavelengths);
                let other = self.rival.at_background(world, direction);
                let estimate = self.prefix.estimate(radiance, other);
                self.radiance += estimate;
                self.companion.found(estimate);
            }
            return;
        };
        let emits = world.is_emitter(&hit);
        if emits && settings.hide_emitters && self.depth == 1 {
            // The camera looks through hidden lights.
            self.ray = world.vertex(&self.ray, &hit).spawn(direction);
            self.goes_on = true;
            return;
        }
        let last = self.depth == settings.max_depth;
        if last && !emits && self.alpha > 0.0 {
            return;
        }
        let vertex = world.vertex(&self.ray, &hit);
        let wo = -direction;
        if emits {
            let radiance = world.emitted(&vertex, wo, &self.wavelengths);
            if radiance != Vec4::ZERO {
                let other = self.rival.at_surface(world, &vertex, direction);
                let estimate = self.prefix.estimate(radiance, other);
                self.radiance += estimate;
                self.companion.found(estimate);
            }
        }
        let bsdf = world.bsdf(&vertex, wo, &self.wavelengths);
        let bsdf = self.companion.steer(&vertex, wo, bsdf);
        if last {
            // Where the path would go on we do not ask; how likely straight on, we know.
            let stopped = 1.0 - 0.25 * bsdf.passing_probability().element_sum();
            self.alpha = self.alpha.max(stopped);
            return;
        }
        let event = Event::draw(self.sampler, self.depth - 1);
        let from = Receiver::new(&vertex, wo, &bsdf).combined();
        if bsdf.has_continuous() {
            let prefix = self.prefix;
            let candidates = Candidates::at(self.candidates, world, &from);
            let aim = |light: &LightSample| Aim::new(light, &prefix, &bsdf, wo, [1.0; 2]);
            let aim = candidates.draw(world, &from, &self.wavelengths, &event, self.sampler, aim);
            self.connection = aim.and_then(|aim| {
                Some(Connection {
                    ray: vertex.shadow_ray(aim.direction, aim.target)?,
                    crossings: settings.max_depth - self.depth - 1,
                    aim,
                })
            });
            self.companion.aimed();
        }
        self.scatter(&vertex, &from, &bsdf, wo, settings, &event);
    }

    /// Takes the path around the corner, or ends it.
    #[inline]
    fn scatter(
        &mut self,
        vertex: &Vertex,
        from: &Receiver,
        bsdf: &impl Bsdf,
        wo: Vec3,
        settings: &PathSettings,
        event: &Event,
    ) {
        let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, Mode::Radiance) else {
            self.alpha = 1.0;
            return;
        };
        if !sample.passes {
            self.alpha = 1.0;
            self.corners += 1;
        }
        if !sample.chance.is_discrete() {
            self.candidates = LightCandidates::ONE;
        }
        self.rival = self.rival.after(&self.prefix, from, &sample);
        self.prefix.extend(sample.value, sample.chance.lanes());
        self.eta *= sample.eta;
        self.ray = vertex.spawn(sample.wi);
        (self.companion).scattered(vertex, bsdf, wo, &sample, &self.prefix);
        if self.depth >= settings.rr_depth {
            let survival = self.companion.survival(&self.prefix, self.eta);
            if !(event.roulette < survival) {
                return;
            }
            self.prefix.survive(survival);
        }
        self.depth += 1;
        self.goes_on = self.prefix.value != Vec4::ZERO;
    }

    /// Traces the shadow ray of the light sample that was prepared, if any.
    #[inline]
    pub(crate) fn see_light<W: World>(&mut self, world: &W) {
        let Some(light) = self.connection.take() else {
            return;
        };
        if let Some(passage) = world.passage(&light.ray, &self.wavelengths, light.crossings) {
            let estimate = light
                .aim
                .estimate(passage.transmittance, passage.probability);
            self.radiance += estimate;
            self.companion.lit(estimate);
        }
    }
}
