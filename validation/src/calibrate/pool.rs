//! What null runs are dealt from: the replicates of every comparison's own estimator, rendered once.
//!
//! - Two pictures (agreement, reference, invariance of statistics): the replicates are shuffled and
//!   dealt into two hands without replacement, of as many replicates as the two sides have. When a
//!   further look asks for more than are left, the deck is shuffled again. The hands are
//!   exchangeable: equality holds whatever the replicates' distribution.
//! - A formula: replicates are drawn with replacement, and the formula is replaced by the mean over
//!   all of them, which is the truth of the world that they are drawn from.
//! - Exponents and coverages: batches and pictures are drawn with replacement.
//! - Bits, and pixels without noise: nothing is left to chance, and nothing is dealt.

use crate::batches;
use crate::calibrate::CHANNEL;
use crate::calibrate::question::Question;
use crate::claim::{Budget, Oracle};
use crate::convergence;
use crate::kept::BatchCache;
use crate::noise::{self, Counted};
use crate::reference;
use crate::rendering;
use crate::run::Task;
use crate::state::State;
use crate::tier::Tier;
use etalon_film::{Metadata, RenderedImage, TileMeans};
use etalon_images::{Frame, Image};
use etalon_render::decide::decision::Stage;
use etalon_render::decide::judged::{self, Against, Asked};
use etalon_render::decide::looks::Multiple;
use etalon_render::decide::measure::Measure;
use etalon_render::judge::ExactImage;
use etalon_statistics::{Estimate, Summary, Verdict};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The fewest replicates of a picture that two hands are dealt from.
const LEAST: u32 = 64;

/// The fewest that stand for the world of an estimator that is held against a formula. They have the
/// skewness that chance has given them, with a standard deviation of √(6/n). Of 64 that is up to ±1
/// where a thousand means are asked: too little for 32 drawn ones to show, and enough to raise the level of
/// a t-test tenfold far out in its tail.
const WORLD: u32 = 256;

/// The side of the tiles that single questions are about (pixels).
const SIDE: u32 = 16;

/// A relative standard error below this is rounding, not noise.
const NOISE: f64 = 1e-6;

/// What one comparison is dealt from.
pub struct Pool {
    tier: Tier,
    kind: Kind,
    /// Seconds that rendering it took.
    pub seconds: f64,
}

enum Kind {
    Pictures(Box<Pictures>),
    Exponents(Vec<f64>),
    Coverages(Vec<Counted>),
    Certain,
}

struct Pictures {
    /// What all hands have in common; without tile means.
    facts: Metadata,
    /// The tile means of all replicates, for every size of tile.
    means: Vec<TileMeans>,
    /// The mean of all replicates, where a formula is the oracle.
    known: Option<ExactImage>,
    /// Replicates of each side at the first look.
    own: u32,
    other: u32,
    /// Whether further looks add replicates to the other side, too.
    other_grows: bool,
}

/// What a dealt look came to.
pub struct Dealt {
    /// The decision at the look's level.
    pub verdict: Verdict,
    /// The p-value of "no fault".
    pub p: f64,
}

/// The hands of one comparison in one null run.
pub struct Table<'a> {
    pool: &'a Pool,
    task: Task<'a>,
    random: Pcg64Mcg,
    deck: Vec<u32>,
    own: Vec<u32>,
    other: Vec<u32>,
}

impl Pool {
    /// How many replicates of a picture there are; `None` where nothing is dealt from one picture.
    pub fn replicates(&self) -> Option<u32> {
        match &self.kind {
            Kind::Pictures(pictures) => Some(pictures.replicates()),
            Kind::Exponents(_) | Kind::Coverages(_) | Kind::Certain => None,
        }
    }

