//! The replicates that each look adds to those there are.

use crate::accumulate;
use crate::claim::{Budget, Estimator, Oracle};
use crate::rendering;
use crate::run::Task;
use crate::state::State;
use etalon_film::Developed;

/// The replicates that a look adds.
pub(crate) struct Batches<'a> {
    /// What is compared.
    pub(crate) task: Task<'a>,
    /// The first look's budget.
    pub(crate) first: Budget,
    /// Replicates there are, in multiples of the first look's.
    pub(crate) from: u32,
    /// Replicates there shall be.
    pub(crate) to: u32,
    /// Where finished batches are kept, if anywhere.
    pub(crate) state: Option<&'a State>,
}

impl Batches<'_> {
    /// The replicates so far and those to be added. A finished batch is taken from the state, if
    /// there is one.
    pub(crate) fn extend(
        &self,
        so_far: Option<Developed>,
        estimator: &Estimator,
        seed: u64,
        who: &str,
    ) -> Result<Developed, String> {
        let more = self.to - self.from;
        let budget = Budget {
            spp: self.first.spp * more,
            replicates: self.first.replicates * more,
        };
        // Batches are independent: each has its own seed.
        let seed = seed.wrapping_add(u64::from(self.from) << 40);
        let loaded = rendering::load_for(self.task.claim, estimator)?;
        let plan = rendering::plan(&loaded, estimator, budget, seed);
        let mut name = format!(
            "{}-{}-{who}-{}",
            self.task.claim.name, self.task.place, self.from
        );
        if let Some(fault) = self.task.fault {
            name += &format!("-{fault}").replace([' ', '/'], "_");
        }
        let kept = self
            .state
            .and_then(|state| state.read(&name, &plan, &loaded));
        let batch = match kept {
            Some(batch) => rendering::finite(batch)?,
            None => {
                let change = match &self.task.claim.oracle {
                    Oracle::Invariance { .. } if who == "own" => estimator.change,
                    _ => None,
                };
                let batch = rendering::picture(&loaded, &plan, estimator, self.task.fault, change)?;
                if let Some(state) = self.state {
                    state.write(&name, &batch)?;
                }
                batch
            }
        };
        match so_far {
            Some(so_far) => accumulate::merge(&so_far, &batch),
            None => Ok(batch),
        }
    }
}
