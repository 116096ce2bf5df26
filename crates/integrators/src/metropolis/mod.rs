//! Metropolis light transport in primary sample space, for any mapping from primary samples to paths.
//!
//! A primary sample u ∈ [0, 1)^∞ is turned into a path whose estimate F(u) lands somewhere on the
//! film, so that a pixel with filter h is C = ∫ h·F du. A Markov chain visits samples in
//! proportion to a scalar I(u), here the mean of |red|, |green| and |blue| of F times a factor
//! that depends on the place (see `emphasis.rs`): it is zero only where F is, all wavelengths count
//! in it, and no quotient F/I is large. A step from x
//! to y is accepted with probability a = min(1, I(y)/I(x)) (Metropolis et al. 1953; Veach &
//! Guibas 1997; Kelemen et al. 2002, see `primary.rs` for the steps). Both ends are credited with
//! their expected share,
//!
//! ```text
//! Ĉ = 1/N · Σ_steps   [ (1 − a)·w(x)·b̂/I(x) · F(x) + a·w(y)·b̂/I(y) · F(y) ]
//!   + 1/N · Σ_uniform (1 − w(u))/ρ · F(u)
//! w(u) = I(u) / (I(u) + c·ρ)
//! ```
//!
//! Uniform samples are the large steps and those with which the replicate begins, ρ of them per
//! step; w is the balance heuristic between them and the chains (Kelemen et al. 2002, section 4),
//! for an assumed ∫ I du = c.
//!
//! **Unbiased.** A replicate begins with M uniform samples uᵢ. Their mean brightness is b̂ = Σ
//! I(uᵢ)/M, and chains start at samples picked from them with probabilities I(uᵢ) / Σ I. For any
//! function g of the start, such as the expected result of a chain,
//!
//! ```text
//! E[ b̂·g(start) ] = E[ 1/M · Σᵢ I(uᵢ)·g(uᵢ) ] = ∫ I(u)·g(u) du
//! ```
//!
//! so that a chain weighted by b̂ is distributed like I du after any number of steps (Veach 1997,
//! section 11.3.1): there is no start-up bias for chains of any length. Uniform samples are ordinary
//! Monte Carlo integration. It remains that w must not depend on the replicate's own samples: c, like
//! everything that F has learned, comes from a pilot that is a function of the image's seed. For any c
//! the expectation is C, so replicates are independent given c, and the standard error over them is
//! valid. A poor c only costs efficiency; with c = 0, if the pilot finds nothing, only the chains
//! contribute.
//!
//! F is the estimate of `path_throughput.rs`, and the wavelengths are drawn by one of the numbers of u, so
//! that a path keeps its four wavelengths, and dispersion needs no special case.
//!
//! There are as many steps as samples in the replicate, in chains of equal length, which are hosted by
//! samples spread evenly over the film and the replicate. Light with few scattering events
//! (`separate_direct`) is found by ordinary samples of the path tracer, which also give alpha.

mod bootstrap;
mod chain;
mod contributions;
mod film_region;
mod importance_map;
mod integrator;
pub mod mmlt;
pub(crate) mod primary;
pub mod pssmlt;
#[cfg(test)]
mod tests;

pub use bootstrap::BootstrapState;
pub(crate) use bootstrap::PathLengthPdf;
pub(crate) use contributions::Contributions;
pub(crate) use film_region::FilmRegion;
pub use integrator::Metropolis;
pub(crate) use integrator::PathSampler;

use crate::path::follow_part;
use crate::path::state::PathState;
use crate::steps::settings::{PathConfig, PathSettings};
use core::ops::Range;
use etalon_params::Params;
use etalon_sampling::Sampler;
use etalon_transport::{PixelSample, Sink, World};
use primary::LogarithmicStep;

/// The mapping from a primary sample to a path and its contributions.
pub(crate) trait Integrand: Sync {
    /// Memory that one evaluation lends to the next.
    type Lists: Default;

    /// Number of kinds of paths, for [`PathLengthPdf`]; 0 if there is nothing to find.
    fn kinds(&self) -> usize;

