//! Tests and estimates against published numbers, exact distributions and simulation.
//!
//! One binary, as each takes its time to link; one concern per file.

mod calibration;
mod checks;
mod decisions;
mod distributions;
mod exact;
mod group_sequential;
mod lowered;
mod metrics;
mod moments;
mod power;
mod regression;
mod resampling;
mod tails;
