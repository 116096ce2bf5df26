//! The decision of a whole run: every comparison looked at until it is decided, all corrected together.
//!
//! Two error levels hold for the whole run, as its two errors cost differently:
//!
//! - [`FALSE_POSITIVE_LEVEL`] = 10⁻⁵ is the probability that a run without any fault in the renderer shows a
//!   failure. A failure sends people to look for a fault, so thousands of sound runs shall go by
//!   without one.
//! - [`ALPHA`] = 10⁻³ is the probability that any of the intervals misses its truth, and so that a bias
//!   beyond its bound passes. What differs at this level and not at the other is in *doubt*: it gets
//!   more replicates as what is undecided does, and is undecided if they run out. It never passes.
//!
//! Every comparison is *declared* to one family before anything is rendered, so that the family's
//! size is the plan's and not the outcome's: a comparison that breaks counts with a p-value of 1.
//! Each gets the same share of both levels (Bonferroni) and spends it over its looks
//! ([`super::looks`]). A look judges its intervals by its share of α. Its p-value is divided by the
//! part of the level that the look was granted; the least of a comparison's goes through Holm's
//! procedure at the level of alarms.
//!
//! Planted faults are another family: their hypotheses are known to be false, and to find them needs
//! no more than α.
//!
//! Both levels presume that means are as normal as their replicates look. A skewness that few replicates
//! cannot show lifts them, and the more the lower they are: of 32 gamma-distributed replicates with a skewness of 0.7,
//! Student's t on one side errs 37 times as often as it may at 10⁻⁸, 77 times at 10⁻¹⁰ (computed once, with
//! the importance sampling of the tests of [`etalon_statistics::lowered`]; no test holds these two numbers).
//! A level that allows one false alarm in a hundred thousand runs has room for a few such means.
//!
//! How a look comes by its evidence is the caller's: pictures may be rendered, dealt from others, or made by
//! another program.

use super::looks::{self, FINE_LOOKS, Multiple, STATED};
use etalon_statistics::{Family, Verdict};
use std::time::{Duration, Instant};

/// The probability that any interval of a run misses its truth.
pub const ALPHA: f64 = 1e-3;

/// The probability that a run without faults shows a failure.
pub const FALSE_POSITIVE_LEVEL: f64 = 1e-5;

/// Looks at planted faults: up to eight times the budget.
pub const MUTANT_LOOKS: &[Multiple] = FINE_LOOKS;

/// A comparison as the decision sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// What is compared: a name of its own.
    pub name: String,
    /// Whether a fault was planted, so that the comparison must differ.
    pub is_mutant: bool,
    /// Whether another part of the run makes it: it is counted here, and not looked at.
    pub elsewhere: bool,
    /// What the first look costs, in any unit: what progress is measured in.
    pub cost: f64,
}

/// A look that is to be made.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// The comparison's place among all.
    pub place: usize,
    /// How many replicates there shall be, in multiples of the first look's.
    pub multiple: Multiple,
    /// The level of its intervals.
    pub alpha: f64,
    /// The level at which it may show a failure.
    pub alarm: f64,
    /// The level of statements on the row by itself ([`STATED`]).
    pub stated: f64,
}

/// What a look came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The decision at the look's level.
    pub verdict: Verdict,
    /// The p-value of "no fault" at this look.
    pub p: f64,
}

/// What a comparison came to in the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Agrees, differs or undecided, corrected over the whole run; absent for what broke.
    pub verdict: Option<Verdict>,
    /// Whether it is undecided because it differs at the level of the intervals only.
    pub in_doubt: bool,
    /// The p-value of "no fault", corrected over the whole run.
    pub p_corrected: Option<f64>,
    /// How often it was looked at.
    pub looks: usize,
    /// The level of its intervals at the last look.
    pub level: f64,
    /// Seconds spent on it.
    pub seconds: f64,
}

/// How far a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// The place of the comparison that begins now.
    pub place: usize,
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
struct Group {
    family: Family,
    looks: &'static [Multiple],
    /// The level of the intervals at each look.
    levels: Vec<f64>,
    /// What each look is granted of [`STATED`].
    stated: Vec<f64>,
    members: Vec<Member>,
}

struct Member {
    /// Its place among all comparisons.
    place: usize,
    /// Its place in the family.
    hypothesis: usize,
    cost: f64,
    /// What the last look came to; `None` in it if that broke.
    last: Option<Option<Verdict>>,
    /// The least p-value of the looks, each over the share it was granted.
    p: f64,
    looks: usize,
    seconds: f64,
}

impl Member {
    /// Whether another look may decide it; `level` is its share of the level of alarms.
    fn is_open(&self, level: f64) -> bool {
        match self.last {
            None => true,
            Some(None) => false,
            Some(Some(verdict)) => verdict != Verdict::Agrees && self.p > level,
        }
    }
}

