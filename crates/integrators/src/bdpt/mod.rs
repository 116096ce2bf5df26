//! `bdpt`: bidirectional path tracing.
//!
//! A path x₀x₁…xₙ from a light to the camera can be made in many ways: s of its vertices by a walk
//! from the light, t = n + 1 − s by a walk from the camera, and the two connected. Each way is a
//! technique with a density of its own,
//!
//! ```text
//! pₛ(x) = Π_{i<s} aᵢ · Π_{i≥s} bᵢ
//! ```
//!
//! with aᵢ and bᵢ the densities per unit area with which a walk from the light, or from the camera,
//! arrives at xᵢ (Lafortune & Willems 1993; Veach & Guibas 1995; Veach 1997, chapter 10). All techniques *and all
//! four wavelengths* are combined by one balance heuristic,
//!
//! ```text
//! C = Σₛ Σⱼ [ fⱼ(x) / p(λⱼ) ] / Σ_σ Σₖ n_σ p_σ,ₖ(x)
//! ```
//!
//! with n_σ the number of samples that can make the very path: one for every pixel where the
//! light's walk is connected to the camera itself (t = 1), else one. The techniques:
//!
//! - s = 0: the camera's walk runs into a light;
//! - s = 1: a light is sampled from the camera walk's corner, with a density of its own in place of a₀;
//! - s ≥ 2, t ≥ 2: a corner of either walk, connected;
//! - t = 1, s ≥ 2: the light's corner connected to the camera: a splat to wherever it is seen.
//!
//! A technique that would connect a corner that scattered discretely has density zero. Through such
//! a corner both walks have densities with the same Dirac functions, and these cancel: per unit
//! *projected* solid angle, δ(ω_t − R(ω_i)) as a function of ω_t is η² times that of ω_i
//! (Veach 1997, section 5.2), so the walk that enters the medium of greater η has it.
//!
//! Weights are functions of the path alone, however it was made: reflection's densities are taken
//! in the direction that each walk would have gone, from models resolved once; Russian roulette is not part of
//! them.

mod connect;
mod corner;
mod subpath;
mod weight;

use crate::dimensions as dim;
use crate::path::camera_ray;
use crate::settings::{PathSettings, ignore_scheduling};
use connect::Connector;
use corner::Corner;
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_spectrum::sensor_response;
use etalon_transport::{Draft, Integrator, PixelSite, Sink, TileSink, World};
use glam::Vec4;
use subpath::{FromCamera, FromLight};

/// The bidirectional path tracer.
#[derive(Clone, Debug, Default)]
pub struct Bidirectional {
    /// Limits of the path.
    pub settings: PathSettings,
}

impl Bidirectional {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        ignore_scheduling(params);
        Self {
            settings: PathSettings::from_params(params),
        }
    }

    /// One sample; the lists are only lent, so that they need not be made anew.
    fn sample_with<'w, W: World, S: Sampler, K: Sink>(
        &self,
        world: &'w W,
        site: &PixelSite,
        sampler: &mut S,
        sink: &mut K,
        [eye, light]: [&mut Vec<Corner<W::Bsdf<'w>>>; 2],
    ) {
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        let sensor = sensor_response(&wavelengths);
        eye.clear();
        light.clear();
        let settings = &self.settings;
        let mut start = FromLight::start(world, &wavelengths, settings, sampler);
        if let Some(start) = &mut start {
            start.walk(world, &wavelengths, settings, sampler, light);
        }
        sampler.skip_to(dim::LENS);
        let mut connector = Connector {
            world,
            wavelengths: &wavelengths,
            settings,
            site,
            lens: sampler.next_2d(),
            start: start.as_ref(),
            light,
            camera_connects: false,
            radiance: Vec4::ZERO,
        };
        let mut walk = FromCamera::start(ray, settings);
        while walk.advance(world, &wavelengths, settings, sampler, eye, &mut connector) {}
        connector.see_all(|raster, value| {
            sink.splat(raster, sensor.rgb(value).to_array());
        });
        sink.radiance(
            sensor.rgb(connector.radiance * weight).to_array(),
            walk.alpha,
        );
    }
}

impl Integrator for Bidirectional {
    type State = ();

    fn splats(&self) -> bool {
        true
    }

    fn prepare<W: World>(&self, _: &W, _: u64, _: u32) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSite,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let lists = [&mut Vec::new(), &mut Vec::new()];
        self.sample_with(world, site, sampler, sink, lists);
    }

    fn sample_all<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        (): &(),
        drafts: &mut [Draft<S>],
        sink: &mut K,
    ) {
        let (mut eye, mut light) = (Vec::new(), Vec::new());
        for draft in drafts {
            sink.begin_sample(draft.site.pixel, draft.weight);
            let lists = [&mut eye, &mut light];
            self.sample_with(world, &draft.site, &mut draft.sampler, sink, lists);
        }
    }
}
