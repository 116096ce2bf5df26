//! Numbers of samples that samplers can stratify, near those that are wanted.

use crate::pipeline;
use etalon_integrators::RenderPlan;
use etalon_sampling::SamplerKind;

/// The most samples per pixel that a target may ask for.
pub(crate) const MOST: f64 = (1_u64 << 28) as f64;

/// A plan of `needed` samples per pixel: no fewer if `up`, no more otherwise, as nearly as
/// replicates of equal, stratifiable size allow.
pub(crate) fn sized(
    plan: &RenderPlan,
    needed: f64,
    replicates: Option<u32>,
    up: bool,
) -> RenderPlan {
    let count = replicates.unwrap_or(pipeline::REPLICATES);
    let needed = needed.clamp(1.0, MOST);
    let each = needed / f64::from(count);
    let least = round_down(plan.sampler, each as u32);
    let (samples, replicates) = match replicates {
        // More replicates take up what rounding leaves.
        None if each >= 1.0 => {
            let fit = needed / f64::from(least);
            (least, if up { fit.ceil() } else { fit.floor() } as u32)
        }
        None => (1, if up { count } else { (needed as u32).max(2) }),
        Some(count) if up => (plan.sampler.round_up(each.ceil() as u32), count),
        Some(count) => (least, count),
    };
    RenderPlan {
        replicates,
        samples_per_replicate: samples,
        ..*plan
    }
}

/// The greatest size of at most `samples`, and at least one, that the sampler stratifies fully.
fn round_down(sampler: SamplerKind, samples: u32) -> u32 {
    let samples = samples.max(1);
    match sampler {
        SamplerKind::Independent => samples,
        SamplerKind::Stratified { .. } => samples.isqrt().pow(2),
        SamplerKind::Sobol => 1 << samples.ilog2(),
    }
}

/// Of the sizes that the sampler stratifies, the one that is nearest in proportion; `dither` moves
/// the middle between two sizes, so that blocks of equal weight do not all change theirs at the
/// same scale.
pub(crate) fn nearest(sampler: SamplerKind, wanted: f64, dither: f64) -> u32 {
    let least = round_down(sampler, wanted as u32);
    let next = sampler.round_up(least.saturating_add(1));
    let [low, high] = [least, next].map(f64::from);
    if wanted > (low * high).sqrt() + dither * (high - low) {
        next
    } else {
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_sampling::ReplicateKind;

    fn plan(sampler: SamplerKind) -> RenderPlan {
        RenderPlan {
            seed: 1,
            replicates: 8,
            replicate_kind: ReplicateKind::Independent,
            share: None,
            samples_per_replicate: 4,
            sampler,
        }
    }

    #[test]
    fn plans_have_the_samples_that_are_needed() {
        let kinds = [
            SamplerKind::Independent,
            SamplerKind::Sobol,
            SamplerKind::Stratified { jitter: true },
        ];
        for kind in kinds {
            for needed in [0.3, 1.0, 5.5, 8.0, 31.9, 100.0, 12_345.6] {
                for replicates in [None, Some(2), Some(8), Some(20)] {
                    let size = |up| {
                        let plan = sized(&plan(kind), needed, replicates, up);
                        let each = plan.samples_per_replicate;
                        assert_eq!(kind.round_up(each), each);
                        assert!(replicates.is_none_or(|r| r == plan.replicates));
                        assert!(plan.replicates >= 2);
                        f64::from(each) * f64::from(plan.replicates)
                    };
                    assert!(size(true) >= needed, "{kind:?} {needed} {replicates:?}");
                    let fewest = f64::from(replicates.unwrap_or(2));
                    assert!(size(false) <= needed.max(fewest), "{kind:?} {needed}");
                    // Not much more, where the number of replicates is free.
                    if replicates.is_none() {
                        assert!(size(true) < 8.5 + 1.3 * needed, "{kind:?} {needed}");
                    }
                }
            }
        }
    }
}
