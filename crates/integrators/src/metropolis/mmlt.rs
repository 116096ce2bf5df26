//! `mmlt`: multiplexed Metropolis light transport (Hachisuka, Kaplanyan, Dachsbacher 2014).
//!
//! A primary sample is a path by *one* technique of bidirectional path tracing, with its MIS weight
//! against all others (see [`crate::bdpt`]). Two of its numbers choose k, the number of scattering
//! vertices, with probability q(k), and one of the k + 2 techniques (s, t) with s + t = k + 2; the
//! others generate the subpaths. With A the film's area,
//!
//! ```text
//! F(u) = A · (k + 2)/q(k) · Σⱼ [ fⱼ(x) / p(λⱼ) ] / Σ_σ Σₖ n_σ p_σ,ₖ(x)
//! ```
//!
//! The weighted contributions of all techniques sum to the pixel, so the mean of F is the pixel. The
//! weights decide where chains spend their steps: a technique that is bad at a path hardly ever has
//! I > 0 there. One camera subpath covers the whole film, and so does one light subpath, hence n_σ = A
//! for t = 1 and 1 per pixel² for the others, as in bidirectional path tracing with one sample per
//! pixel.
//!
//! Hachisuka et al. run separate chains for each k, in proportion to its light. Here q(k) follows the
//! light that a pilot found, and a chain changes k like any other number, so that few chains serve many
//! lengths. See [`crate::metropolis`] for how chains estimate the integral without bias.

use crate::bdpt::Technique;
use crate::bdpt::single_technique::{Subpaths, sample_single_technique};
use crate::metropolis::{
    ChainSettings, Contributions, FilmRegion, Metropolis, PathLengthPdf, PathSampler,
};
use crate::steps::dimensions as dim;
use crate::steps::settings::PathSettings;
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_transport::{LightSearch, ScattererOf, World};

/// The numbers that choose the technique and the length: those between the moment and the first
/// scattering event, which nothing else needs.
const CHOICE: u32 = dim::TIME + 1;

/// The largest allowed path length (segments).
const LONGEST: u32 = 256;

/// Multiplexed Metropolis light transport; the length of its paths must have a limit.
pub type Multiplexed = Metropolis<Techniques>;

impl Multiplexed {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        let mut settings = PathSettings::from_params(params);
        if !params.has("max_depth") {
            let needed = format!("the longest path in segments, at most {LONGEST}");
            params.missing("max_depth", &needed);
        } else if settings.max_depth > LONGEST {
            let given = params.integer_or("max_depth", -1);
            let accepted = format!("0, 1, … {LONGEST}: a path's length is chosen beforehand");
            params.refuse("max_depth", given, &accepted);
        }
        if !params.has("rr_depth") {
            // The technique says where subpaths end.
            settings.rr_depth = u32::MAX;
        }
        Self {
            settings,
            chains: ChainSettings::from_params(params),
            paths: Techniques,
        }
    }
}

/// One technique of bidirectional path tracing per primary sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct Techniques;

impl PathSampler for Techniques {
    const FOLLOWS_LIGHT: bool = true;
    const LIGHT_SEARCH: LightSearch = LightSearch::Either;

    type Lists<'w, W: World + 'w> = Subpaths<ScattererOf<'w, W>>;

    fn kinds(&self, settings: &PathSettings, chains: &ChainSettings) -> usize {
        // A path of n segments has at most n − 1 vertices between its ends.
        let most = settings.max_depth.min(LONGEST);
        most.saturating_sub(chains.least_scattering_vertices()) as usize
    }

    fn find<'w, W: World, S: Sampler>(
        &self,
        (world, settings, chains): (&'w W, &PathSettings, &ChainSettings),
        field: &FilmRegion,
        kinds: &PathLengthPdf,
        sampler: &mut S,
        subpaths: &mut Subpaths<ScattererOf<'w, W>>,
        found: &mut Contributions,
    ) {
        sampler.skip_to(CHOICE);
        let choice = sampler.next_2d();
        let (kind, probability) = kinds.choose(choice.y);
        found.kind = kind;
        // A kind of path is a number of scattering vertices.
        let vertices = kind + chains.least_scattering_vertices() as usize + 2;
        let light = ((choice.x * vertices as f32) as usize).min(vertices - 1);
        let technique = Technique {
            light,
            camera: vertices - light,
            weighted: true,
        };
        sampler.skip_to(dim::FILM);
        let site = field.site(sampler.next_2d());
        let factor = field.area() * vertices as f32 / probability;
        let add = |raster, rgb: glam::Vec3| found.add(raster, rgb * factor);
        sample_single_technique(world, settings, technique, &site, sampler, subpaths, add);
    }
}
