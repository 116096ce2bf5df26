//! Null runs: does the whole decision of a run keep its level when nothing is wrong?
//!
//! For every comparison of pictures, the replicates of its own estimator are rendered once
//! ([`Deck`]). Each null run shuffles them and deals them into two hands, as many replicates to each as
//! the look asks for; a deck that runs out is shuffled again. The hands are exchangeable: equality
//! holds for any distribution of the replicates, and every rejection is a false positive. Looks,
//! levels, families, Holm's procedure and the rules for heavy tails are those of the default run.

use crate::claim::Oracle;
use crate::outcome::Outcome;
use crate::rendering;
use crate::tasks::Task;
use crate::tier::Tier;
use etalon_film::{Metadata, RenderedImage, TileMeans};
use etalon_images::{Frame, Image};
use etalon_render::decide::decision::{self, Seen, Stage};
use etalon_render::decide::judged::{self, Against, Asked};
use etalon_render::decide::looks::Multiple;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// The fewest replicates that two hands are dealt from.
const LEAST: u32 = 64;

/// The budgets and looks are those of this run.
const TIER: Tier = Tier::Default;

/// The replicates that the two sides of one comparison are dealt from.
pub struct Deck<'a> {
    task: Task<'a>,
    /// What all hands have in common; without tile means.
    facts: Metadata,
    /// The tile means of all replicates, for every size of tile.
    means: Vec<TileMeans>,
}

impl<'a> Deck<'a> {
    /// Renders the replicates of `task`; `None` if it does not compare means of pictures without a fault.
    ///
    /// # Errors
    /// If they cannot be rendered.
    pub fn render(task: Task<'a>, seed: u64) -> Result<Option<Self>, String> {
        let estimator = task.estimator;
        let compares_means = match task.claim.oracle {
            Oracle::Convergence(_) | Oracle::Noise(_) | Oracle::Povray { .. } => false,
            Oracle::Invariance { .. } => !estimator.change.is_some_and(|c| c.is_of_bits()),
            _ => true,
        };
        if !compares_means || task.fault.is_some() {
            return Ok(None);
        }
        let mut budget = task.budget(TIER);
        let each = budget.spp / budget.replicates;
        budget.replicates = (2 * budget.replicates).max(LEAST);
        budget.spp = each * budget.replicates;
        let loaded = rendering::load_for(task.claim, estimator)?;
        let plan = rendering::plan(&loaded, estimator, budget, seed);
        let picture = rendering::picture(&loaded, &plan, estimator, None, estimator.change)?;
        let mut facts = picture.metadata.ok_or("there are no statistics")?;
        let means = std::mem::take(&mut facts.tile_means);
        Ok(Some(Self { task, facts, means }))
    }

    /// What is compared.
    pub fn task(&self) -> &Task<'a> {
        &self.task
    }

    /// A picture of these replicates.
    fn picture(&self, hand: &[u32]) -> RenderedImage {
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

/// The two hands of one comparison in one null run.
struct Hands<'a> {
    deck: &'a Deck<'a>,
    random: Pcg64Mcg,
    left: Vec<u32>,
    dealt: [Vec<u32>; 2],
}

impl Hands<'_> {
    /// Deals until there are as many replicates as the look asks for, and judges them.
    fn look(&mut self, turn: Stage) -> Result<Seen, String> {
        let task = self.deck.task;
        let count = turn.multiple.of(task.budget(TIER).replicates) as usize;
        for hand in &mut self.dealt {
            while hand.len() < count {
                if self.left.is_empty() {
                    self.left.extend(0..self.deck.facts.replicates);
                    self.left.shuffle(&mut self.random);
                }
                hand.extend(self.left.pop());
            }
        }
        let [own, other] = [0, 1].map(|side| self.deck.picture(&self.dealt[side]));
        let asked = Asked {
            exact: task.claim.oracle.is_exact(),
            alarm: turn.alarm,
        };
        let rules = task.rules(turn.alpha, TIER);
        let judged = judged::judge(&own, Against::Picture(&other), rules, asked)?;
        Ok(Seen {
            verdict: judged.judgement.verdict,
            p: judged.p,
        })
    }
}

/// What one null run came to.
pub struct NullRun {
    /// What each comparison came to.
    pub outcomes: Vec<Outcome>,
    /// The p-value of "no fault" of each comparison at its first look, not corrected over the run.
    pub p_values: Vec<f64>,
}

/// Makes `count` null runs of all decks together. Given the decks, they are independent of each other.
///
/// # Errors
/// If the run's plan makes no sense.
pub fn run(decks: &[Deck<'_>], count: u32, seed: u64) -> Result<Vec<NullRun>, String> {
    let run = |number: u32| once(decks, seed.wrapping_add(u64::from(number) << 32));
    (0..count).into_par_iter().map(run).collect()
}

fn once(decks: &[Deck<'_>], seed: u64) -> Result<NullRun, String> {
    let hands = |(deck, number)| Hands {
        deck,
        random: Pcg64Mcg::seed_from_u64(seed.wrapping_add(number)),
        left: Vec::new(),
        dealt: Default::default(),
    };
    let mut hands: Vec<_> = decks.iter().zip(0..).map(hands).collect();
    let mut p_values = Vec::new();
    let questions: Vec<_> = decks.iter().map(|deck| deck.task.question(TIER)).collect();
    let decisions = decision::decide(
        &questions,
        TIER.looks(),
        |turn| {
            let seen = hands[turn.place].look(turn).ok()?;
            if turn.multiple == Multiple::ONE {
                p_values.push(seen.p);
            }
            Some(seen)
        },
        |_| {},
    )?;
    let decided = decks.iter().zip(decisions);
    let outcomes = decided.map(|(deck, decision)| Outcome::of(&deck.task, decision.verdict));
    Ok(NullRun {
        outcomes: outcomes.collect(),
        p_values,
    })
}