    /// Renders what the looks of `task` are dealt from.
    ///
    /// # Errors
    /// If it cannot be rendered.
    pub fn render(task: Task<'_>, tier: Tier, seed: u64, state: &State) -> Result<Self, String> {
        let start = std::time::Instant::now();
        let (claim, estimator) = (task.claim, task.estimator);
        let first = task.budget(tier);
        let kind = match &claim.oracle {
            Oracle::Convergence(ladder) => {
                let mut climbed = convergence::Climbed::default();
                climbed.extend(claim, ladder, (estimator, None), first, seed)?;
                Kind::Exponents(climbed.batches.exponents)
            }
            Oracle::Noise(counting) => {
                let of = (counting, 0..counting.effort(tier, None).seeds);
                Kind::Coverages(noise::count(
                    claim,
                    of,
                    estimator,
                    None,
                    first,
                    seed,
                    &BatchCache::new(None),
                )?)
            }
            Oracle::Invariance { .. } if estimator.change.is_some_and(|c| c.is_of_bits()) => {
                Kind::Certain
            }
            Oracle::Povray { .. } => Kind::Certain,
            _ => Kind::Pictures(Box::new(Pictures::render(task, first, tier, seed, state)?)),
        };
        Ok(Self {
            tier,
            kind,
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// Sits down to a null run.
    pub fn sit<'a>(&'a self, task: Task<'a>, seed: u64) -> Table<'a> {
        Table {
            pool: self,
            task,
            random: Pcg64Mcg::seed_from_u64(seed),
            deck: Vec::new(),
            own: Vec::new(),
            other: Vec::new(),
        }
    }
}

impl Pictures {
    fn render(
        task: Task<'_>,
        first: Budget,
        tier: Tier,
        seed: u64,
        state: &State,
    ) -> Result<Self, String> {
        let (claim, estimator) = (task.claim, task.estimator);
        let (other, other_grows) = match &claim.oracle {
            Oracle::Reference { .. } => (reference::provenance(&claim.name)?.seeds, false),
            Oracle::Agreement { estimator } | Oracle::Invariance { estimator } => {
                (tier.budget(estimator).replicates, true)
            }
            _ => (0, false),
        };
        let is_world = matches!(
            claim.oracle,
            Oracle::ClosedForm { .. } | Oracle::Energy { .. }
        );
        let least = if is_world { WORLD } else { LEAST };
        let replicates = (first.replicates + other).max(least);
        let budget = Budget {
            spp: first.spp / first.replicates * replicates,
            replicates,
            ..first
        };
        let loaded = rendering::load_for(claim, estimator)?;
        let plan = rendering::plan(&loaded, estimator, budget, seed);
        // As in a run: a claim may be edited between two calibrations of one program.
        let print = batches::fingerprint(estimator);
        let name = format!("{}-{}-{print:08x}", claim.name, task.place);
        let picture = match state.read(&name, &plan, &loaded) {
            Some(picture) => picture,
            None => {
                let picture =
                    rendering::picture(&loaded, &plan, estimator, None, estimator.change)?;
                state.write(&name, &picture)?;
                picture
            }
        };
        let mut facts = picture.metadata.ok_or("there are no statistics")?;
        let means = std::mem::take(&mut facts.tile_means);
        let known = is_world.then(|| mean_of_all(&facts, &means)).transpose()?;
        Ok(Self {
            facts,
            means,
            known,
            own: first.replicates,
            other,
            other_grows,
        })
    }

    /// How many replicates there are.
    fn replicates(&self) -> u32 {
        self.facts.replicates
    }

    /// A picture of these replicates.
    fn of(&self, hand: &[u32]) -> RenderedImage {
        let image = Image::new(1, 1);
        RenderedImage {
            frame: Frame::whole(&image),
            image,
            metadata: Some(Metadata {
                replicates: hand.len() as u32,
                tile_means: self.means.iter().map(|means| means.chosen(hand)).collect(),
                ..self.facts.clone()
            }),
        }
    }
}

impl<'a> Table<'a> {
    /// Deals until there are as many replicates as the look asks for, and judges them at the levels
    /// that it is granted.
    ///
    /// # Errors
    /// If what was dealt cannot be judged.
    pub fn look(&mut self, turn: Stage) -> Result<Dealt, String> {
        let Stage {
            multiple, alpha, ..
        } = turn;
        match &self.pool.kind {
            Kind::Pictures(pictures) => self.pictures(pictures, turn),
            Kind::Exponents(exponents) => {
                let count = multiple.of(exponents.len() as u32);
                let drawn: Vec<f64> = (0..count).map(|_| *self.draw(exponents)).collect();
                let measure = convergence::judge(&drawn, self.task.estimator, alpha)?;
                Ok(Dealt {
                    verdict: measure.verdict,
                    p: measure.p,
                })
            }
            Kind::Coverages(counted) => {
                let Oracle::Noise(counting) = &self.task.claim.oracle else {
                    return Err("coverages belong to claims about noise".to_owned());
                };
                let tolerance = counting.effort(self.pool.tier, None).tolerance;
                let count = multiple.of(counted.len() as u32);
                let drawn: Vec<Counted> = (0..count).map(|_| *self.draw(counted)).collect();
                let blocks = self.task.estimator.blocks;
                let measures = noise::judge(&drawn, blocks, tolerance, alpha)?;
                let (verdict, p) = Measure::together(&measures);
                Ok(Dealt { verdict, p })
            }
            Kind::Certain => Ok(Dealt {
                verdict: Verdict::Agrees,
                p: 1.0,
            }),
        }
    }

    fn draw<'b, T>(&mut self, all: &'b [T]) -> &'b T {
        &all[self.random.random_range(0..all.len())]
    }

    fn pictures(&mut self, pictures: &Pictures, turn: Stage) -> Result<Dealt, String> {
        let multiple = turn.multiple;
        let rules = self.task.rules(turn.alpha, self.pool.tier);
        let asked = Asked {
            exact: self.task.claim.oracle.is_exact(),
            alarm: turn.alarm,
        };
        let want = |first: u32| multiple.of(first) as usize;
        let judged = if let Some(known) = &pictures.known {
            while self.own.len() < want(pictures.own) {
                let drawn = self.random.random_range(0..pictures.replicates());
                self.own.push(drawn);
            }
            judged::judge(
                &pictures.of(&self.own),
                Against::ExactImage(known),
                rules,
                asked,
            )?
        } else {
            let mut own = std::mem::take(&mut self.own);
            let mut other = std::mem::take(&mut self.other);
            self.deal(&mut own, want(pictures.own), pictures.replicates());
            let most = if pictures.other_grows {
                multiple
            } else {
                Multiple::ONE
            };
            self.deal(
                &mut other,
                most.of(pictures.other) as usize,
                pictures.replicates(),
            );
            (self.own, self.other) = (own, other);
            let against = pictures.of(&self.other);
            judged::judge(
                &pictures.of(&self.own),
                Against::Picture(&against),
                rules,
                asked,
            )?
        };
        Ok(Dealt {
            verdict: judged.judgement.verdict,
            p: judged.p,
        })
    }

    /// Deals to a hand until it holds `count` replicates.
    fn deal(&mut self, hand: &mut Vec<u32>, count: usize, replicates: u32) {
        while hand.len() < count {
            if self.deck.is_empty() {
                self.deck.extend(0..replicates);
                self.deck.shuffle(&mut self.random);
            }
            hand.extend(self.deck.pop());
        }
    }

    /// The p-values of single questions about what has been dealt, not corrected: the mean of the
    /// image, and of its first tile. Where replicates do not vary there is nothing to ask.
    pub fn questions(&self) -> Vec<(Question, f64)> {
        let Kind::Pictures(pictures) = &self.pool.kind else {
            return Vec::new();
        };
        let Some(channel) = pictures.facts.channel_index(CHANNEL) else {
            return Vec::new();
        };
        let mut questions = Vec::new();
        for means in &pictures.means {
            let question = match (means.side(), &pictures.known) {
                (None, Some(_)) => Question::MeanFormula,
                (None, None) => Question::MeanPictures,
                (Some(SIDE), Some(_)) => Question::TileFormula,
                (Some(SIDE), None) => Question::TilePictures,
                _ => continue,
            };
            let values = |hand: &[u32]| -> Vec<f64> {
                let value = |replicate: &u32| f64::from(means.plane(*replicate, channel)[0]);
                hand.iter().map(value).collect()
            };
            let Some(own) = Summary::of(&values(&self.own)) else {
                continue;
            };
            let estimate = match &pictures.known {
                Some(_) => {
                    let all: Vec<u32> = (0..pictures.replicates()).collect();
                    let all = values(&all);
                    let truth = all.iter().sum::<f64>() / all.len() as f64;
                    Estimate::excess(&own, truth)
                }
                None => match Summary::of(&values(&self.other)) {
                    Some(other) => Estimate::welch(&own, &other),
                    None => continue,
                },
            };
            if estimate.standard_error() > NOISE * own.mean().abs() {
                questions.push((question, estimate.p_differs(0.0)));
            }
        }
        questions
    }
}

/// The mean of all replicates as a picture: every pixel has the mean of its smallest tile.
fn mean_of_all(facts: &Metadata, means: &[TileMeans]) -> Result<ExactImage, String> {
    let size = facts.film.crop_size;
    let smallest = means.iter().filter(|means| means.side().is_some());
    let smallest = smallest.min_by_key(|means| means.side());
    let smallest = smallest.ok_or("there are no tiles")?;
    let side = smallest.side().unwrap_or(1);
    let mut channels = Vec::new();
    for (index, name) in (0..).zip(&facts.channels) {
        let tiles = (smallest.columns() * smallest.rows()) as usize;
        let mut sums = vec![0.0; tiles];
        for replicate in 0..smallest.replicates() {
            let plane = smallest.plane(replicate, index);
            for (sum, value) in sums.iter_mut().zip(plane) {
                *sum += f64::from(*value);
            }
        }
        let pixels = (0..size[0] * size[1]).map(|pixel| {
            let (x, y) = (pixel % size[0], pixel / size[0]);
            let tile = y / side * smallest.columns() + x / side;
            sums[tile as usize] / f64::from(smallest.replicates())
        });
        channels.push((name.clone(), pixels.collect()));
    }
    Ok(ExactImage { size, channels })
}