    /// Turns a primary sample into contributions to the film.
    fn find<S: Sampler>(
        &self,
        field: &FilmRegion,
        kinds: &PathLengthPdf,
        sampler: &mut S,
        lists: &mut Self::Lists,
        found: &mut Contributions,
    );
}

/// The settings of chains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainSettings {
    /// The probability of a large step.
    pub large_step: f32,
    /// s₁: the smallest distance of a small step in one number.
    pub smallest_step: f32,
    /// s₂: the largest.
    pub largest_step: f32,
    /// Steps per chain.
    pub length: u32,
    /// Uniform samples with which a replicate begins; if not given, as many as the replicate has
    /// samples, within [`ChainSettings::SEEDS`].
    pub seeds: Option<u32>,
    /// Whether direct light is left to ordinary samples.
    pub separate_direct: bool,
    /// Whether all parts of the picture are to be visited alike, the dark ones too.
    pub relative: bool,
}

impl Default for ChainSettings {
    /// Steps as in Kelemen et al. 2002 except for the smallest (theirs is 1/1024): the longer a path,
    /// the smaller a step must be to be accepted.
    ///
    /// Chains are short and start at many different samples (as in Cline et al. 2005, "Energy
    /// redistribution path tracing"). They need no burn-in, as they start in the stationary
    /// distribution, while a few long chains would each affect the brightness of the whole picture.
    fn default() -> Self {
        Self {
            large_step: 0.3,
            smallest_step: 1.0 / 8192.0,
            largest_step: 1.0 / 64.0,
            length: 128,
            seeds: None,
            separate_direct: true,
            relative: true,
        }
    }
}

impl ChainSettings {
    /// Bounds of the number of seeds that is chosen by itself.
    pub const SEEDS: Range<u32> = 1 << 10..1 << 21;

    /// Reads the parameters, see `docs/extensions.md`.
    pub fn from_params(params: &Params<'_>) -> Self {
        let default = Self::default();
        let number = |name: &str, default: f32, what: &str, most: f64| {
            let accept = |x: f64| x > 0.0 && x <= most;
            params.float_where(name, f64::from(default), what, accept) as f32
        };
        let count = |name: &str, most: u32| {
            let value = params.integer(name)?;
            let count = u32::try_from(value).ok().filter(|n| *n > 0 && *n <= most);
            if count.is_none() {
                params.refuse(name, value, &format!("1, 2, … {most}"));
            }
            count
        };
        let half = "more than 0, at most 0.5";
        let settings = Self {
            large_step: number(
                "large_step",
                default.large_step,
                "more than 0, at most 1",
                1.0,
            ),
            smallest_step: number("smallest_step", default.smallest_step, half, 0.5),
            largest_step: number("largest_step", default.largest_step, half, 0.5),
            length: count("chain_length", 1 << 24).unwrap_or(default.length),
            seeds: count("bootstrap_samples", 1 << 24),
            separate_direct: params.boolean_or("separate_direct", default.separate_direct),
            relative: params.boolean_or("relative", default.relative),
        };
        if settings.smallest_step > settings.largest_step {
            params.error("`smallest_step` is more than `largest_step`");
        }
        settings
    }

    fn step(&self) -> LogarithmicStep {
        LogarithmicStep::new(self.smallest_step, self.largest_step).reaching_far()
    }

    /// The least number of scattering vertices of a path that chains look for.
    pub(crate) fn least_scattering_vertices(&self) -> u32 {
        if self.separate_direct { 2 } else { 1 }
    }

    /// The ordinary sample of a pixel: what chains do not look for, and alpha.
    pub(crate) fn ordinary<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        settings: &PathSettings,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let config = PathConfig::plain(*settings);
        let (mut path, ray) = PathState::start(world, site, sampler, ());
        follow_part(
            world,
            &config,
            (&mut path, ray),
            &(0..self.least_scattering_vertices()),
        );
        path.deliver(world, sink);
    }
}
