//! Etalon: a spectral renderer whose estimators are held to account by statistics.
//!
//! The library behind the `etalon` binary: [`pipeline`] is the way from a scene file to an
//! image; the commands are thin around it.

pub mod adaptive;
pub mod arg_values;
pub mod args;
pub mod checkpointing;
pub mod commands;
pub mod diagnose;
pub mod estimators;
pub mod farm;
pub mod frames;
pub mod interrupt;
pub mod judge;
mod memory;
mod objections;
pub mod outputs;
pub mod part;
pub mod pipeline;
pub mod progress;
mod quoting;
pub mod report;
pub mod resources;
pub mod say;
mod scene_hash;
mod sizes;
pub mod target;
pub mod tolerance;
pub mod write_guard;

/// The version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
