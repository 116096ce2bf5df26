//! What was found of a program, as JSON and as a table.

use crate::judge::{Finding, Verdict};
use crate::mode::Mode;
use crate::plan::Plan;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// The version of the JSON.
pub const VERSION: u32 = 2;

/// What was found of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// [`VERSION`].
    pub version: u32,
    /// What was asked.
    pub plan: Plan,
    /// Whether a seed gave the same picture twice, if that was asked.
    pub seed_repeats: Option<bool>,
    /// A row for each question.
    pub rows: Vec<Row>,
}

/// What is said of a program whose pictures depend on more than the seed.
pub const SEED_DOES_NOT_REPEAT: &str =
    "The same seed gave another picture: this program's pictures cannot be repeated.";

/// What was found of a question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Its name.
    pub question: String,
    /// What was found.
    #[serde(flatten)]
    pub finding: Finding,
}

/// How a run ended, by the worst of its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conclusion {
    /// The program agrees in all that it can express.
    Agrees,
    /// It differs.
    Differs,
    /// Something could not be judged.
    Broken,
    /// Something is undecided, or the program can express nothing.
    Undecided,
}

impl Conclusion {
    /// The exit code, as that of `cargo xtask validate`.
    fn exit_code(self) -> u8 {
        match self {
            Self::Agrees => 0,
            Self::Differs => 1,
            Self::Broken => 2,
            Self::Undecided => 3,
        }
    }
}

impl Verdict {
    /// In a word or two.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::Undecided(_) => "undecided",
            Self::NotSupported(_) => "not supported",
            Self::Broken(_) => "broken",
        }
    }

    /// Why, if it says so.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Undecided(why) | Self::NotSupported(why) | Self::Broken(why) => Some(why),
            Self::Agrees | Self::Differs => None,
        }
    }
}

impl Report {
    /// How many questions have the verdict of this word.
    pub fn count(&self, word: &str) -> usize {
        let rows = self.rows.iter();
        rows.filter(|row| row.finding.verdict.word() == word)
            .count()
    }

    /// How the run ended.
    pub fn conclusion(&self) -> Conclusion {
        let worst = [
            ("differs", Conclusion::Differs),
            ("broken", Conclusion::Broken),
            ("undecided", Conclusion::Undecided),
        ];
        let mut found = worst.iter().filter(|(word, _)| self.count(word) > 0);
        match found.next() {
            Some((_, conclusion)) => *conclusion,
            None if self.count("agrees") > 0 => Conclusion::Agrees,
            None => Conclusion::Undecided,
        }
    }

    /// The exit code of a run: that of its conclusion, but what a program ships decides nothing.
    pub fn exit_code(&self) -> u8 {
        let conclusion = match (self.plan.mode, self.conclusion()) {
            (Mode::Shipped, Conclusion::Differs | Conclusion::Undecided) => Conclusion::Agrees,
            (_, conclusion) => conclusion,
        };
        conclusion.exit_code()
    }

    /// As a table, with a line of counts.
    pub fn table(&self) -> String {
        let width = self
            .rows
            .iter()
            .map(|row| row.question.len())
            .max()
            .unwrap_or(0);
        let mut text = format!(
            "{} ({}), {}, within {} %\n\n",
            self.plan.title,
            self.plan.program_version,
            match self.rows.len() {
                1 => "1 question".to_owned(),
                count => format!("{count} questions"),
            },
            100.0 * self.plan.bound
        );
        for row in &self.rows {
            let finding = &row.finding;
            let value = match (finding.bias, finding.interval) {
                (Some(bias), Some([low, high])) => {
                    format!("{:+9.3} % ± {:.3}", 100.0 * bias, 50.0 * (high - low))
                }
                (Some(bias), None) => format!("{:+9.3} %", 100.0 * bias),
                _ => String::new(),
            };
            let _ = write!(
                text,
                "{:width$}  {:13}  {value:24}",
                row.question,
                finding.verdict.word()
            );
            // Where the mean is off, tiles are as well.
            let of_shape = finding
                .bias
                .is_some_and(|bias| bias.abs() <= self.plan.bound);
            let tile = || {
                let (column, row, _) = finding.tile.filter(|_| of_shape)?;
                Some(format!("most in the tile of column {column}, row {row}"))
            };
            let reason = finding.verdict.reason().map(str::to_owned);
            let looks = finding.suspicion.clone().or_else(tile);
            let more = finding.refinement.as_ref().map(|refinement| {
                let trend = refinement.trend.map(|trend| format!(": {}", trend.words()));
                let bias = 100.0 * refinement.bias;
                format!(
                    "{bias:+.3} % with 4 × the samples{}",
                    trend.unwrap_or_default()
                )
            });
            let told = more.filter(|_| finding.verdict != Verdict::Agrees);
            let reason: Vec<String> = reason.into_iter().chain(looks).chain(told).collect();
            let _ = writeln!(text, "{}", reason.join("; "));
        }
        let words = ["agrees", "differs", "undecided", "not supported", "broken"];
        let counts = words.map(|word| (self.count(word), word));
        let counts = counts.iter().filter(|(count, _)| *count > 0);
        let counts: Vec<_> = counts
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        let _ = writeln!(text, "\n{}", counts.join(", "));
        if self.seed_repeats == Some(false) {
            let _ = writeln!(text, "{SEED_DOES_NOT_REPEAT}");
        }
        text.lines()
            .map(str::trim_end)
            .collect::<Vec<_>>()
            .join("\n")
            + "\n"
    }

    /// As JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("names and numbers")
    }
}
