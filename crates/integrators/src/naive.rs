//! `naive`: path tracing that runs into lights by chance.
//!
//! The rendering equation, estimated directly: directions are drawn from a density p, and emission
//! counts where a path hits it (Kajiya 1986, without his light sampling),
//!
//! ```text
//! L(x, ωo) ≈ Le(x, ωo) + f(ωo, ωi)·|cos θi| / p(ωi) · L(y, −ωi),   ωi ~ p,   y seen from x along ωi
//! ```
//!
//! It is the simplest estimator, slow if lights are small, and blind to lights without extent.
//! `directions` selects p:
//!
//! - `bsdf`: the scattering model's own importance sampling;
//! - `cosine`: p = |cos θi| / π about the shading normal;
//! - `uniform`: p = 1 / 2π.
//!
//! The latter two depend on the model only in whether it transmits light: then they draw from the
//! whole sphere, with half the density.
//!
//! Such a density never finds discrete directions. So a surface with a null interaction (`mask`,
//! `null`) is passed with the model's probability. If another lobe may be discrete, one half of the
//! remaining samples come from the model, of which only discrete directions are kept, and the other
//! half from p. If no lobe is continuous, all come from the model. A uniform or cosine direction has
//! the same density in every lane, a discrete one has not; [`crate::steps::path_throughput`] handles both.

use crate::steps::arrival::{Arrival, Arriving, next_hit, opacity};
use crate::steps::camera_ray::camera_ray;
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use core::f32::consts::FRAC_1_PI;
use etalon_math::Frame;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_params::Params;
use etalon_sampling::warps::{square_to_cosine_hemisphere, square_to_uniform_hemisphere};
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Channel, Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing, Ray,
    SceneCapabilities, Sensor, Sink, SurfaceInteraction, Surfaces, TransportMode, World,
    one_by_one,
};
use glam::{Vec2, Vec3, Vec4};

/// The density of continuous directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Directions {
    /// The scattering model's importance sampling.
    #[default]
    Bsdf,
    /// In proportion to the cosine.
    Cosine,
    /// All alike.
    Uniform,
}

/// The path tracer without light sampling.
#[derive(Clone, Debug, Default)]
pub struct Naive {
    /// Limits of the path.
    pub settings: PathSettings,
    /// The density of continuous directions.
    pub directions: Directions,
}

/// A direction in which a path continues.
struct Step {
    wi: Vec3,
    /// The factor for [`PathThroughput::scatter`].
    value: Vec4,
    chance: Vec4,
    eta: f32,
    is_null: bool,
}

impl Naive {
    /// Reads the integrator from its description: Mitsuba's parameters of paths, and `directions`.
    pub fn from_params(params: &Params<'_>) -> Self {
        let directions = match params.choice("directions", "bsdf", &["bsdf", "cosine", "uniform"]) {
            "cosine" => Directions::Cosine,
            "uniform" => Directions::Uniform,
            _ => Directions::Bsdf,
        };
        Self {
            settings: PathSettings::from_params(params),
            directions,
        }
    }

    /// Draws the direction in which the path leaves a vertex; `None` if it ends there.
    fn step(
        &self,
        vertex: &SurfaceInteraction,
        bsdf: &impl Bsdf,
        wo: Vec3,
        event: &BounceSamples,
    ) -> Option<Step> {
        let sampled = |u_lobe: f32| {
            let sample = bsdf.sample(wo, u_lobe, event.direction, TransportMode::Radiance)?;
            Some(Step {
                wi: sample.wi,
                value: sample.value,
                chance: sample.chance.lanes(),
                eta: sample.eta,
                is_null: sample.is_null,
            })
            .map(|step| (step, sample.chance.is_delta()))
        };
        if self.directions == Directions::Bsdf || !bsdf.has_continuous() {
            return sampled(event.lobe).map(|(step, _)| step);
        }
        let pass = bsdf.null_probability();
        if event.lobe < pass.x {
            return Some(Step {
                wi: -wo,
                value: bsdf.null_transmittance(),
                chance: pass,
                eta: 1.0,
                is_null: true,
            });
        }
        // The random number rescaled for reuse.
        let rest = (event.lobe - pass.x) / (1.0 - pass.x);
        let by_model = if bsdf.has_discrete() { 0.5 } else { 0.0 };
        if rest < by_model {
            let (step, discrete) = sampled((rest / by_model).min(ONE_MINUS_EPSILON))?;
            // Passing and continuous directions are found elsewhere.
            return (discrete && !step.is_null).then(|| Step {
                chance: step.chance * by_model * (Vec4::ONE - pass),
                ..step
            });
        }
        let (wi, density) = self.draw(vertex, bsdf.hemisphere(), wo, event.direction);
        let value = bsdf.eval(wo, wi, TransportMode::Radiance);
        (value != Vec4::ZERO).then(|| Step {
            wi,
            value,
            chance: (Vec4::ONE - pass) * ((1.0 - by_model) * density),
            eta: 1.0,
            is_null: false,
        })
    }

