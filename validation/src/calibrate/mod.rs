//! Are the error rates of the validation what they are said to be? `cargo xtask calibrate`.
//!
//! Two experiments in which the null hypothesis is known to hold:
//!
//! - [`null`]: the whole decision of a run, thousands of times, on replicates of one estimator
//!   dealt anew each time ([`pool`]). Nothing is wrong, so every failure is a false alarm, and those may come
//!   at the rate [`etalon_render::decide::decision::FALSE_POSITIVE_LEVEL`] at most.
//! - [`single`]: one question at a time between fresh renders: its p-values must be uniform, it
//!   must raise its alarm as often as its level says, and its intervals must cover.
//!
//! What must hold is written down here, before anything is run.

pub mod null;
pub mod page;
pub mod pool;
pub mod question;
pub mod single;
pub mod verdict;

/// Null runs of the whole decision.
pub const NULL_RUNS: u32 = 3000;

/// The greatest share of the null runs that may leave one comparison undecided.
pub const MOST_UNDECIDED: f64 = 0.99;

/// Repetitions of a single comparison.
pub const REPETITIONS: u32 = 1000;

/// The level whose alarms are counted in single comparisons.
pub const LEVEL: f64 = 0.01;

/// Between which rates alarms at [`LEVEL`] must lie.
pub const ALARMS: [f64; 2] = [0.004, 0.018];

/// The confidence of the intervals of all rates together that are held against a promise.
pub const CONFIDENCE: f64 = 0.99;

/// The levels of the intervals whose coverage is counted.
pub const COVERAGES: [f64; 3] = [0.68, 0.95, 0.99];

/// The channel that single questions are about.
const CHANNEL: &str = "G";
