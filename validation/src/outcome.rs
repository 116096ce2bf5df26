//! What became of a run: every comparison rendered, looked at until it is decided, and judged
//! together with all others ([`etalon_render::decide::decision`]).

use crate::batch_cache::BatchCache;
use crate::look::Look;
use crate::run::{Compared, Comparison, Options, Task};
use crate::state::State;
use etalon_render::decide::decision::{self, Decision, Question, Seen, Stage};
use etalon_statistics::Verdict;
use serde::Serialize;
use std::time::Instant;

pub use etalon_render::decide::decision::{ALPHA, FALSE_POSITIVE_LEVEL, Progress};

/// What a comparison came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It agrees; or it has a planted fault, which was found.
    Passed,
    /// It differs; or a planted fault is shown not to matter.
    Failed,
    /// There were too few samples to say; of a planted fault, too.
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
    /// What that came to, together with all others.
    pub decision: Decision,
    /// What that means.
    pub outcome: Outcome,
    /// What each look saw.
    pub history: Vec<Look>,
}

impl Outcome {
    /// What a verdict on a task means; there is none if it could not be compared.
    pub fn of(task: &Task<'_>, verdict: Option<Verdict>) -> Self {
        match (verdict, task.fault) {
            (None, _) => Self::Broken,
            (Some(Verdict::Agrees), None) | (Some(Verdict::Differs), Some(_)) => Self::Passed,
            // A fault that is missed for lack of samples says nothing against the program.
            (Some(Verdict::Undecided), _) => Self::Undecided,
            (Some(Verdict::Differs), None) | (Some(Verdict::Agrees), Some(_)) => Self::Failed,
        }
    }
}

/// Makes and decides all comparisons of a run together; those made elsewhere have no row.
///
/// # Errors
/// If the plan of the run makes no sense; what goes wrong in a comparison is its row's.
pub fn run<'a>(
    tasks: Vec<Task<'a>>,
    options: &Options,
    state: Option<&State>,
    mut watch: impl FnMut(&Task<'a>, &Progress),
) -> Result<Vec<Row<'a>>, String> {
    let mut works: Vec<Work<'a>> = tasks.iter().copied().map(Work::new).collect();
    let kept = BatchCache::new(state);
    let questions = tasks.iter().map(|task| task.question(options.tier));
    let questions: Vec<Question> = questions.collect();
    let decisions = decision::decide(
        &questions,
        options.tier.looks(),
        |turn| works[turn.place].look(turn, options, &kept),
        |progress| watch(&tasks[progress.place], progress),
    )?;
    let made = tasks.into_iter().zip(works);
    let rows = made.filter(|(task, _)| !task.elsewhere).zip(decisions);
    Ok(rows
        .map(|((task, work), decision)| Row {
            task,
            compared: (work.last).unwrap_or_else(|| Err("it was not looked at".to_owned())),
            decision,
            outcome: Outcome::of(&task, decision.verdict),
            history: work.history,
        })
        .collect())
}

/// A comparison being rendered.
struct Work<'a> {
    comparison: Comparison<'a>,
    last: Option<Result<Compared, String>>,
    history: Vec<Look>,
    seconds: f64,
}

impl<'a> Work<'a> {
    fn new(task: Task<'a>) -> Self {
        Self {
            comparison: Comparison::new(task),
            last: None,
            history: Vec::new(),
            seconds: 0.0,
        }
    }

    fn look(&mut self, turn: Stage, options: &Options, kept: &BatchCache<'_>) -> Option<Seen> {
        let start = Instant::now();
        let compared = self.comparison.look(turn, options, kept);
        self.seconds += start.elapsed().as_secs_f64();
        let seen = compared.as_ref().ok().map(|compared| {
            let look = Look::of(compared, turn.alpha, self.seconds);
            self.history.extend(look);
            Seen {
                verdict: compared.verdict,
                p: compared.p,
            }
        });
        self.last = Some(compared);
        seen
    }
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
