//! What a run consists of: the comparisons that the chosen claims ask for.

use crate::claim::{Budget, Claim, Estimator, Oracle};
use crate::fault::PlantedFault;
use crate::read::named;
use crate::tier::Tier;
use etalon_render::decide::decision::Question;
use etalon_render::judge::Tolerances;
use etalon_render::part::PartOfMany;

/// What to run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Only the claim of this name, or those whose names contain it.
    pub only: Option<String>,
    /// How thoroughly.
    pub tier: Tier,
    /// The seed of everything.
    pub seed: u64,
    /// Only this part of the claims, though decided as part of the whole.
    pub part: Option<PartOfMany>,
}

/// One comparison to be made: an estimator, perhaps with a fault, against its claim's oracle.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The claim.
    pub claim: &'a Claim,
    /// The estimator.
    pub estimator: &'a Estimator,
    /// Its place among the claim's estimators.
    pub place: usize,
    /// The fault, for a comparison that must find it.
    pub fault: Option<PlantedFault>,
    /// Whether another part of the run makes it: it is counted here, and not looked at.
    pub elsewhere: bool,
}

impl Task<'_> {
    /// The estimator and its fault, if it has one.
    pub fn label(&self) -> String {
        match self.fault {
            Some(fault) => format!("mutant: {fault}"),
            None => self.estimator.label(),
        }
    }

    /// The comparison as the decision of the whole run sees it.
    pub fn question(&self, tier: Tier) -> Question {
        Question {
            name: format!("{}: {}", self.claim.name, self.label()),
            is_mutant: self.fault.is_some(),
            elsewhere: self.elsewhere,
            cost: self.samples(tier),
        }
    }

    /// How pictures are judged at the level `alpha`.
    pub fn rules(&self, alpha: f64, tier: Tier) -> Tolerances {
        let bounds = self.claim.bounds;
        let place = self.estimator.in_matrix;
        let exact = self.claim.oracle.is_exact();
        let own = place.map_or(bounds.image, |place| place.bound);
        let default = self.estimator.default.and_then(|budget| budget.bound);
        let own = match (tier, self.fault) {
            (Tier::Default, None) => default.unwrap_or(own),
            _ => own,
        };
        Tolerances {
            // What must be excluded in the end is a difference where it is shown.
            image_bound: tier.image_bound(own),
            tile_bound: bounds.tile,
            alpha,
            rounding: if exact { bounds.rounding } else { 0.0 },
        }
    }

    /// The budget of the first look.
    pub fn budget(&self, tier: Tier) -> Budget {
        match (self.fault, &self.claim.oracle) {
            // With fewer points, the midpoint rule's own error would be found.
            (Some(_), Oracle::Povray { .. }) => self.estimator.least_budget(),
            // Faults of numbers are as costly to find as the numbers are to measure.
            (Some(fault), _) if !fault.is_physical() => self.estimator.least_budget(),
            (Some(_), _) => self.estimator.fault_budget(),
            (None, _) => tier.budget(self.estimator),
        }
    }
}

impl Task<'_> {
    /// Samples of the first look, over all pixels and all pictures that it takes: what progress is
    /// measured in, and what the default run's budget is stated in.
    pub fn samples(&self, tier: Tier) -> f64 {
        let own = f64::from(self.budget(tier).spp);
        let spp = match &self.claim.oracle {
            Oracle::Agreement { estimator } | Oracle::Invariance { estimator } => {
                // A fault is held against the oracle that there is.
                let other = match self.fault {
                    Some(_) => 0,
                    None => tier.budget(estimator).spp,
                };
                own + f64::from(other)
            }
            Oracle::Noise(counting) => own * f64::from(counting.effort(tier, self.fault).seeds),
            _ => own,
        };
        spp * self.claim.pixels()
    }
}

