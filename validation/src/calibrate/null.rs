//! Null runs: the whole decision of a run, on dealt replicates.
//!
//! Looks, levels, families, Holm's procedure and the rules for heavy tails are those of a run; only
//! the replicates are dealt ([`super::pool`]) and not rendered. Runs are independent given the pools, so that the number
//! of those with a false alarm is binomial.

use super::pool::Pool;
use super::question::Question;
use crate::outcome::Outcome;
use crate::run::Task;
use crate::tier::Tier;
use etalon_render::decide::decision::{self, FALSE_POSITIVE_LEVEL, Seen};
use etalon_render::decide::looks::Multiple;
use etalon_statistics::error_rates::Rate;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// What all null runs came to.
pub struct NullRuns {
    /// Runs with a false alarm, against [`FALSE_POSITIVE_LEVEL`].
    pub alarms: Rate,
    /// Runs with any comparison undecided.
    pub undecided: u32,
    /// For each comparison: how many runs called it different, left it undecided, or could not decide it.
    pub comparisons: Vec<Counts>,
    /// The p-values of single questions at the first look, over all runs and comparisons.
    pub p_values: Vec<(Question, Vec<f64>)>,
}

/// How a comparison fared over all null runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// False alarms.
    pub failed: u32,
    /// Undecided.
    pub undecided: u32,
    /// Without a decision.
    pub broken: u32,
}

struct Run {
    outcomes: Vec<Outcome>,
    p_values: Vec<(Question, f64)>,
}

/// Makes `runs` null runs; `watch` hears how many are done.
///
/// # Errors
/// If a run's plan makes no sense.
pub fn run(
    tasks: &[Task<'_>],
    pools: &[Pool],
    tier: Tier,
    (runs, seed): (u32, u64),
    confidence: f64,
    watch: impl Fn(u32) + Sync,
) -> Result<NullRuns, String> {
    let done = AtomicU32::new(0);
    let all: Vec<Run> = (0..runs)
        .into_par_iter()
        .map(|number| {
            let run = once(
                tasks,
                pools,
                tier,
                seed.wrapping_add(u64::from(number) << 32),
            );
            watch(done.fetch_add(1, Ordering::Relaxed) + 1);
            run
        })
        .collect::<Result<_, String>>()?;
    let mut comparisons = vec![Counts::default(); tasks.len()];
    let (mut alarms, mut undecided) = (0, 0);
    for run in &all {
        for (counts, outcome) in comparisons.iter_mut().zip(&run.outcomes) {
            match outcome {
                Outcome::Passed => {}
                Outcome::Failed => counts.failed += 1,
                Outcome::Undecided => counts.undecided += 1,
                Outcome::Broken => counts.broken += 1,
            }
        }
        alarms += u64::from(run.outcomes.contains(&Outcome::Failed));
        undecided += u32::from(run.outcomes.contains(&Outcome::Undecided));
    }
    let p_values = Question::ALL.map(|question| {
        let all = all.iter().flat_map(|run| &run.p_values);
        let of = all.filter(|(asked, _)| *asked == question);
        (question, of.map(|(_, p)| *p).collect())
    });
    Ok(NullRuns {
        alarms: Rate::new(FALSE_POSITIVE_LEVEL, alarms, u64::from(runs), confidence)
            .ok_or("there are no null runs")?,
        undecided,
        comparisons,
        p_values: p_values.into(),
    })
}

/// One null run.
fn once(tasks: &[Task<'_>], pools: &[Pool], tier: Tier, seed: u64) -> Result<Run, String> {
    let mut tables: Vec<_> = (tasks.iter().zip(pools).zip(0..))
        .map(|((task, pool), number)| pool.sit(*task, seed.wrapping_add(number)))
        .collect();
    let mut p_values = Vec::new();
    let questions: Vec<_> = tasks.iter().map(|task| task.question(tier)).collect();
    let decisions = decision::decide(
        &questions,
        tier.looks(),
        |turn| {
            let table = &mut tables[turn.place];
            let dealt = table.look(turn).ok()?;
            if turn.multiple == Multiple::ONE {
                p_values.extend(table.questions());
            }
            Some(Seen {
                verdict: dealt.verdict,
                p: dealt.p,
            })
        },
        |_| {},
    )?;
    let decided = tasks.iter().zip(decisions);
    Ok(Run {
        outcomes: decided
            .map(|(task, decision)| Outcome::of(task, decision.verdict))
            .collect(),
        p_values,
    })
}
