//! What became of a run: every comparison looked at until it is decided, all corrected together.
//!
//! The error level of the whole run, α = 10⁻³, is the probability that a run without any fault
//! in the renderer shows a failure. Every comparison is *declared* to one family before anything is
//! rendered, so that the family's size is the plan's and not the outcome's: a comparison that
//! breaks counts with a p-value of 1. Each gets the same share of α for its intervals (Bonferroni)
//! and spends it over its looks ([`crate::tier`]); its p-value is the least of its looks', each
//! divided by the share of the level that the look was granted, and goes through Holm's procedure.
//! Planted faults are another family: their hypotheses are known to be false.

use crate::look::Look;
use crate::run::{Compared, Comparison, Options, Task};
use crate::state::State;
use crate::tier::{self, FAULT_LOOKS};
use etalon_statistics::{Family, Verdict};
use serde::Serialize;
use std::time::{Duration, Instant};

/// The probability that a run without faults shows a failure.
pub const ALPHA: f64 = 1e-3;

/// A further look that takes no longer than this is made even after the tier's deadline.
const SHORT: Duration = Duration::from_secs(5);

/// What a comparison came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It agrees; or it has a planted fault, which was found.
    Passed,
    /// It differs; or a planted fault was not found.
    Failed,
    /// There were too few samples to say.
    Undecided,
    /// The comparison could not be made.
    Broken,
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::Undecided => "UNDECIDED",
            Self::Broken => "BROKEN",
        })
    }
}

/// What a whole run came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conclusion {
    /// Every claim holds.
    Passed,
    /// A claim failed.
    Failed,
    /// A comparison could not be made, and none failed.
    Broken,
    /// Something is undecided, and nothing is worse.
    Undecided,
}

impl Conclusion {
    /// Of these rows.
    pub fn of(rows: &[Row<'_>]) -> Self {
        let any = |outcome| rows.iter().any(|row| row.outcome == outcome);
        if any(Outcome::Failed) {
            Self::Failed
        } else if any(Outcome::Broken) || rows.is_empty() {
            Self::Broken
        } else if any(Outcome::Undecided) {
            Self::Undecided
        } else {
            Self::Passed
        }
    }

    /// The exit code of the process.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Passed => 0,
            Self::Failed => 1,
            Self::Broken => 2,
            Self::Undecided => 3,
        }
    }
}

/// A comparison and what it came to.
pub struct Row<'a> {
    /// What was compared.
    pub task: Task<'a>,
    /// The comparison at its last look, or why it could not be made.
    pub compared: Result<Compared, String>,
    /// The p-value of "no fault", corrected over the whole run.
    pub p_corrected: Option<f64>,
    /// Agrees, differs or undecided, corrected over the whole run.
    pub verdict: Option<Verdict>,
    /// What that means.
    pub outcome: Outcome,
    /// How often it was looked at.
    pub looks: usize,
    /// The level of its intervals at the last look.
    pub level: f64,
    /// Seconds spent on it.
    pub seconds: f64,
    /// What each look saw.
    pub history: Vec<Look>,
}

/// How far a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// What begins now.
    pub task: &'a Task<'a>,
    /// Which look this is, from 1.
    pub look: usize,
    /// Comparisons of this look that are done.
    pub done: usize,
    /// Comparisons of this look.
    pub total: usize,
    /// Time since the run began.
    pub elapsed: Duration,
    /// Time until this look is over, by the work done so far; unknown at first.
    pub remaining: Option<Duration>,
}

/// Comparisons that share a family and a plan of looks.
struct Group<'a> {
    family: Family,
    looks: &'static [u32],
    levels: Vec<f64>,
    members: Vec<Member<'a>>,
}

struct Member<'a> {
    /// Its place among all tasks.
    place: usize,
    comparison: Comparison<'a>,
    last: Option<Result<Compared, String>>,
    /// The least p-value of the looks, each over the share it was granted.
    p: f64,
    looks: usize,
    history: Vec<Look>,
}

impl Member<'_> {
    /// Whether another look may decide it.
    fn is_open(&self, level: f64) -> bool {
        match &self.last {
            None => true,
            Some(Err(_)) => false,
            Some(Ok(compared)) => compared.verdict == Verdict::Undecided && self.p > level,
        }
    }
}