/// The comparisons that a run consists of, those of its other parts included.
pub fn tasks<'a>(claims: &'a [Claim], options: &Options) -> Vec<Task<'a>> {
    let chosen: Vec<&Claim> = match &options.only {
        Some(name) => named(claims, name),
        None => {
            let decided = |claim: &&Claim| match options.tier {
                Tier::Default | Tier::Thorough => !claim.full_only,
                Tier::Full => true,
            };
            claims.iter().filter(decided).collect()
        }
    };
    let mut tasks = Vec::new();
    for (number, claim) in chosen.into_iter().enumerate() {
        let elsewhere = options.part.is_some_and(|part| !part.is_dealt(number));
        // Somebody who asks for a claim that the default run leaves out has asked for its own rows.
        let left_out = claim.estimators.iter().all(|e| e.default.is_none());
        let essential = |estimator: &Estimator| estimator.default.is_some() || left_out;
        for (place, estimator) in claim.estimators.iter().enumerate() {
            let row = estimator.in_matrix;
            let made = match row {
                Some(row) => row.belongs_to(options.tier),
                None => options.tier != Tier::Default || essential(estimator),
            };
            if !made {
                continue;
            }
            let looked_for = options.tier != Tier::Default || estimator.finds_faults_by_default();
            let faults = estimator.mutants.iter().copied().map(Some);
            let faults = faults.filter(|_| looked_for);
            tasks.extend(std::iter::once(None).chain(faults).map(|fault| Task {
                claim,
                estimator,
                place,
                fault,
                elsewhere,
            }));
        }
    }
    tasks
}

/// What a run asks, all of its parts together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunPlan {
    /// Number of declared comparisons, including those of other parts.
    pub hypotheses: usize,
    /// The beginning of a hash over all that they state. Parts belong together only if it is the same:
    /// the levels of each are those of its own plan, and claims are dealt by their places in it.
    pub hash: String,
}

impl RunPlan {
    /// Of these tasks, those made elsewhere included.
    pub fn of(tasks: &[Task<'_>], options: &Options) -> Self {
        let mut hasher = blake3::Hasher::new();
        let mut state = |text: String| {
            hasher.update(&(text.len() as u64).to_le_bytes());
            hasher.update(text.as_bytes());
        };
        state(format!(
            "{:?} {:?} {}",
            options.tier, options.only, options.seed
        ));
        for task in tasks {
            let claim = task.claim;
            state(format!("{} {}", claim.name, claim.scene.display()));
            state(format!("{:?} {:?}", claim.defines, claim.bounds));
            state(format!("{:?}", claim.oracle));
            state(format!("{:?} {:?}", task.estimator, task.fault));
        }
        Self {
            hypotheses: tasks.len(),
            hash: hasher.finalize().to_hex()[..12].to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folders;

    #[test]
    fn parts_of_one_plan_say_so_and_parts_of_others_do_not() {
        let mut claims: Vec<Claim> = ["furnace", "mirror-room"]
            .map(|name| Claim::read(&folders::claims().join(format!("{name}.toml"))))
            .into_iter()
            .collect::<Result<_, _>>()
            .expect("claims");
        let options = |part: Option<&str>| Options {
            only: None,
            tier: Tier::Full,
            seed: 1,
            part: part.map(|part| part.parse().expect("a part")),
        };
        let plan =
            |claims: &[Claim], options: &Options| RunPlan::of(&tasks(claims, options), options);
        let whole = plan(&claims, &options(None));
        assert_eq!(whole.hypotheses, tasks(&claims, &options(None)).len());
        assert_eq!(whole.hash.len(), 12);
        // Mutants rejected: a plan of what the part itself makes; a hash that forgets what is stated.
        for part in ["1/2", "2/2"] {
            assert_eq!(plan(&claims, &options(Some(part))), whole);
        }
        let mut others = vec![whole];
        let seed = Options {
            seed: 2,
            ..options(None)
        };
        let tier = Options {
            tier: Tier::Thorough,
            ..options(None)
        };
        let only = Options {
            only: Some("furnace".to_owned()),
            ..options(None)
        };
        others.extend([&seed, &tier, &only].map(|options| plan(&claims, options)));
        others.push(plan(&claims[..1], &options(None)));
        claims[0].bounds.image *= 0.5;
        others.push(plan(&claims, &options(None)));
        claims[0].estimators[0].thorough.spp *= 2;
        others.push(plan(&claims, &options(None)));
        claims[0].oracle = claims[1].oracle.clone();
        others.push(plan(&claims, &options(None)));
        claims[0].name = "another".to_owned();
        others.push(plan(&claims, &options(None)));
        let mut hashes: Vec<&str> = others.iter().map(|plan| plan.hash.as_str()).collect();
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), others.len(), "{others:?}");
    }
}
