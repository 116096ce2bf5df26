//! Rendering and judging one claim's comparisons.
//!
//! A [`Comparison`] is looked at once or several times; each look adds replicates with seeds of
//! their own to those there are, and judges them all.

use crate::batch_cache::BatchCache;
use crate::batches::{Batches, Side};
use crate::claim::{Budget, Effort, Oracle};
use crate::{closed_form, convergence, invariance, noise, pixelwise, reference, rendering};
use etalon_film::RenderedImage;
use etalon_images::{Frame, Image};
use etalon_render::decide::convergence::Fall;
use etalon_render::decide::decision::Stage;
use etalon_render::decide::judged::{self, Against, Asked};
use etalon_render::decide::looks::Multiple;
use etalon_render::decide::measure::Measure;
use etalon_render::decide::pixelwise::PixelwiseLimits;
use etalon_render::judge::{ExactImage, ImageComparison, ImageRow};
use etalon_statistics::Verdict;

pub use crate::read::{named, unknown};
pub use crate::rendering::{defines, load};
pub use crate::tasks::{Options, RunPlan, Task, tasks};

/// What a comparison was decided by.
pub enum Evidence {
    /// Pictures and their means.
    Pictures {
        /// Our picture.
        picture: Box<RenderedImage>,
        /// What it ought to be.
        oracle: Box<RenderedImage>,
        /// The decision, before it is corrected over the whole run.
        judgement: ImageComparison,
        /// Where the normal approximation was refused.
        refusals: Vec<String>,
    },
    /// Numbers with intervals.
    Measures(Vec<Measure>),
}

/// The number that speaks for a comparison: it reaches farthest towards what is not accepted.
pub enum WorstNumber<'a> {
    /// The mean of this channel of the image.
    Channel(&'a ImageRow),
    /// The measure with the smallest p-value.
    Measure(&'a Measure),
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
    /// Our picture and what it ought to be, where the measures were taken of pictures.
    pub shown: Option<Box<[RenderedImage; 2]>>,
    /// How the squared error falls, for claims of convergence.
    pub fall: Option<Fall>,
    /// The greatest relative bias of an image's mean that is not excluded with 99 % confidence
    /// ([`etalon_render::decide::looks::STATED`]), if it was asked for.
    pub bias_bound: Option<f64>,
}

impl Compared {
    /// The judgement on pictures, if there is one.
    pub fn judgement(&self) -> Option<&ImageComparison> {
        match &self.evidence {
            Evidence::Pictures { judgement, .. } => Some(judgement),
            Evidence::Measures(_) => None,
        }
    }

    /// The number that speaks for it; `None` if there is none at all.
    pub fn worst(&self) -> Option<WorstNumber<'_>> {
        match self.judgement() {
            Some(judgement) => judgement.widest().map(WorstNumber::Channel),
            None => {
                let measures = self.measures().iter();
                let worst = measures.min_by(|a, b| a.p.total_cmp(&b.p));
                worst.map(WorstNumber::Measure)
            }
        }
    }

    /// The measures, if there are any.
    pub fn measures(&self) -> &[Measure] {
        match &self.evidence {
            Evidence::Pictures { .. } => &[],
            Evidence::Measures(measures) => measures,
        }
    }
}

/// A comparison and the replicates there are so far.
pub struct Comparison<'a> {
    task: Task<'a>,
    picture: Option<RenderedImage>,
    oracle: Option<RenderedImage>,
    /// The pictures counted so far, of a claim about noise.
    counted: Vec<noise::Counted>,
    /// The batches so far, of a claim about convergence.
    climbed: convergence::Climbed,
    /// Replicates so far, in multiples of the first look's.
    multiple: Multiple,
}

/// The seed of what an agreement's estimator is held against: the two must be independent.
const ORACLE_SEED: u64 = 0x6f72_6163_6c65;

impl<'a> Comparison<'a> {
    /// Nothing compared yet.
    pub fn new(task: Task<'a>) -> Self {
        Self {
            task,
            picture: None,
            oracle: None,
            counted: Vec::new(),
            climbed: convergence::Climbed::default(),
            multiple: Multiple::ZERO,
        }
    }

    /// Renders until there are as many replicates as the look asks for, and judges them all at the
    /// levels that it is granted.
    ///
    /// # Errors
    /// If it cannot be made: a scene or a reference that cannot be read, numbers that are not
    /// finite.
    pub(crate) fn look(
        &mut self,
        turn: Stage,
        options: &Options,
        kept: &BatchCache<'_>,
    ) -> Result<Compared, String> {
        let compared = self.measured(turn, options, kept);
        self.multiple = turn.multiple;
        compared
    }

