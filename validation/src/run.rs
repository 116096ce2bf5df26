//! Rendering and judging one claim's comparisons.
//!
//! A [`Comparison`] is looked at once or several times; each look adds replicates with seeds of
//! their own to those there are, and judges them all.

use crate::accumulate;
use crate::claim::{Budget, Claim, Estimator, Oracle};
use crate::fault::Fault;
use crate::judged::{self, Against};
use crate::measure::Measure;
use crate::state::State;
use crate::tier::{FULL_BOUND, Tier};
use crate::{closed_form, convergence, invariance, noise, reference, rendering};
use etalon::judge::{Judgement, Known, Rules};
use etalon_film::Developed;
use etalon_images::{Frame, Image};
use etalon_statistics::Verdict;
use std::time::Instant;

pub use crate::rendering::{defines, load};

/// What to run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Only the claims whose names contain this.
    pub only: Option<String>,
    /// How thoroughly.
    pub tier: Tier,
    /// The seed of everything.
    pub seed: u64,
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
}

impl Task<'_> {
    /// The estimator and its fault, if it has one.
    pub fn label(&self) -> String {
        match self.fault {
            Some(fault) => format!("mutant: {fault}"),
            None => self.estimator.label(),
        }
    }

    /// The budget of the first look.
    pub fn budget(&self, tier: Tier) -> Budget {
        match (self.fault, &self.claim.oracle) {
            // Faults of numbers are as costly to find as the numbers are to measure.
            (Some(fault), _) if !fault.is_physical() => self.estimator.quick,
            (Some(_), _) => self.estimator.fault_budget(),
            (None, _) => tier.budget(self.estimator),
        }
    }
}

/// The comparisons that a run consists of.
pub fn tasks<'a>(claims: &'a [Claim], options: &Options) -> Vec<Task<'a>> {
    let wanted = |claim: &&Claim| match &options.only {
        Some(part) => claim.name.contains(part.as_str()),
        None => claim.quick || options.tier != Tier::Quick,
    };
    let mut tasks = Vec::new();
    for claim in claims.iter().filter(wanted) {
        for (place, estimator) in claim.estimators.iter().enumerate() {
            let faults = estimator.mutants.iter().copied().map(Some);
            tasks.extend(std::iter::once(None).chain(faults).map(|fault| Task {
                claim,
                estimator,
                place,
                fault,
            }));
        }
    }
    tasks
}

/// What a comparison was decided by.
pub enum Evidence {
    /// Pictures and their means.
    Pictures {
        /// Our picture.
        picture: Box<Developed>,
        /// What it ought to be.
        oracle: Box<Developed>,
        /// The decision, before it is corrected over the whole run.
        judgement: Judgement,
        /// Where the normal approximation was refused.
        refusals: Vec<String>,
    },
    /// Numbers with intervals.
    Measures(Vec<Measure>),
}

/// A comparison that was made.
pub struct Compared {
    /// What it is decided by.
    pub evidence: Evidence,
    /// The decision at this look's level.
    pub verdict: Verdict,
    /// The p-value of "no fault" at this look.
    pub p: f64,
    /// Samples per pixel, all replicates together.
    pub spp: u64,
    /// Independent replicates.
    pub replicates: u32,
    /// The hash of the scene's content.
    pub scene_hash: String,
}

impl Compared {
    /// The judgement on pictures, if there is one.
    pub fn judgement(&self) -> Option<&Judgement> {
        match &self.evidence {
            Evidence::Pictures { judgement, .. } => Some(judgement),
            Evidence::Measures(_) => None,
        }
    }

    /// The measures, if there are any.
    pub fn measures(&self) -> &[Measure] {
        match &self.evidence {
            Evidence::Pictures { .. } => &[],
            Evidence::Measures(measures) => measures,
        }
    }

    /// The greatest relative bias of an image's mean that is not excluded, if it was asked for.
    pub fn bias_bound(&self) -> Option<f64> {
        let widest = self.judgement()?.widest()?;
        Some(widest.interval[0].abs().max(widest.interval[1].abs()))
    }
}

/// A comparison and the replicates there are so far.
pub struct Comparison<'a> {
    /// What is compared.
    pub task: Task<'a>,
    /// Seconds spent on it.
    pub seconds: f64,
    picture: Option<Developed>,
    oracle: Option<Developed>,
    /// Replicates so far, in multiples of the first look's.
    multiple: u32,
}

/// The seed of what an agreement's estimator is held against: the two must be independent.
const ORACLE_SEED: u64 = 0x6f72_6163_6c65;

impl<'a> Comparison<'a> {
    /// Nothing compared yet.
    pub fn new(task: Task<'a>) -> Self {
        Self {
            task,
            seconds: 0.0,
            picture: None,
            oracle: None,
            multiple: 0,
        }
    }

    /// Renders until there are `multiple` times the first look's replicates, and judges them at
    /// the level `alpha`.
    ///
    /// # Errors
    /// If it cannot be made: a scene or a reference that cannot be read, numbers that are not
    /// finite.
    pub fn look(
        &mut self,
        multiple: u32,
        alpha: f64,
        options: &Options,
        state: Option<&State>,
    ) -> Result<Compared, String> {
        let start = Instant::now();
        let compared = self.measured(multiple, alpha, options, state);
        self.seconds += start.elapsed().as_secs_f64();
        self.multiple = multiple;
        compared
    }

