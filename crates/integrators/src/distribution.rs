//! `distribution`: distribution ray tracing, a tree of random rays (Cook, Porter & Carpenter 1984).
//!
//! ```text
//! ⟨L⟩ = Lₑ + 1/N Σⱼ [ w_l f |cos θⱼ| Lₑ(ωⱼ) / p_l(ωⱼ) + f |cos θ'ⱼ| ⟨L(y, −ω'ⱼ)⟩ / p(ω'ⱼ) ]
//! ```
//!
//! Where `path` continues in one direction, this follows N directions from every surface with a
//! continuous lobe, and takes N light samples; y is the surface seen along ω'ⱼ, whose emission has the
//! MIS weight 1 − w_l. So penumbrae and glossy reflections become smooth, at the cost of a tree. Lens
//! and shutter are sampled once for each tree. Smooth surfaces continue one ray, chosen at random.
//!
//! MIS weights are those of `path` ([`crate::steps::path_throughput`]): they depend on the path alone and sum to one over
//! techniques and lanes, so the estimate is unbiased for any N. With N = 1 it is `path`, up to the order
//! of sums. The N directions at a point are stratified in one coordinate. Later bounces contribute less,
//! so N is divided by `decay` at each.

use crate::steps::arrival::{Arrival, Arriving, next_hit, opacity};
use crate::steps::camera_ray::camera_ray;
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::LightConnection;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, BsdfOf, Channel, Incompatibility, Integrator, LightSampleContext, LightSearch, Pass,
    PixelSample, Placing, Ray, SceneCapabilities, Sensor, Sink, SurfaceInteraction, Surfaces,
    TransportMode, World, one_by_one,
};
use glam::{Vec2, Vec3, Vec4};

/// The distribution ray tracer.
#[derive(Clone, Debug)]
pub struct Distribution {
    /// Limits of each path through the tree.
    pub settings: PathSettings,
    /// N at the first surface that scatters into a continuum.
    pub samples: u32,
    /// The divisor of N at each such surface, down to N = 1.
    pub decay: u32,
}

impl Distribution {
    /// Reads what [`PathSettings`] does, `samples` (4) and `decay` (2).
    pub fn from_params(params: &Params<'_>) -> Self {
        let settings = PathSettings::from_params(params);
        let count = |name: &str, default: u32| {
            let value = params.integer_or(name, i64::from(default));
            let good = u32::try_from(value).ok().filter(|n| (1..=4096).contains(n));
            good.unwrap_or_else(|| {
                params.refuse(name, value, "1, 2, … 4096");
                default
            })
        };
        let (samples, decay) = (count("samples", 4), count("decay", 2));
        if samples > 1 && decay == 1 && settings.max_depth == u32::MAX {
            params.error_at(
                "decay",
                "a tree that branches at every surface needs a `max_depth`",
            );
        }
        Self {
            settings,
            samples,
            decay,
        }
    }

    /// N after so many surfaces that scatter into a continuum.
    fn branches(&self, bounces: u32) -> u32 {
        let divisor = (self.decay).checked_pow(bounces).unwrap_or(u32::MAX);
        (self.samples / divisor).max(1)
    }
}

/// A ray of the tree, and the path that led to it.
#[derive(Clone, Copy)]
struct Branch {
    ray: Ray,
    throughput: PathThroughput,
    light_mis: LightMis,
    /// The product of the indices of refraction passed.
    eta: f32,
    /// Number of segments, that of `ray` included.
    depth: u32,
    /// Number of surfaces so far that scatter into a continuum.
    bounces: u32,
    /// Whether it only went straight.
    straight: bool,
}

/// The estimate of a branch.
#[derive(Clone, Copy, Default)]
struct Estimate {
    /// Per lane, over the sum of all densities' ratios (see [`PathThroughput::contribution`]).
    radiance: Vec4,
    /// 1 if it came to anything that it did not pass straight, the background included.
    alpha: f32,
}

/// A tree being grown.
struct Tree<'a, W, S> {
    integrator: &'a Distribution,
    world: &'a W,
    wavelengths: Wavelengths,
    sampler: &'a mut S,
    /// Scattering events so far; each has its own random numbers.
    events: u32,
}

