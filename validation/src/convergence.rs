//! Renders what claims of convergence are decided by: batches of pictures up a ladder of samples.

use crate::claim::{Budget, Claim, Estimator, Ladder, Sampler};
use crate::closed_form;
use crate::fault::PlantedFault;
use crate::rendering;
use etalon_render::decide::convergence::{self, Batches, Fall};
use etalon_render::decide::measure::Measure;
use etalon_render::pipeline::Loaded;

/// Replicates of a batch: two, the fewest that have standard errors.
const BATCH: u32 = 2;

impl Ladder {
    /// An estimator on a rung, and the samples of a replicate there.
    fn stand(&self, rung: u32, estimator: &Estimator, budget: Budget) -> (Estimator, u32) {
        let mut standing = estimator.clone();
        let Some(parameter) = &self.over else {
            return (standing, rung);
        };
        let value = toml::Value::Integer(rung.into());
        standing.defines.insert(parameter.clone(), value);
        let replicates = budget.replicates * self.rungs.len() as u32;
        (standing, (budget.spp / replicates).max(1))
    }
}

/// The batches of an estimator; more of them may be rendered.
#[derive(Clone, Debug, Default)]
pub struct Climbed {
    /// What they came to.
    pub batches: Batches,
    /// The samples spent.
    pub spp: u64,
}

impl Climbed {
    /// Renders until there are as many batches as the budget has replicates for.
    ///
    /// # Errors
    /// If a picture cannot be rendered or has no error at all.
    pub fn extend(
        &mut self,
        claim: &Claim,
        ladder: &Ladder,
        (estimator, fault): (&Estimator, Option<PlantedFault>),
        budget: Budget,
        seed: u64,
    ) -> Result<(), String> {
        let estimator = match fault {
            Some(PlantedFault::IndependentSamples) => &Estimator {
                sampler: Some(Sampler::Independent),
                ..estimator.clone()
            },
            Some(other) => return Err(format!("`{other}` cannot be planted here")),
            None => estimator,
        };
        let rungs = &ladder.rungs;
        let stands = rungs
            .iter()
            .map(|rung| ladder.stand(*rung, estimator, budget));
        let stands: Vec<(Estimator, u32)> = stands.collect();
        // Where only the samples grow, all rungs have one scene.
        let different = if ladder.over.is_some() {
            rungs.len()
        } else {
            1
        };
        let scenes = stands[..different]
            .iter()
            .map(|(standing, _)| rendering::load_for(claim, standing));
        let scenes = scenes.collect::<Result<Vec<Loaded>, String>>()?;
        let size = scenes[0].compiled.film.crop_size.to_array();
        let known = closed_form::picture(&ladder.formula, claim, estimator, size)?;
        let batches = (budget.replicates / BATCH).max(2);
        for batch in self.batches.exponents.len() as u32..batches {
            let (mut x, mut y) = (Vec::new(), Vec::new());
            for (rung, (_, samples)) in stands.iter().enumerate() {
                let loaded = &scenes[rung.min(different - 1)];
                let budget = Budget {
                    spp: samples * BATCH,
                    replicates: BATCH,
                    bound: None,
                };
                // All are independent of each other.
                let number = u64::from(batch) * rungs.len() as u64 + rung as u64;
                let seed = seed.wrapping_add((number + 1) << 32);
                let plan = rendering::plan(loaded, estimator, budget, seed);
                let picture = rendering::picture(loaded, &plan, estimator, None, None)?;
                x.push(match &ladder.over {
                    Some(_) => f64::from(rungs[rung]),
                    None => f64::from(plan.samples_per_replicate),
                });
                y.push(convergence::squared_error(
                    &picture,
                    &known,
                    estimator.part,
                )?);
                self.spp += u64::from(plan.samples_per_replicate * BATCH);
            }
            self.batches.add(&x, &y)?;
        }
        Ok(())
    }

    /// How the error fell, over all of them.
    pub fn fall(&self, ladder: &Ladder) -> Fall {
        let over = ladder.over.as_deref().unwrap_or("samples per replicate");
        self.batches.fall(over, &ladder.rungs)
    }
}

/// The exponent of all batches together, judged at `alpha`.
///
/// # Errors
/// If there are fewer than two batches, or nothing is accepted of this estimator.
pub fn judge(exponents: &[f64], estimator: &Estimator, alpha: f64) -> Result<Measure, String> {
    let accepted = estimator.exponent.ok_or("there is no `exponent`")?;
    convergence::judge_convergence(exponents, estimator.part, accepted, alpha)
}
