//! `pssmlt`: primary sample space Metropolis light transport over the path tracer.
//!
//! A primary sample u is the random numbers of one sample of [`crate::path`]: film position, aperture,
//! wavelengths, time, and those of every scattering event. With A the film's area and C(u) that
//! sample's estimate, including light sampling and the weights over techniques and wavelengths, chains of
//! N steps in total estimate the pixel j with the filter hⱼ by
//!
//! ```text
//! Ĉⱼ = b̂/N · Σₙ [ (1 − aₙ) w(xₙ) hⱼ(xₙ) F(xₙ)/I(xₙ) + aₙ w(yₙ) hⱼ(yₙ) F(yₙ)/I(yₙ) ]
//!    + 1/N · Σᵤ (1 − w(u))/ρ · hⱼ(u) F(u),        F(u) = A·C(u)
//! ```
//!
//! (Kelemen, Szirmay-Kalos, Antal, Csonka 2002). xₙ is the state of a chain, yₙ its proposal, and
//! aₙ = min(1, I(yₙ)/I(xₙ)): both contribute by their expected share. u are the uniform samples, ρ of
//! them per step, w is the MIS weight of chains against them, and b̂ estimates ∫ I du; see
//! [`crate::metropolis`] for each and for why there is no bias. Light that was scattered at most once
//! (with `separate_direct`; else directly visible lights) is not part of F but added by ordinary
//! samples.

use crate::metropolis::{
    ChainSettings, Contributions, FilmRegion, Metropolis, PathLengthPdf, PathSampler,
};
use crate::path::follow_part;
use crate::path::state::PathState;
use crate::steps::dimensions as dim;
use crate::steps::settings::{PathConfig, PathSettings};
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_transport::{LightSearch, World};

/// Primary sample space Metropolis light transport.
pub type PrimarySpace = Metropolis<CameraPaths>;

impl PrimarySpace {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        Self {
            settings: PathSettings::from_params(params),
            chains: ChainSettings::from_params(params),
            paths: CameraPaths,
        }
    }
}

/// One path of the path tracer per primary sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraPaths;

impl PathSampler for CameraPaths {
    const FOLLOWS_LIGHT: bool = false;
    const LIGHT_SEARCH: LightSearch = LightSearch::FromCamera;

    type Lists<'w, W: World + 'w> = ();

    fn kinds(&self, settings: &PathSettings, chains: &ChainSettings) -> usize {
        // All kinds together. A path has more segments than scattering vertices.
        usize::from(settings.max_depth > chains.least_scattering_vertices())
    }

    fn find<W: World, S: Sampler>(
        &self,
        (world, settings, chains): (&W, &PathSettings, &ChainSettings),
        field: &FilmRegion,
        _: &PathLengthPdf,
        sampler: &mut S,
        (): &mut (),
        found: &mut Contributions,
    ) {
        sampler.skip_to(dim::FILM);
        let site = field.site(sampler.next_2d());
        let config = PathConfig::plain(*settings);
        let (mut path, ray) = PathState::start(world, &site, sampler, ());
        let wanted = chains.least_scattering_vertices()..u32::MAX;
        follow_part(world, &config, (&mut path, ray), &wanted);
        found.add(site.raster, path.colour(world) * field.area());
    }
}
