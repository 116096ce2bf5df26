//! `pssmlt`: primary sample space Metropolis light transport over the path tracer.
//!
//! A primary sample u is what one sample of [`crate::path`] draws: film position, aperture,
//! wavelengths, moment, and the numbers of every scattering event. With A the film's area and C(u) that
//! sample's estimate, light sampling and the weights over techniques and wavelengths included, chains of
//! N steps in all give the pixel j of filter hⱼ
//!
//! ```text
//! Ĉⱼ = b̂/N · Σₙ [ (1 − aₙ) w(xₙ) hⱼ(xₙ) F(xₙ)/I(xₙ) + aₙ w(yₙ) hⱼ(yₙ) F(yₙ)/I(yₙ) ]
//!    + 1/N · Σᵤ (1 − w(u))/ρ · hⱼ(u) F(u),        F(u) = A·C(u)
//! ```
//!
//! (Kelemen, Szirmay-Kalos, Antal, Csonka 2002). xₙ is where a chain stands, yₙ the step that it tries
//! and aₙ = min(1, I(yₙ)/I(xₙ)): both ends are credited with their expected share, whichever is taken. u
//! are the uniform samples, ρ of them per step, w weighs chains against them, and b̂ estimates ∫ I du;
//! see [`crate::metropolis`] for each and for why there is no bias. Light that was scattered at most
//! once (`separate_direct`; else what is seen of lights) is no part of F but is added by ordinary
//! samples.

use crate::dimensions as dim;
use crate::metropolis::{
    ChainSettings, Contributions, FilmRegion, Integrand, PathLengthPdf, State,
};
use crate::path_state::PathState;
use crate::settings::PathSettings;
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_transport::{
    Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing, SceneCapabilities, Sink,
    TraceEvent, World,
};

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

    fn kinds(&self) -> usize {
        let PrimarySpace { settings, chains } = self.integrator;
        // All kinds together. A path has more segments than corners.
        usize::from(settings.max_depth > chains.least_corners())
    }

    fn find<S: Sampler>(
        &self,
        field: &FilmRegion,
        _: &PathLengthPdf,
        sampler: &mut S,
        (): &mut (),
        found: &mut Contributions,
    ) {
        let PrimarySpace { settings, chains } = self.integrator;
        sampler.skip_to(dim::FILM);
        let site = field.site(sampler.next_2d());
        let mut walk = PathState::start(self.world, settings, &site, sampler, ());
        let wanted = chains.least_corners()..u32::MAX;
        walk.follow(self.world, settings, &wanted);
        found.add(site.raster, walk.colour() * field.area());
    }

    #[inline]
    fn record(&self, remark: impl FnOnce() -> TraceEvent) -> bool {
        self.world.record(remark)
    }
}

impl Integrator for PrimarySpace {
    const UNBIASED: bool = true;

    type State = State;

    fn splats(&self) -> bool {
        true
    }

    fn incompatibilities(&self, sight: &SceneCapabilities) -> Vec<Incompatibility> {
        let mut objections = sight.incompatibilities(LightSearch::FromCamera);
        objections.extend(sight.unsplattable());
        objections
    }

    fn prepare<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        before: Option<State>,
    ) -> State {
        let integrator = self;
        let paths = Paths { integrator, world };
        State::prepare(&paths, &self.chains, placing, pass, before)
    }

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        state: &State,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        (self.chains).ordinary(world, &self.settings, site, sampler, sink);
        let integrator = self;
        state.host(&Paths { integrator, world }, &self.chains, site, sink);
    }
}
