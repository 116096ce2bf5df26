//! Etalon: a spectral renderer whose estimators are held to account by statistics.
//!
//! What is around [`etalon_render`]: the command line, what is printed, and signals.

pub mod arg_values;
pub mod args;
pub mod commands;
pub mod diagnose;
pub mod farm;
pub mod frames;
pub mod interrupt;
pub mod outputs;
pub mod preview;
pub mod progress;
mod quoting;
pub mod say;
pub mod version;

pub use etalon_render::VERSION;
