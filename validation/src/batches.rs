//! The replicates that each look adds to those there are.

use crate::accumulate;
use crate::batch_cache::{BatchCache, Wanted};
use crate::claim::{Budget, Estimator, Oracle};
use crate::fault::PlantedFault;
use crate::rendering;
use crate::tasks::Task;
use etalon_film::RenderedImage;
use etalon_integrators::RenderPlan;
use etalon_render::decide::looks::Multiple;
use std::hash::{DefaultHasher, Hasher};

/// The replicates that a look adds.
pub(crate) struct Batches<'a> {
    /// What is compared.
    pub(crate) task: Task<'a>,
    /// The first look's budget.
    pub(crate) first: Budget,
    /// Replicates there are, in multiples of the first look's.
    pub(crate) from: Multiple,
    /// Replicates there shall be.
    pub(crate) to: Multiple,
    /// Where finished batches are kept.
    pub(crate) kept: &'a BatchCache<'a>,
}

/// Which side of a comparison a batch belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// The estimator under test.
    Own,
    /// The estimator that it is held against.
    Oracle,
}

/// What tells one statement of an estimator from another. A claim may be edited between two runs of one
/// program, and not everything in it leaves a trace in the picture's metadata.
pub(crate) fn fingerprint(estimator: &Estimator) -> u32 {
    let mut hasher = DefaultHasher::new();
    hasher.write(format!("{estimator:?}").as_bytes());
    hasher.finish() as u32
}

impl Batches<'_> {
    /// The replicates so far and those to be added. A finished batch that is kept is not
    /// rendered again.
    pub(crate) fn extend(
        &self,
        so_far: Option<RenderedImage>,
        estimator: &Estimator,
        seed: u64,
        part: Side,
    ) -> Result<RenderedImage, String> {
        let more = |count: u32| self.to.of(count) - self.from.of(count);
        let budget = Budget {
            spp: more(self.first.spp),
            replicates: more(self.first.replicates),
            ..self.first
        };
        // Batches are independent: each has its own seed.
        let seed = seed.wrapping_add(u64::from(self.from.in_halves()) << 40);
        let loaded = rendering::load_for(self.task.claim, estimator)?;
        let plan = rendering::plan(&loaded, estimator, budget, seed);
        let name = self.name(estimator, &plan, part);
        let wanted = Wanted {
            claim: &self.task.claim.name,
            name: &name,
            shared: part == Side::Oracle,
            plan: &plan,
            loaded: &loaded,
        };
        let batch = self.kept.or_else(&wanted, || {
            let change = match (part, &self.task.claim.oracle) {
                (Side::Own, Oracle::Invariance { .. }) => estimator.change,
                _ => None,
            };
            rendering::picture(&loaded, &plan, estimator, self.fault(part), change)
        })?;
        let batch = rendering::finite(batch)?;
        match so_far {
            Some(so_far) => accumulate::merge(&so_far, &batch),
            None => Ok(batch),
        }
    }

    /// The fault of a side: the oracle has none.
    fn fault(&self, part: Side) -> Option<PlantedFault> {
        self.task.fault.filter(|_| part == Side::Own)
    }

    /// What tells a batch from all others of the claim. The oracle's belong to no estimator.
    fn name(&self, estimator: &Estimator, plan: &RenderPlan, part: Side) -> String {
        let (from, print) = (self.from.in_halves(), fingerprint(estimator));
        match part {
            Side::Own => {
                let fault = self.task.fault.map(|fault| format!("-{fault}"));
                let fault = fault.unwrap_or_default().replace([' ', '/'], "_");
                format!("{}-own-{from}-{print:08x}{fault}", self.task.place)
            }
            Side::Oracle => {
                let (replicates, each) = (plan.replicates, plan.samples_per_replicate);
                format!("oracle-{from}-{print:08x}-{replicates}x{each}")
            }
        }
    }
}