    fn measured(
        &mut self,
        multiple: u32,
        alpha: f64,
        options: &Options,
        state: Option<&State>,
    ) -> Result<Compared, String> {
        let Task {
            claim,
            estimator,
            fault,
            ..
        } = self.task;
        let first = self.task.budget(options.tier);
        let budget = Budget {
            spp: first.spp * multiple,
            replicates: first.replicates * multiple,
        };
        let seeded = (options.seed, alpha);
        let (measures, spp) = match &claim.oracle {
            Oracle::Convergence { formula, samples } => {
                let rungs = (formula.as_str(), samples.as_slice());
                let replicates = budget.replicates;
                convergence::measure(claim, rungs, estimator, fault, replicates, seeded)?
            }
            Oracle::Noise {
                of,
                formula,
                seeds,
                tolerance,
            } => {
                let counted = noise::Counted {
                    of: *of,
                    formula,
                    seeds: seeds * multiple,
                    tolerance: *tolerance,
                };
                noise::measure(claim, &counted, estimator, fault, first, seeded)?
            }
            Oracle::Invariance { .. } => {
                let loaded = rendering::load_for(claim, estimator)?;
                let plan = rendering::plan(&loaded, estimator, first, options.seed);
                match invariance::measure(claim, estimator, &loaded, &plan, fault)? {
                    Some((measures, picture)) => {
                        let spp = picture.metadata.as_ref().map_or(0, |m| m.spp);
                        (measures, spp)
                    }
                    None => return self.pictures(multiple, alpha, options, state),
                }
            }
            _ => return self.pictures(multiple, alpha, options, state),
        };
        let (verdict, p) = Measure::together(&measures);
        Ok(Compared {
            evidence: Evidence::Measures(measures),
            verdict,
            p,
            spp,
            replicates: budget.replicates,
            scene_hash: rendering::load_for(claim, estimator)?.hash,
        })
    }

    fn pictures(
        &mut self,
        multiple: u32,
        alpha: f64,
        options: &Options,
        state: Option<&State>,
    ) -> Result<Compared, String> {
        let Task {
            claim,
            estimator,
            fault,
            ..
        } = self.task;
        if fault.is_some_and(|fault| !fault.is_physical()) {
            return Err("this fault cannot be planted here".to_owned());
        }
        let exact = claim.oracle.is_exact();
        let image_bound = match options.tier {
            Tier::Full => claim.bounds.image.min(FULL_BOUND),
            Tier::Quick | Tier::Default => claim.bounds.image,
        };
        let rules = Rules {
            image_bound,
            tile_bound: claim.bounds.tile,
            alpha,
            rounding: if exact { claim.bounds.rounding } else { 0.0 },
        };
        let mut work = Batches {
            task: self.task,
            first: self.task.budget(options.tier),
            from: self.multiple,
            to: multiple,
            state,
        };
        let picture = work.extend(self.picture.take(), estimator, options.seed, "own")?;
        let facts = picture.metadata.as_ref().ok_or("there are no statistics")?;
        let (spp, replicates) = (facts.spp, facts.replicates);
        let scene_hash = facts.scene_hash.clone();
        let size = facts.film.crop_size;
        let (judged, oracle) = match &claim.oracle {
            Oracle::ClosedForm { formula } | Oracle::Energy { formula } => {
                let known = closed_form::picture(formula, claim, size)?;
                let against = Against::Known(&known);
                let judged = judged::judge(&picture, against, rules, exact)?;
                (judged, drawn(&known))
            }
            Oracle::Reference { .. } => {
                let hash = load(claim, &defines(claim, None), None)?.hash;
                let oracle = reference::read(&claim.name, &hash)?;
                let against = Against::Picture(&oracle);
                (judged::judge(&picture, against, rules, exact)?, oracle)
            }
            Oracle::Agreement { estimator } | Oracle::Invariance { estimator } => {
                let seed = options.seed ^ ORACLE_SEED;
                work.first = options.tier.budget(estimator);
                work.task.fault = None;
                let oracle = work.extend(self.oracle.take(), estimator, seed, "oracle")?;
                let against = Against::Picture(&oracle);
                let judged = judged::judge(&picture, against, rules, exact)?;
                self.oracle = Some(oracle.clone());
                (judged, oracle)
            }
            Oracle::Convergence { .. } | Oracle::Noise { .. } => {
                return Err("this kind of claim compares no pictures".to_owned());
            }
        };
        self.picture = Some(picture.clone());
        Ok(Compared {
            verdict: judged.judgement.verdict,
            p: judged.p,
            evidence: Evidence::Pictures {
                picture: Box::new(picture),
                oracle: Box::new(oracle),
                judgement: judged.judgement,
                refusals: judged.refusals,
            },
            spp,
            replicates,
            scene_hash,
        })
    }
}

/// The replicates that a look adds.
struct Batches<'a> {
    task: Task<'a>,
    first: Budget,
    from: u32,
    to: u32,
    state: Option<&'a State>,
}

impl Batches<'_> {
    /// The replicates so far and those to be added. A finished batch is taken from the state, if
    /// there is one.
    fn extend(
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
                let batch = rendering::picture(&loaded, &plan, self.task.fault, change)?;
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

/// A known picture, for the eye.
fn drawn(known: &Known) -> Developed {
    let [width, height] = known.size.map(|n| n as usize);
    let mut image = Image::new(width, height);
    for (name, pixels) in &known.channels {
        image.push(name.as_str(), pixels.iter().map(|p| *p as f32).collect());
    }
    Developed {
        frame: Frame::whole(&image),
        image,
        metadata: None,
    }
}