impl Group {
    fn new<'a>(
        questions: impl Iterator<Item = (usize, &'a Question)>,
        looks: &'static [Multiple],
        alarm: f64,
    ) -> Result<Self, String> {
        let mut family = Family::new(alarm).ok_or("the level is none")?;
        // What another part of the run makes is a hypothesis of this one, too: all parts together
        // have the error level of the whole.
        let members: Vec<Member> = questions
            .filter_map(|(place, question)| {
                let hypothesis = family.declare(question.name.clone());
                (!question.elsewhere).then_some(Member {
                    place,
                    hypothesis,
                    cost: question.cost,
                    last: None,
                    p: 1.0,
                    looks: 0,
                    seconds: 0.0,
                })
            })
            .collect();
        Ok(Self {
            levels: looks::granted(ALPHA / family.len().max(1) as f64, looks)?,
            family,
            looks,
            stated: looks::granted(STATED, looks)?,
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

    /// Looks at one comparison for the `number`-th time, from 0.
    fn look(&mut self, index: usize, number: usize, make: impl FnOnce(Stage) -> Option<Seen>) {
        let granted = self.levels[number];
        // The same part of either level.
        let part = granted * self.family.len() as f64 / ALPHA;
        let alarm = part * self.family.level_of_each();
        let member = &mut self.members[index];
        let start = Instant::now();
        let seen = make(Stage {
            place: member.place,
            multiple: self.looks[number],
            alpha: granted,
            alarm,
            stated: self.stated[number],
        });
        member.seconds += start.elapsed().as_secs_f64();
        if let Some(seen) = seen {
            member.p = member.p.min(seen.p / part);
        }
        member.looks += 1;
        // Where equality is claimed, a bias within the bounds is one, too.
        member.last = Some(seen.map(|seen| {
            if seen.p <= granted {
                Verdict::Differs
            } else {
                seen.verdict
            }
        }));
    }

    /// Corrects over all members.
    fn decide(mut self) -> Vec<(usize, Decision)> {
        for member in &self.members {
            // What broke keeps the p-value of 1 it was declared with.
            if matches!(member.last, Some(Some(_))) {
                let _ = self.family.record(member.hypothesis, member.p.min(1.0));
            }
        }
        let decisions = self.family.decide();
        let levels = self.levels;
        let members = self.members.into_iter();
        members
            .map(|member| {
                let corrected = &decisions[member.hypothesis];
                let seen = member.last.flatten();
                let verdict = seen.map(|verdict| match verdict {
                    _ if corrected.rejected => Verdict::Differs,
                    Verdict::Agrees => Verdict::Agrees,
                    Verdict::Differs | Verdict::Undecided => Verdict::Undecided,
                });
                let decision = Decision {
                    verdict,
                    in_doubt: !corrected.rejected && seen == Some(Verdict::Differs),
                    p_corrected: verdict.map(|_| corrected.adjusted),
                    looks: member.looks,
                    level: levels[member.looks.saturating_sub(1)],
                    seconds: member.seconds,
                };
                (member.place, decision)
            })
            .collect()
    }
}

/// Decides all comparisons of a run together, except those made elsewhere. Sound ones have the looks of
/// `looks`, mutants those of [`MUTANT_LOOKS`]. `make` makes a look, or returns `None` if that is
/// impossible.
///
/// # Errors
/// If the plan of the run makes no sense.
pub fn decide(
    questions: &[Question],
    looks: &'static [Multiple],
    mut make: impl FnMut(Stage) -> Option<Seen>,
    mut watch: impl FnMut(&Progress),
) -> Result<Vec<Decision>, String> {
    let start = Instant::now();
    let of = |mutants: bool| {
        let all = questions.iter().enumerate();
        all.filter(move |(_, question)| question.is_mutant == mutants)
    };
    let mut groups = [
        Group::new(of(false), looks, FALSE_POSITIVE_LEVEL)?,
        Group::new(of(true), MUTANT_LOOKS, ALPHA)?,
    ];
    let most = groups.iter().map(|group| group.looks.len()).max();
    for look in 0..most.unwrap_or(0) {
        let mut open: Vec<(usize, usize)> = (groups.iter().enumerate())
            .filter(|(_, group)| look < group.looks.len())
            .flat_map(|(number, group)| group.open().into_iter().map(move |i| (number, i)))
            .collect();
        // In their order, as neighbours share what is rendered.
        open.sort_by_key(|(number, index)| groups[*number].members[*index].place);
        let work = |groups: &[Group; 2], (group, index): (usize, usize)| -> f64 {
            let group: &Group = &groups[group];
            let before = if look > 0 {
                group.looks[look - 1]
            } else {
                Multiple::ZERO
            };
            let more = group.looks[look].factor() - before.factor();
            more * group.members[index].cost
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
            watch(&Progress {
                place: groups[group].members[index].place,
                look: look + 1,
                done,
                total: open.len(),
                elapsed: start.elapsed(),
                remaining: rest,
            });
            groups[group].look(index, look, &mut make);
            finished += own;
        }
    }
    let mut decisions: Vec<(usize, Decision)> =
        groups.into_iter().flat_map(Group::decide).collect();
    decisions.sort_by_key(|(place, _)| *place);
    Ok(decisions
        .into_iter()
        .map(|(_, decision)| decision)
        .collect())
}