impl<W: World, S: Sampler> Tree<'_, W, S> {
    /// The estimate of a branch and all that follow from it. It is followed in a loop as long as one ray leaves each surface, so that a
    /// path may be as long as it likes.
    fn grow(&mut self, branch: Branch) -> Estimate {
        let mut estimate = Estimate::default();
        let mut next = Some(branch);
        while let Some(branch) = next {
            next = self.visit(branch, &mut estimate);
        }
        estimate
    }

    /// What a branch finds at the next surface, and on the rays that leave it unless it is a single one,
    /// which is left to be followed.
    fn visit(&mut self, mut branch: Branch, estimate: &mut Estimate) -> Option<Branch> {
        let (world, settings) = (self.world, self.integrator.settings);
        estimate.alpha = estimate.alpha.max(f32::from(!branch.straight));
        let hidden = settings.sees_through_lights(branch.depth);
        let hit = next_hit(world, &mut branch.ray, hidden);
        let arriving = Arriving {
            wavelengths: &self.wavelengths,
            throughput: &branch.throughput,
            light_mis: &branch.light_mis,
        };
        let sees_background = settings.sees_background(f32::from(!branch.straight));
        let vertex = match arriving.at(world, &branch.ray, hit.as_ref(), sees_background) {
            Arrival::Surface(vertex, emission) => {
                estimate.radiance += emission;
                vertex
            }
            Arrival::Background(emission) => {
                estimate.radiance += emission;
                estimate.alpha = 1.0;
                return None;
            }
            Arrival::Nothing => return None,
        };
        let last = branch.depth == settings.max_depth;
        if last && !branch.straight {
            return None;
        }
        let wo = -branch.ray.direction;
        let bsdf = world.surfaces().bsdf(&vertex, wo, &self.wavelengths);
        if last {
            estimate.alpha = estimate.alpha.max(opacity(&bsdf));
            return None;
        }
        let continuous = bsdf.has_continuous();
        let count = if continuous {
            self.integrator.branches(branch.bounces)
        } else {
            1
        };
        let share = 1.0 / count as f32;
        let from = LightSampleContext::new(&vertex, wo, &bsdf).combined();
        let mut alpha = 0.0;
        for number in 0..count {
            let event = self.event(number, count);
            if continuous {
                estimate.radiance +=
                    self.connect(&branch, &vertex, &from, &bsdf, wo, &event) * share;
            }
            alpha += share
                * match self.scatter(&branch, &vertex, &from, &bsdf, wo, &event) {
                    Next::Absorbed => 1.0,
                    Next::Ended { straight } => f32::from(!straight),
                    Next::Branch(next) if count == 1 => return Some(next),
                    Next::Branch(next) => {
                        let next = self.grow(next);
                        estimate.radiance += next.radiance * share;
                        next.alpha
                    }
                };
        }
        estimate.alpha = estimate.alpha.max(alpha);
        None
    }

    /// The random numbers of sample `number` of `count` at a point. One coordinate of each
    /// direction is stratified; to stratify two in the same order would tie them to each other.
    fn event(&mut self, number: u32, count: u32) -> BounceSamples {
        let event = BounceSamples::draw(self.sampler, self.events);
        self.events += 1;
        if count == 1 {
            return event;
        }
        let stratum = |u: Vec2| {
            let x = (number as f32 + u.x) / count as f32;
            Vec2::new(x.min(ONE_MINUS_EPSILON), u.y)
        };
        BounceSamples {
            light: stratum(event.light),
            direction: stratum(event.direction),
            ..event
        }
    }

    /// Next-event estimation: one point of a light, weighted against scattering.
    fn connect(
        &self,
        branch: &Branch,
        vertex: &SurfaceInteraction,
        from: &LightSampleContext,
        bsdf: &BsdfOf<'_, W>,
        wo: Vec3,
        event: &BounceSamples,
    ) -> Vec4 {
        let (world, settings) = (self.world, self.integrator.settings);
        let light = world.sample_light(from, &self.wavelengths, event.light_choice, event.light);
        let connection = light
            .and_then(|light| LightConnection::new(&light, &branch.throughput, bsdf, wo, [1.0; 2]));
        let max_null = settings.max_depth - branch.depth - 1;
        connection.map_or(Vec4::ZERO, |connection| {
            connection.traced(world, vertex, &self.wavelengths, max_null)
        })
    }

    /// The branch that leaves a surface.
    fn scatter(
        &self,
        branch: &Branch,
        vertex: &SurfaceInteraction,
        from: &LightSampleContext,
        bsdf: &BsdfOf<'_, W>,
        wo: Vec3,
        event: &BounceSamples,
    ) -> Next {
        let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Radiance)
        else {
            return Next::Absorbed;
        };
        let mut next = Branch {
            ray: vertex.spawn(sample.wi),
            light_mis: branch.light_mis.after(&branch.throughput, from, &sample),
            eta: branch.eta * sample.eta,
            depth: branch.depth + 1,
            bounces: branch.bounces + u32::from(bsdf.has_continuous()),
            straight: branch.straight && sample.is_null,
            ..*branch
        };
        next.throughput.scatter(sample.value, sample.chance.lanes());
        let straight = next.straight;
        if branch.depth >= self.integrator.settings.rr_depth {
            let survival = next.throughput.survival(next.eta);
            if !next.throughput.survives(survival, event.roulette) {
                return Next::Ended { straight };
            }
        }
        if next.throughput.beta == Vec4::ZERO {
            return Next::Ended { straight };
        }
        Next::Branch(next)
    }
}

/// The continuation after a surface.
enum Next {
    Absorbed,
    Ended { straight: bool },
    Branch(Branch),
}

impl Integrator for Distribution {
    const UNBIASED: bool = true;
    const MEDIA: bool = false;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = false;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        capabilities.incompatibilities(LightSearch::FromCamera)
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Blocks
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(&self, _: &W, _: &impl Placing, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        let mut tree = Tree {
            integrator: self,
            world,
            wavelengths,
            sampler,
            events: 0,
        };
        let estimate = if self.settings.max_depth > 0 {
            tree.grow(Branch {
                ray,
                throughput: PathThroughput::START,
                light_mis: LightMis::NONE,
                eta: 1.0,
                depth: 1,
                bounces: 0,
                straight: true,
            })
        } else {
            Estimate::default()
        };
        let rgb = world
            .sensor()
            .weights(&wavelengths)
            .rgb(estimate.radiance * weight);
        sink.radiance(rgb.to_array(), estimate.alpha);
    }

    one_by_one!();
}
