//! What a run consists of: the comparisons that the chosen claims ask for.

use crate::claim::{Budget, Claim, Estimator, Oracle};
use crate::fault::Fault;
use crate::tier::Tier;
use etalon::judge::Rules;
use etalon::part::PartOfMany;
use etalon_params::suggest::nearest;

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
    pub fault: Option<Fault>,
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

    /// How pictures are judged at the level `alpha`.
    pub fn rules(&self, alpha: f64, tier: Tier) -> Rules {
        let bounds = self.claim.bounds;
        let place = self.estimator.in_matrix;
        let exact = self.claim.oracle.is_exact();
        let own = place.map_or(bounds.image, |place| place.bound);
        Rules {
            // What must be excluded in the end is a difference where it is shown.
            image_bound: tier.stated_bound().map_or(own, |stated| own.min(stated)),
            tile_bound: bounds.tile,
            alpha,
            rounding: if exact { bounds.rounding } else { 0.0 },
        }
    }

    /// The budget of the first look.
    pub fn budget(&self, tier: Tier) -> Budget {
        match (self.fault, &self.claim.oracle) {
            // With fewer points, the midpoint rule's own error would be found.
            (Some(_), Oracle::Povray { .. }) => self.estimator.quick,
            // Faults of numbers are as costly to find as the numbers are to measure.
            (Some(fault), _) if !fault.is_physical() => self.estimator.quick,
            (Some(_), _) => self.estimator.fault_budget(),
            (None, _) => tier.budget(self.estimator),
        }
    }
}

/// The claim of this name, or, if there is none, those whose names contain it.
pub fn named<'a>(claims: &'a [Claim], name: &str) -> Vec<&'a Claim> {
    match claims.iter().find(|claim| claim.name == name) {
        Some(claim) => vec![claim],
        None => (claims.iter())
            .filter(|claim| claim.name.contains(name))
            .collect(),
    }
}

/// What to tell somebody who asked for claims of this name, as there are none.
pub fn unknown(claims: &[Claim], name: &str) -> String {
    let names = claims.iter().map(|claim| claim.name.as_str());
    let help = match nearest(name, names) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "see `cargo xtask validate --list`".to_owned(),
    };
    format!("no claim has such a name as `{name}`: {help}")
}

/// The comparisons that a run consists of, those of its other parts included.
pub fn tasks<'a>(claims: &'a [Claim], options: &Options) -> Vec<Task<'a>> {
    let chosen: Vec<&Claim> = match &options.only {
        Some(name) => named(claims, name),
        None => {
            let decided = |claim: &&Claim| match options.tier {
                Tier::Quick => claim.quick && !claim.full_only,
                Tier::Default => !claim.full_only,
                Tier::Full => true,
            };
            claims.iter().filter(decided).collect()
        }
    };
    let mut tasks = Vec::new();
    for (number, claim) in chosen.into_iter().enumerate() {
        let elsewhere = options.part.is_some_and(|part| !part.is_dealt(number));
        for (place, estimator) in claim.estimators.iter().enumerate() {
            let row = estimator.in_matrix;
            if row.is_some_and(|row| !row.belongs_to(options.tier)) {
                continue;
            }
            let faults = estimator.mutants.iter().copied().map(Some);
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