impl<'a> Group<'a> {
    fn new(
        tasks: impl Iterator<Item = (usize, Task<'a>)>,
        looks: &'static [u32],
    ) -> Result<Self, String> {
        let mut family = Family::new(ALPHA).ok_or("the level is none")?;
        let members: Vec<Member<'a>> = tasks
            .map(|(place, task)| {
                family.declare(format!("{}: {}", task.claim.name, task.label()));
                Member {
                    place,
                    comparison: Comparison::new(task),
                    last: None,
                    p: 1.0,
                    looks: 0,
                    history: Vec::new(),
                }
            })
            .collect();
        let levels = tier::granted(family.level_of_each(), looks)?;
        Ok(Self {
            family,
            looks,
            levels,
            members,
        })
    }

    fn open(&self) -> Vec<usize> {
        let level = self.family.level_of_each();
        let members = self.members.iter().enumerate();
        members
            .filter(|(_, member)| member.is_open(level))
            .map(|(index, _)| index)
            .collect()
    }

    /// Looks at one comparison for the `look`-th time.
    fn look(&mut self, index: usize, look: usize, options: &Options, state: Option<&State>) {
        let granted = self.levels[look];
        let share = granted / self.family.level_of_each();
        let member = &mut self.members[index];
        let compared = member
            .comparison
            .look(self.looks[look], granted, options, state);
        if let Ok(compared) = &compared {
            member.p = member.p.min(compared.p / share);
            let seconds = member.comparison.seconds;
            member.history.extend(Look::of(compared, granted, seconds));
        }
        member.looks += 1;
        member.last = Some(compared);
    }

    /// Corrects over all members.
    fn rows(mut self) -> Vec<(usize, Row<'a>)> {
        for (index, member) in self.members.iter().enumerate() {
            // What broke keeps the p-value of 1 it was declared with.
            if matches!(member.last, Some(Ok(_))) {
                let _ = self.family.record(index, member.p.min(1.0));
            }
        }
        let decisions = self.family.decide();
        let levels = self.levels;
        let rows = self.members.into_iter().zip(decisions);
        rows.map(|(member, decision)| {
            let Member {
                place,
                comparison,
                last,
                looks,
                history,
                ..
            } = member;
            let compared = last.unwrap_or_else(|| Err("there was no time to look".to_owned()));
            let verdict = compared.as_ref().ok().map(|compared| {
                if decision.rejected {
                    Verdict::Differs
                } else {
                    compared.verdict
                }
            });
            let task = comparison.task;
            let outcome = match (verdict, task.fault) {
                (None, _) => Outcome::Broken,
                (Some(Verdict::Agrees), None) | (Some(Verdict::Differs), Some(_)) => {
                    Outcome::Passed
                }
                (Some(Verdict::Undecided), None) => Outcome::Undecided,
                (Some(_), _) => Outcome::Failed,
            };
            let row = Row {
                task,
                p_corrected: verdict.map(|_| decision.adjusted),
                compared,
                verdict,
                outcome,
                looks,
                level: levels[looks.saturating_sub(1)],
                seconds: comparison.seconds,
                history,
            };
            (place, row)
        })
        .collect()
    }
}

/// Makes and decides all comparisons of a run together.
///
/// # Errors
/// If the plan of the run makes no sense; what goes wrong in a comparison is its row's.
pub fn run<'a>(
    tasks: Vec<Task<'a>>,
    options: &Options,
    state: Option<&State>,
    mut watch: impl FnMut(&Progress<'_>),
) -> Result<Vec<Row<'a>>, String> {
    let start = Instant::now();
    let deadline = options.tier.deadline();
    let of = |with_fault: bool| {
        let all = tasks.iter().copied().enumerate();
        all.filter(move |(_, task)| task.fault.is_some() == with_fault)
            .collect::<Vec<_>>()
            .into_iter()
    };
    let mut groups = [
        Group::new(of(false), options.tier.looks())?,
        Group::new(of(true), FAULT_LOOKS)?,
    ];
    let most = groups.iter().map(|group| group.looks.len()).max();
    for look in 0..most.unwrap_or(0) {
        let open: Vec<(usize, usize)> = (groups.iter().enumerate())
            .filter(|(_, group)| look < group.looks.len())
            .flat_map(|(number, group)| group.open().into_iter().map(move |i| (number, i)))
            .collect();
        let work = |groups: &[Group<'_>; 2], (group, index): (usize, usize)| -> f64 {
            let group: &Group<'_> = &groups[group];
            let task = &group.members[index].comparison.task;
            let before = if look > 0 { group.looks[look - 1] } else { 0 };
            let more = f64::from(group.looks[look] - before);
            more * f64::from(task.budget(options.tier).spp)
        };
        let all: f64 = open.iter().map(|at| work(&groups, *at)).sum();
        let (began, mut finished) = (Instant::now(), 0.0);
        for (done, at) in open.iter().copied().enumerate() {
            let own = work(&groups, at);
            let spent = began.elapsed();
            let rest = (finished > 0.0).then(|| {
                Duration::from_secs_f64(spent.as_secs_f64() * (all - finished) / finished)
            });
            let (group, index) = at;
            let seconds = groups[group].members[index].comparison.seconds;
            // A further look takes as long as all before it, or a little longer. Short ones are
            // always made.
            let own_time = Duration::from_secs_f64(1.2 * seconds);
            let late = deadline.is_some_and(|deadline| start.elapsed() + own_time > deadline);
            if look > 0 && late && own_time > SHORT {
                continue;
            }
            watch(&Progress {
                task: &groups[group].members[index].comparison.task,
                look: look + 1,
                done,
                total: open.len(),
                elapsed: start.elapsed(),
                remaining: rest,
            });
            groups[group].look(index, look, options, state);
            finished += own;
        }
    }
    let mut rows: Vec<(usize, Row<'a>)> = groups.into_iter().flat_map(Group::rows).collect();
    rows.sort_by_key(|(place, _)| *place);
    Ok(rows.into_iter().map(|(_, row)| row).collect())
}

/// How many rows came to each outcome: passed, failed, undecided, broken.
pub fn counts(rows: &[Row<'_>]) -> [usize; 4] {
    [
        Outcome::Passed,
        Outcome::Failed,
        Outcome::Undecided,
        Outcome::Broken,
    ]
    .map(|outcome| rows.iter().filter(|row| row.outcome == outcome).count())
}
