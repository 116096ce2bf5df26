//! `bdpt`: bidirectional path tracing.
//!
//! A path x₀x₁…xₙ from a light to the camera can be made in many ways: s of its vertices by a subpath
//! from the light, t = n + 1 − s by a subpath from the camera, and the two connected. Each way is a
//! technique with a density of its own,
//!
//! ```text
//! pₛ(x) = Π_{i<s} aᵢ · Π_{i≥s} bᵢ
//! ```
//!
//! with aᵢ and bᵢ the densities per unit area with which a subpath from the light, or from the camera,
//! arrives at xᵢ (Lafortune & Willems 1993; Veach & Guibas 1995; Veach 1997, chapter 10). All techniques *and all
//! four wavelengths* are combined by one balance heuristic,
//!
//! ```text
//! C = Σₛ Σⱼ [ fⱼ(x) / p(λⱼ) ] / Σ_σ Σₖ n_σ p_σ,ₖ(x)
//! ```
//!
//! with n_σ the number of samples that can make the very path: one for every pixel where the
//! light subpath is connected to the camera itself (t = 1), else one. The techniques:
//!
//! - s = 0: the camera subpath runs into a light;
//! - s = 1: a light is sampled from the camera subpath's vertex, with a density of its own in place of a₀;
//! - s ≥ 2, t ≥ 2: a vertex of either subpath, connected;
//! - t = 1, s ≥ 2: the light's vertex connected to the camera: a splat to wherever it is seen.
//!
//! A technique that would connect a vertex that scattered discretely has density zero. Through such
//! a vertex both subpaths have densities with the same Dirac functions, and these cancel: per unit
//! *projected* solid angle, δ(ω_t − R(ω_i)) as a function of ω_t is η² times the same as a function
//! of ω_i, with η the index on the side of ω_t over that on the side of ω_i (it follows from
//! n² dσ⊥ being the same on both sides: Veach 1997, section 5.2). Each subpath's density is given its own η,
//! entering over leaving; their quotient has the square. The projection is along the normal that
//! turned the direction, which is not the surface's where normals are interpolated or mapped.
//!
//! Weights are functions of the path alone, however it was made, and so add up to one. A model resolved
//! for one direction serves the way back, and a discrete direction is as likely one way as the
//! other: the scattering models are tested for both. Russian roulette is not part of the weights.

mod camera_connection;
mod connect;
mod from_camera;
mod from_light;
mod light_hit;
pub(crate) mod merging;
mod path_vertex;
mod pdf_ratios;
mod photon_connection;
pub(crate) mod single_technique;
mod subpath;
mod technique;

use crate::steps::camera_ray::camera_ray;
use crate::steps::dimensions as dim;
use crate::steps::settings::PathSettings;
use connect::Connector;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Channel, Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing, Ray, SampleJob,
    SceneCapabilities, Sensor, Sink, Subject, TileSink, World,
};
use from_camera::FromCamera;
use from_light::FromLight;
use glam::Vec4;
use merging::Merging;
use path_vertex::SubpathVertex;
use std::vec::Drain;
pub use technique::Technique;

/// The bidirectional path tracer.
#[derive(Clone, Debug, Default)]
pub struct Bidirectional {
    /// Limits of the path.
    pub settings: PathSettings,
    /// The only technique to use, for looking at them one by one.
    pub only: Option<Technique>,
}

impl Bidirectional {
    /// Reads the integrator from its description: Mitsuba's parameters of paths, and `s`, `t` and
    /// `weighted` for a single technique.
    pub fn from_params(params: &Params<'_>) -> Self {
        Self {
            settings: PathSettings::from_params(params),
            only: technique::from_params(params),
        }
    }

    /// The start of a sample.
    fn start<W: World>(
        &self,
        world: &W,
        site: &PixelSample,
        sampler: &mut impl Sampler,
    ) -> Start<'_> {
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        Start {
            settings: &self.settings,
            only: self.only,
            wavelengths,
            ray,
            weight,
            merging: None,
        }
    }
}

