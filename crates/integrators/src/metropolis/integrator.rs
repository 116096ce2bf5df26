//! The integrator that runs chains, generic over the paths of its primary samples.

use super::{BootstrapState, ChainSettings, Contributions, FilmRegion, Integrand, PathLengthPdf};
use crate::steps::settings::PathSettings;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing,
    SceneCapabilities, Sink, World, one_by_one,
};

/// Turns primary samples into paths.
pub(crate) trait PathSampler: Sync {
    /// The way in which its paths find lights.
    const LIGHT_SEARCH: LightSearch;
    /// See [`Integrator::FOLLOWS_LIGHT`].
    const FOLLOWS_LIGHT: bool;

    /// Memory that one path lends to the next.
    type Lists<'w, W: World + 'w>: Default;

    /// Number of kinds of paths; 0 if there is nothing to find.
    fn kinds(&self, settings: &PathSettings, chains: &ChainSettings) -> usize;

    /// Turns a primary sample into contributions to the film.
    fn find<'w, W: World, S: Sampler>(
        &self,
        place: (&'w W, &PathSettings, &ChainSettings),
        field: &FilmRegion,
        kinds: &PathLengthPdf,
        sampler: &mut S,
        lists: &mut Self::Lists<'w, W>,
        found: &mut Contributions,
    );
}

/// Metropolis light transport over the paths of `P`.
#[derive(Clone, Debug, Default)]
pub struct Metropolis<P> {
    /// Limits of the path.
    pub settings: PathSettings,
    /// The settings of chains.
    pub chains: ChainSettings,
    /// The mapping from primary samples to paths.
    pub paths: P,
}

/// The paths in a world.
struct InWorld<'w, W, P> {
    integrator: &'w Metropolis<P>,
    world: &'w W,
}

impl<'w, W: World, P: PathSampler> Integrand for InWorld<'w, W, P> {
    type Lists = P::Lists<'w, W>;

    fn kinds(&self) -> usize {
        let Metropolis {
            settings,
            chains,
            paths,
        } = self.integrator;
        paths.kinds(settings, chains)
    }

    #[inline]
    fn find<S: Sampler>(
        &self,
        field: &FilmRegion,
        kinds: &PathLengthPdf,
        sampler: &mut S,
        lists: &mut Self::Lists,
        found: &mut Contributions,
    ) {
        let Metropolis {
            settings,
            chains,
            paths,
        } = self.integrator;
        let place = (self.world, settings, chains);
        paths.find(place, field, kinds, sampler, lists, found);
    }
}

impl<P: PathSampler> Integrator for Metropolis<P> {
    const UNBIASED: bool = true;
    const MEDIA: bool = true;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = P::FOLLOWS_LIGHT;

    type State = BootstrapState;

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        true
    }

    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        let mut incompatibilities = capabilities.incompatibilities(P::LIGHT_SEARCH);
        incompatibilities.extend(capabilities.unsplattable());
        let rows = P::FOLLOWS_LIGHT.then(|| capabilities.rows_in_turn());
        incompatibilities.extend(rows.flatten());
        incompatibilities
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Independent
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        before: Option<BootstrapState>,
    ) -> BootstrapState {
        let integrator = self;
        let paths = InWorld { integrator, world };
        BootstrapState::prepare(&paths, &self.chains, placing, pass, before)
    }

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        state: &BootstrapState,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        (self.chains).ordinary(world, &self.settings, site, sampler, sink);
        let integrator = self;
        state.host(&InWorld { integrator, world }, &self.chains, site, sink);
    }

    one_by_one!();
}