    fn measured(
        &mut self,
        turn: Stage,
        options: &Options,
        kept: &BatchCache<'_>,
    ) -> Result<Compared, String> {
        let Task {
            claim,
            estimator,
            fault,
            ..
        } = self.task;
        let Stage {
            multiple, alpha, ..
        } = turn;
        let first = self.task.budget(options.tier);
        let budget = Budget {
            spp: multiple.of(first.spp),
            replicates: multiple.of(first.replicates),
            ..first
        };
        let (mut shown, mut fall, mut replicates) = (None, None, budget.replicates);
        let (measures, spp) = match &claim.oracle {
            Oracle::Povray { edges, excused } => {
                let limits = PixelwiseLimits {
                    edges: *edges,
                    excused: *excused,
                };
                let seeded = (options.seed, alpha);
                let made = pixelwise::compare_pixelwise(
                    claim, limits, estimator, fault, budget, seeded, kept,
                )?;
                shown = Some(Box::new([made.picture, made.oracle]));
                (made.measures, made.spp)
            }
            Oracle::Convergence(ladder) => {
                let seed = options.seed;
                let climbed = &mut self.climbed;
                climbed.extend(claim, ladder, (estimator, fault), budget, seed)?;
                let measure = convergence::judge(&climbed.batches.exponents, estimator, alpha)?;
                fall = Some(climbed.fall(ladder));
                (vec![measure], climbed.spp)
            }
            Oracle::Noise(counting) => {
                let Effort { seeds, tolerance } = counting.effort(options.tier, fault);
                let pictures = multiple.of(seeds);
                let numbers = self.counted.len() as u32..pictures;
                let of = (counting, numbers);
                let more = noise::count(claim, of, estimator, fault, first, options.seed, kept)?;
                self.counted.extend(more);
                // Those of all pictures, as its samples are.
                replicates = pictures * first.replicates;
                let blocks = estimator.blocks;
                let measures = noise::judge(&self.counted, blocks, tolerance, alpha)?;
                (measures, u64::from(pictures) * u64::from(first.spp))
            }
            Oracle::Invariance { .. } => {
                let loaded = rendering::load_for(claim, estimator)?;
                let plan = rendering::plan(&loaded, estimator, first, options.seed);
                match invariance::measure(claim, estimator, &loaded, &plan, fault)? {
                    Some((measures, picture)) => {
                        let spp = picture.metadata.as_ref().map_or(0, |m| m.spp);
                        (measures, spp)
                    }
                    None => return self.pictures(turn, options, kept),
                }
            }
            Oracle::ClosedForm { .. }
            | Oracle::Reference { .. }
            | Oracle::Agreement { .. }
            | Oracle::Energy { .. } => return self.pictures(turn, options, kept),
        };
        let (verdict, p) = Measure::together(&measures);
        Ok(Compared {
            evidence: Evidence::Measures(measures),
            verdict,
            p,
            spp,
            replicates,
            scene_hash: rendering::load_for(claim, estimator)?.hash,
            shown,
            fall,
            bias_bound: None,
        })
    }

    fn pictures(
        &mut self,
        turn: Stage,
        options: &Options,
        kept: &BatchCache<'_>,
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
        // First, as a reference that cannot be used need not cost a render.
        let stored = match &claim.oracle {
            Oracle::Reference { .. } => Some(reference::read(claim)?),
            _ => None,
        };
        let exact = claim.oracle.is_exact();
        let rules = self.task.rules(turn.alpha, options.tier);
        let mut work = Batches {
            task: self.task,
            first: self.task.budget(options.tier),
            from: self.multiple,
            to: turn.multiple,
            kept,
        };
        let picture = work.extend(self.picture.take(), estimator, options.seed, Side::Own)?;
        let facts = picture.metadata.as_ref().ok_or("there are no statistics")?;
        let (spp, replicates) = (facts.spp, facts.replicates);
        let scene_hash = facts.scene_hash.clone();
        let size = facts.film.crop_size;
        let known;
        let (against, oracle) = match (&claim.oracle, stored) {
            (_, Some(stored)) => (None, stored),
            (Oracle::ClosedForm { formula } | Oracle::Energy { formula }, _) => {
                known = closed_form::picture(formula, claim, estimator, size)?;
                (Some(&known), drawn(&known))
            }
            (Oracle::Agreement { estimator } | Oracle::Invariance { estimator }, _) => {
                let seed = options.seed ^ ORACLE_SEED;
                work.first = options.tier.budget(estimator);
                let oracle = match (fault, self.oracle.take()) {
                    // A fault must show against what the sound comparison rendered for its first look.
                    (Some(_), Some(oracle)) => oracle,
                    (Some(_), None) => {
                        work.to = Multiple::ONE;
                        work.extend(None, estimator, seed, Side::Oracle)?
                    }
                    (None, so_far) => work.extend(so_far, estimator, seed, Side::Oracle)?,
                };
                self.oracle = Some(oracle.clone());
                (None, oracle)
            }
            _ => {
                return Err("this kind of claim compares no pictures".to_owned());
            }
        };
        let against = against.map_or(Against::Picture(&oracle), Against::ExactImage);
        let asked = Asked {
            exact,
            alarm: turn.alarm,
        };
        let judged = judged::judge(&picture, against, rules, asked)?;
        let stated = judged::stated(&picture, against, &judged.judgement, exact, turn.stated)?;
        // A planted fault is no row that a full run grants anything: it is found, or it is not.
        let verdict = if options.tier.states_bounds() && fault.is_none() {
            stated.verdict(&judged.judgement)
        } else {
            judged.judgement.verdict
        };
        self.picture = Some(picture.clone());
        Ok(Compared {
            verdict,
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
            shown: None,
            fall: None,
            bias_bound: Some(stated.bias),
        })
    }
}

/// A known picture, for the eye.
fn drawn(known: &ExactImage) -> RenderedImage {
    let [width, height] = known.size.map(|n| n as usize);
    let mut image = Image::new(width, height);
    for (name, pixels) in &known.channels {
        image.push(name.as_str(), pixels.iter().map(|p| *p as f32).collect());
    }
    RenderedImage {
        frame: Frame::whole(&image),
        image,
        metadata: None,
    }
}
