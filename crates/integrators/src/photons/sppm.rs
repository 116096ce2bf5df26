//! `sppm`: stochastic progressive photon mapping.
//!
//! A progression of N passes, each with photons and camera paths of its own, whose radius shrinks,
//!
//! ```text
//! C = 1/N Σᵢ Cᵢ(rᵢ),   rᵢ₊₁² / rᵢ² = (i + α) / (i + 1)
//! ```
//!
//! with Cᵢ the estimate of [`crate::photons`] (Hachisuka, Ogaki, Jensen 2008; Hachisuka & Jensen
//! 2009; in this form without memory Knaus & Zwicker 2011, see [`crate::photons::radius`]). A
//! sample is a pass, and a replicate a whole progression: more samples per replicate reduce its
//! bias, more replicates do not.
//!
//! Direct light is sampled instead of estimated from photons, unless the scene asks for the latter. The photon
//! estimate is biased, most near edges and where illumination is curved within the radius.

use crate::photons::gather::{GatherConfig, Layer, follow_all, follow_one};
use crate::photons::kernel::{Kernel, KernelLookup};
use crate::photons::radius::Radius;
use crate::photons::sets::WavelengthSets;
use crate::photons::shoot::{Kind, PhotonMap, moment, shoot};
use crate::photons::{read_count, read_sets, rounded};
use crate::steps::settings::PathSettings;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing, Preparation,
    SampleJob, SceneCapabilities, Sink, TileSink, World,
};
use std::vec::Drain;

/// Stochastic progressive photon mapping.
#[derive(Clone, Debug)]
pub struct Progressive {
    /// Limits of the path.
    pub settings: PathSettings,
    /// The radius of each pass.
    pub radius: Radius,
    /// Photons per pass; `None` for as many as there are pixels.
    pub photons: Option<u32>,
    /// Sets of wavelengths per pass.
    pub sets: u32,
    /// Whether direct light is sampled instead of being left to photons too.
    pub sample_lights: bool,
}

impl Default for Progressive {
    fn default() -> Self {
        Self {
            settings: PathSettings::default(),
            radius: Radius::default(),
            photons: None,
            sets: SETS,
            sample_lights: true,
        }
    }
}

/// Sets of wavelengths per pass where the scene does not say.
const SETS: u32 = 4;

/// The photons of a pass.
#[derive(Debug)]
pub struct State {
    sets: WavelengthSets,
    /// The moment of the pass.
    time: f32,
    map: PhotonMap,
    shot: u32,
    /// The radii on surfaces and in media (m).
    radii: [f32; 2],
}

impl Progressive {
    /// Reads the integrator from its description: Mitsuba's parameters of paths, `photons`,
    /// `radius`, `alpha`, `wavelength_sets` and `sample_lights`.
    pub fn from_params(params: &Params<'_>) -> Self {
        Self {
            settings: PathSettings::from_params(params),
            radius: Radius::from_params(params),
            photons: read_count(params),
            sets: read_sets(params, SETS),
            sample_lights: params.boolean_or("sample_lights", true),
        }
    }

    fn plan<R>(&self, state: &State, with: impl FnOnce(&GatherConfig<'_>) -> R) -> R {
        let first: fn(Kind) -> bool = if self.sample_lights {
            |kind| kind != Kind::Direct
        } else {
            |_| true
        };
        let [lookup, in_space] = state.radii.map(|radius| KernelLookup {
            radius,
            nearest: 0,
            kernel: Kernel::Box,
        });
        let layers = [Layer {
            map: &state.map,
            lookup,
            in_space,
            shot: state.shot,
            first,
            second: |_| false,
        }];
        with(&GatherConfig {
            settings: &self.settings,
            sets: &state.sets,
            layers: &layers,
            time: state.time,
            final_gather: false,
            sample_lights: self.sample_lights,
        })
    }
}

impl Preparation for State {
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

impl Integrator for Progressive {
    const UNBIASED: bool = false;
    const MEDIA: bool = true;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = true;

    type State = State;

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    /// Photons come from lights that were chosen; one that can only be hit is seen itself, and nothing that it
    /// shines on.
    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        let mut incompatibilities = capabilities.incompatibilities(LightSearch::Choosing);
        incompatibilities.extend(capabilities.rows_in_turn());
        incompatibilities
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Independent
    }

    fn samples_per_pass(&self) -> Option<u32> {
        Some(1)
    }

    fn prepare<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        _: Option<State>,
    ) -> State {
        let sets = WavelengthSets::new(world, pass, self.sets as usize);
        let pixels = pass.size.x.saturating_mul(pass.size.y);
        let shot = rounded(self.photons.unwrap_or(pixels), self.sets);
        let photons = shoot(world, placing, &self.settings, &sets, pass, shot);
        State {
            time: moment(pass),
            sets,
            map: PhotonMap::new(photons),
            shot,
            radii: [
                self.radius.of(world, pass),
                self.radius.in_space(world, pass),
            ],
        }
    }

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        state: &State,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        self.plan(state, |plan| follow_one(world, plan, site, sampler, sink));
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        state: &State,
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        self.plan(state, |plan| follow_all(world, plan, jobs, sink));
    }
}