/// The start of a sample.
pub(crate) struct Start<'a> {
    pub(crate) settings: &'a PathSettings,
    /// The only technique to evaluate, if not all.
    pub(crate) only: Option<Technique>,
    pub(crate) wavelengths: Wavelengths,
    /// The camera's ray; `weight` is its weight.
    pub(crate) ray: Ray,
    pub(crate) weight: f32,
    /// The photons to merge with, if any.
    pub(crate) merging: Option<&'a Merging>,
}

/// Draws one sample; the subpaths are lent for reuse of their memory.
pub(crate) fn estimate<'w, W: World, S: Sampler, K: Sink>(
    world: &'w W,
    begin: &Start<'_>,
    site: &PixelSample,
    sampler: &mut S,
    sink: &mut K,
    [camera_subpath, light_subpath]: [&mut Vec<SubpathVertex<'w, W>>; 2],
) {
    let Start {
        settings,
        only,
        wavelengths,
        ray,
        weight,
        merging,
    } = begin;
    let sensor = world.sensor().weights(wavelengths);
    camera_subpath.clear();
    light_subpath.clear();
    let connects = merging.is_none_or(Merging::connects);
    let mut start = connects
        .then(|| FromLight::start(world, wavelengths, settings, sampler, ray.time))
        .flatten();
    if let Some(start) = &mut start {
        start.trace(
            world,
            wavelengths,
            settings,
            sampler,
            light_subpath,
            usize::MAX,
        );
    }
    sampler.skip_to(dim::LENS);
    let mut connector = Connector {
        world,
        wavelengths,
        settings,
        only: *only,
        site,
        lens: sampler.next_2d(),
        start: start.as_ref(),
        light_subpath,
        camera_connects: false,
        merging: *merging,
        radiance: Vec4::ZERO,
    };
    let mut subpath = FromCamera::start(*ray, settings);
    while subpath.advance(
        world,
        wavelengths,
        settings,
        sampler,
        camera_subpath,
        &mut connector,
    ) {}
    connector.connect_to_camera(|raster, value| {
        sink.splat(raster, sensor.rgb(value).to_array());
    });
    sink.radiance(
        sensor.rgb(connector.radiance * *weight).to_array(),
        subpath.alpha,
    );
}

impl Integrator for Bidirectional {
    const UNBIASED: bool = true;
    const MEDIA: bool = true;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = true;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        true
    }

    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        let mut incompatibilities = capabilities.incompatibilities(match self.only {
            None => LightSearch::Either,
            Some(only) if only.light == 0 => LightSearch::Hitting,
            Some(_) => LightSearch::Choosing,
        });
        incompatibilities.extend(capabilities.rows_in_turn());
        let Some(only) = self.only else {
            return incompatibilities;
        };
        if only.camera == 1 {
            incompatibilities.extend(capabilities.one_way_camera());
            incompatibilities.extend(capabilities.unconnected());
            incompatibilities.extend(capabilities.unsplattable());
        }
        let segments = only.light + only.camera - 1;
        let max_depth = self.settings.max_depth;
        if u32::try_from(segments).map_or(true, |segments| segments > max_depth) {
            let message = format!(
                "the technique s = {}, t = {} makes paths of {segments} segments, and `max_depth` is {max_depth}",
                only.light, only.camera
            );
            let incompatibility =
                Incompatibility::fatal(Subject::Parameter("s"), message).help(format!(
                    "raise `max_depth` to {segments}, or ask for s + t of at most {}",
                    u64::from(max_depth) + 1
                ));
            incompatibilities.push(incompatibility);
        }
        incompatibilities
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
        let subpaths = [&mut Vec::new(), &mut Vec::new()];
        estimate(
            world,
            &self.start(world, site, sampler),
            site,
            sampler,
            sink,
            subpaths,
        );
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        (): &(),
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        let (mut camera_subpath, mut light_subpath) = (Vec::new(), Vec::new());
        for mut job in jobs {
            sink.begin_placed(job.site.pixel, &job.placement());
            let subpaths = [&mut camera_subpath, &mut light_subpath];
            let start = self.start(world, &job.site, &mut job.sampler);
            estimate(world, &start, &job.site, &mut job.sampler, sink, subpaths);
        }
    }
}