    /// A direction on `wo`'s side of `hemisphere`, or else on either side of the surface, with its
    /// density (sr⁻¹).
    fn draw(
        &self,
        vertex: &SurfaceInteraction,
        hemisphere: Option<Frame>,
        wo: Vec3,
        u: Vec2,
    ) -> (Vec3, f32) {
        let (side, u, share) = match hemisphere {
            Some(frame) => (wo.dot(frame.n), u, 1.0),
            None if u.x < 0.5 => (1.0, Vec2::new(2.0 * u.x, u.y), 0.5),
            None => (-1.0, Vec2::new(2.0 * u.x - 1.0, u.y), 0.5),
        };
        let frame = hemisphere.unwrap_or(vertex.shading);
        let (local, density) = match self.directions {
            Directions::Uniform => (square_to_uniform_hemisphere(u), 0.5 * FRAC_1_PI),
            _ => {
                let local = square_to_cosine_hemisphere(u);
                (local, local.z * FRAC_1_PI)
            }
        };
        let local = local * Vec3::new(1.0, 1.0, 1.0_f32.copysign(side));
        (frame.to_world(local), density * share)
    }

    /// The radiance along a ray from the camera, per lane and over the sum of the densities'
    /// ratios, and the alpha of what it came to.
    fn incident<W: World, S: Sampler>(
        &self,
        world: &W,
        mut ray: Ray,
        wavelengths: &Wavelengths,
        sampler: &mut S,
    ) -> (Vec4, f32) {
        let PathSettings {
            max_depth,
            rr_depth,
            ..
        } = self.settings;
        let mut throughput = PathThroughput::START;
        let mut radiance = Vec4::ZERO;
        let (mut alpha, mut eta): (f32, f32) = (0.0, 1.0);
        // Number of segments, that of `ray` included.
        let mut depth = 1;
        while depth <= max_depth {
            let hit = next_hit(world, &mut ray, self.settings.sees_through_lights(depth));
            let arriving = Arriving {
                wavelengths,
                throughput: &throughput,
                light_mis: &LightMis::NONE,
            };
            let sees_background = self.settings.sees_background(alpha);
            let vertex = match arriving.at(world, &ray, hit.as_ref(), sees_background) {
                Arrival::Surface(vertex, emission) => {
                    radiance += emission;
                    vertex
                }
                Arrival::Background(emission) => {
                    radiance += emission;
                    alpha = 1.0;
                    break;
                }
                Arrival::Nothing => break,
            };
            let wo = -ray.direction;
            let bsdf = world.surfaces().bsdf(&vertex, wo, wavelengths);
            if depth == max_depth {
                alpha = alpha.max(opacity(&bsdf));
                break;
            }
            let event = BounceSamples::draw(sampler, depth - 1);
            let step = self.step(&vertex, &bsdf, wo, &event);
            if !step.as_ref().is_some_and(|step| step.is_null) {
                alpha = 1.0;
            }
            let Some(step) = step else {
                break;
            };
            throughput.scatter(step.value, step.chance);
            eta *= step.eta;
            if depth >= rr_depth {
                let survival = throughput.survival(eta);
                if !throughput.survives(survival, event.roulette) {
                    break;
                }
            }
            if throughput.beta == Vec4::ZERO {
                break;
            }
            ray = vertex.spawn(step.wi);
            depth += 1;
        }
        (radiance, alpha)
    }
}

impl Integrator for Naive {
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
        capabilities.incompatibilities(LightSearch::Hitting)
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
        let (radiance, alpha) = self.incident(world, ray, &wavelengths, sampler);
        let rgb = world.sensor().weights(&wavelengths).rgb(radiance * weight);
        sink.radiance(rgb.to_array(), alpha);
    }

    one_by_one!();
}
