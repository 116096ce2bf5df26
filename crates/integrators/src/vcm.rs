//! `vcm`: vertex connection and merging.
//!
//! All techniques of [`crate::bdpt`], and for every surface xᵢ of a path one more: a photon at xᵢ
//! and the camera subpath's vertex at xᵢ, merged if they are less than r apart,
//!
//! ```text
//! pₘ,ᵢ = a₀ … aᵢ · bᵢ … · π r²,   n of them
//! C = Σ_σ Σⱼ [ fⱼ(x) / p(λⱼ) ] / Σ_σ' Σₖ n_σ' p_σ',ₖ(x)
//! ```
//!
//! with σ and σ' over connections and mergings (Georgiev, Křivánek, Davidovič, Slusallek 2012,
//! "Light Transport Simulation with Vertex Connection and Merging"; Hachisuka, Pantaleoni, Jensen
//! 2012). A vertex that scatters discretely is neither connected nor merged.
//!
//! Without `connections` σ and σ' run over mergings alone: bidirectional photon mapping (Vorba 2011,
//! "Bidirectional Photon Mapping"). Lights are then run into only along paths without any vertex at which
//! photons could be merged.
//!
//! A sample is a pass with photons of its own, n of them, and a replicate a progression whose
//! radius shrinks as in [`crate::photons::radius`]. All paths of a pass have the same four
//! wavelengths, so that all can be merged, dispersion or not; those of a progression lie evenly
//! ([`crate::photons`]). Light subpaths that are connected and those that are merged are different
//! ones: weights only ask how many could have made a path.

use crate::bdpt::merging::{self, Merging, MergingParameters};
use crate::bdpt::{Start, estimate};
use crate::photons::radius::Radius;
use crate::photons::sets::WavelengthSets;
use crate::photons::shoot::{in_order, moment, numbers};
use crate::photons::{read_count, rounded};
use crate::steps::camera_ray::{draw_lens, ray_at};
use crate::steps::settings::PathSettings;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Channel, Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing, Preparation,
    SampleJob, SceneCapabilities, Sink, TileSink, World,
};
use std::vec::Drain;

/// Vertex connection and merging.
#[derive(Clone, Debug)]
pub struct ConnectionMerging {
    /// Limits of the path.
    pub settings: PathSettings,
    /// The radius of each pass.
    pub radius: Radius,
    /// Photons per pass; `None` for as many as there are pixels.
    pub photons: Option<u32>,
    /// Whether paths are connected, too, or merged only.
    pub connections: bool,
}

impl Default for ConnectionMerging {
    fn default() -> Self {
        Self {
            settings: PathSettings::default(),
            radius: Radius::default(),
            photons: None,
            connections: true,
        }
    }
}

/// The photons of a pass.
#[derive(Debug)]
pub struct State {
    wavelengths: Wavelengths,
    merging: Merging,
}

impl ConnectionMerging {
    /// Reads the integrator from its description: Mitsuba's parameters of paths, `photons`,
    /// `radius`, `alpha` and `connections`.
    pub fn from_params(params: &Params<'_>) -> Self {
        Self {
            settings: PathSettings::from_params(params),
            radius: Radius::from_params(params),
            photons: read_count(params),
            connections: params.boolean_or("connections", true),
        }
    }

    /// The start of a sample.
    fn start<'a, W: World>(
        &'a self,
        world: &W,
        state: &'a State,
        site: &PixelSample,
        sampler: &mut impl Sampler,
    ) -> Start<'a> {
        let (lens, ..) = draw_lens(sampler);
        let (ray, weight) = ray_at(world, site, lens, state.merging.time());
        Start {
            settings: &self.settings,
            only: None,
            wavelengths: state.wavelengths,
            ray,
            weight,
            merging: Some(&state.merging),
        }
    }
}

impl Preparation for State {
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

impl Integrator for ConnectionMerging {
    const UNBIASED: bool = false;
    const MEDIA: bool = true;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = true;

    type State = State;

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        self.connections
    }

    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        let mut incompatibilities = capabilities.incompatibilities(if self.connections {
            LightSearch::Either
        } else {
            LightSearch::Choosing
        });
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
        let wavelengths = WavelengthSets::new(world, pass, 1).of_pass(pass);
        let radius = self.radius.of(world, pass);
        let pixels = pass.size.x.saturating_mul(pass.size.y);
        let count = rounded(self.photons.unwrap_or(pixels), 1);
        let parameters = MergingParameters {
            radius,
            count,
            connections: self.connections,
            time: moment(pass),
        };
        let photons = in_order(count, placing, |index, found| {
            let mut sampler = numbers(pass, index, count);
            merging::shoot(
                world,
                &wavelengths,
                &self.settings,
                &parameters,
                &mut sampler,
                found,
            );
        });
        State {
            wavelengths,
            merging: Merging::new(photons, parameters),
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
        let subpaths = [&mut Vec::new(), &mut Vec::new()];
        let start = self.start(world, state, site, sampler);
        estimate(world, &start, site, sampler, sink, subpaths);
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        state: &State,
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        let (mut camera_subpath, mut light_subpath) = (Vec::new(), Vec::new());
        for mut job in jobs {
            sink.begin_placed(job.site.pixel, &job.placement());
            let subpaths = [&mut camera_subpath, &mut light_subpath];
            let start = self.start(world, state, &job.site, &mut job.sampler);
            let (site, sampler) = (&job.site, &mut job.sampler);
            estimate(world, &start, site, sampler, sink, subpaths);
        }
    }
}
