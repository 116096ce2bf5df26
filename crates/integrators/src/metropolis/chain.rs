//! A Markov chain, and which pixel hosts it.

use super::bootstrap::{BootstrapState, Stream, start_key};
use super::contributions::{Contribution, Contributions};
use super::primary::{LogarithmicStep, PrimarySample};
use super::{ChainSettings, Integrand};
use core::ops::Range;
use etalon_sampling::hash::derived_key;
use etalon_transport::{PixelSample, Sink};

impl BootstrapState {
    /// Runs the chains that a sample hosts, and delivers its share of the bootstrap samples. Both are
    /// spread evenly over the samples of all pixels, so that no sample takes long, and an interrupted
    /// replicate has as large a share of chains as of samples.
    pub(crate) fn host<T: Integrand, K: Sink>(
        &self,
        integrand: &T,
        settings: &ChainSettings,
        site: &PixelSample,
        sink: &mut K,
    ) {
        let share = |count: usize| self.share(site, count);
        let (contributions, chains) = (share(self.contributions.len()), share(self.starts.len()));
        for contribution in &self.contributions[contributions] {
            deliver(*contribution, sink);
        }
        for chain in chains {
            self.run(integrand, settings, chain, sink);
        }
    }

    /// The range of `count` items that a sample hosts, evenly distributed.
    fn share(&self, site: &PixelSample, count: usize) -> Range<usize> {
        // Pixels around the film host none.
        let place = site.pixel.wrapping_sub(self.field.origin());
        let size = self.field.pixels();
        if !place.cmplt(size).all() {
            return 0..0;
        }
        let index = u64::from(place.y) * u64::from(size.x) + u64::from(place.x);
        let samples = u128::from(self.samples);
        let of = samples * u128::from(size.x) * u128::from(size.y);
        let begin = |slot: u128| (slot * count as u128).div_ceil(of) as usize;
        let slot = u128::from(index) * samples + u128::from(site.sample);
        begin(slot)..begin(slot + 1)
    }

    /// The uniform sample with this index, about to take the steps that `course` selects.
    fn uniform_sample(
        &self,
        settings: &ChainSettings,
        index: u32,
        course: u64,
    ) -> PrimarySample<LogarithmicStep> {
        let start = start_key(Stream::Seeds.key(self.seed, self.replicate), index);
        PrimarySample::new(settings.step(), settings.large_step, start, course)
    }

    /// Runs a chain from its start to its end.
    fn run<T: Integrand, K: Sink>(
        &self,
        integrand: &T,
        settings: &ChainSettings,
        chain: usize,
        sink: &mut K,
    ) {
        let course = Stream::Chains.key(self.seed, self.replicate);
        let course = derived_key(course, chain as u32);
        let start = self.starts[chain];
        let mut sample = self.uniform_sample(settings, start, course);
        let mut lists = T::Lists::default();
        let (mut current, mut proposed) = (Contributions::default(), Contributions::default());
        let mut find = |sample: &mut PrimarySample<_>, found: &mut Contributions| {
            found.clear();
            let kinds = &self.pilot.kinds;
            integrand.find(&self.field, kinds, sample, &mut lists, found);
            found.measure(&self.field, &self.pilot.emphasis);
            found.brightness()
        };
        let mut here = find(&mut sample, &mut current);
        // The weight of the current sample.
        let mut weight = 0.0;
        for _ in 0..self.length {
            let large = sample.propose();
            let there = find(&mut sample, &mut proposed);
            let accepted = if there > 0.0 {
                (there / here).min(1.0)
            } else {
                0.0
            };
            weight += (1.0 - accepted) * self.chain_weight(here);
            let mut other = if there > 0.0 {
                accepted * self.chain_weight(there)
            } else {
                0.0
            };
            if large {
                other += self.uniform_weight(there);
            }
            let goes = f64::from(sample.decide()) < accepted;
            if goes {
                sample.accept();
                core::mem::swap(&mut current, &mut proposed);
                core::mem::swap(&mut weight, &mut other);
                here = there;
            } else {
                sample.reject();
            }
            // After the exchange, `proposed` is what the chain does not stay at.
            proposed.weighted(other).for_each(|one| deliver(one, sink));
        }
        current.weighted(weight).for_each(|one| deliver(one, sink));
    }
}

fn deliver<K: Sink>(contribution: Contribution, sink: &mut K) {
    sink.splat(contribution.raster, contribution.rgb.to_array());
}
