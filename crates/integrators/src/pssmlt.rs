//! `pssmlt`: primary sample space Metropolis light transport over the path tracer.
//!
//! A primary sample is what one sample of [`crate::path`] draws: film position, aperture,
//! wavelengths, moment, and the numbers of every scattering event (Kelemen et al. 2002). With A
//! the film's area, F(u) = A·C(u) is that sample's estimate, light sampling and the weights over
//! techniques and wavelengths included; see [`crate::metropolis`] for how chains estimate its
//! integral without bias.

use crate::dimensions as dim;
use crate::metropolis::{ChainSettings, Field, Found, Integrand, Lengths, State};
use crate::settings::{PathSettings, ignore_scheduling};
use crate::walk::Walk;
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_transport::{Integrator, Pass, PixelSite, Sink, World};

/// Primary sample space Metropolis light transport.
#[derive(Clone, Debug, Default)]
pub struct PrimarySpace {
    /// Limits of the path.
    pub settings: PathSettings,
    /// How chains are run.
    pub chains: ChainSettings,
}

impl PrimarySpace {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        ignore_scheduling(params);
        Self {
            settings: PathSettings::from_params(params),
            chains: ChainSettings::from_params(params),
        }
    }
}

/// Paths of the path tracer in a world.
struct Paths<'a, W> {
    integrator: &'a PrimarySpace,
    world: &'a W,
}

impl<W: World> Integrand for Paths<'_, W> {
    type Lists = ();

    fn lengths(&self) -> usize {
        let PrimarySpace { settings, chains } = self.integrator;
        // All lengths together. A path has more segments than corners.
        usize::from(settings.max_depth > chains.least_corners())
    }

    fn find<S: Sampler>(
        &self,
        field: &Field,
        _: &Lengths,
        sampler: &mut S,
        (): &mut (),
        found: &mut Found,
    ) {
        let PrimarySpace { settings, chains } = self.integrator;
        sampler.skip_to(dim::FILM);
        let site = field.site(sampler.next_2d());
        let mut walk = Walk::start(self.world, settings, &site, sampler, ());
        let wanted = chains.least_corners()..u32::MAX;
        walk.follow(self.world, settings, &wanted);
        found.add(site.raster, walk.colour() * field.area());
    }
}

impl Integrator for PrimarySpace {
    const UNBIASED: bool = true;

    type State = State;

    fn splats(&self) -> bool {
        true
    }

    fn prepare<W: World>(&self, world: &W, pass: &Pass, before: Option<State>) -> State {
        let integrator = self;
        State::prepare(&Paths { integrator, world }, &self.chains, pass, before)
    }

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        state: &State,
        site: &PixelSite,
        sampler: &mut S,
        sink: &mut K,
    ) {
        (self.chains).ordinary(world, &self.settings, site, sampler, sink);
        let integrator = self;
        state.host(&Paths { integrator, world }, &self.chains, site, sink);
    }
}
