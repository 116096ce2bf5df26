//! Rendering as a library: from a scene file to an image, and from images to a verdict.
//!
//! [`pipeline`] is the way from a scene file to an image, [`judge`] decides whether two images agree, [`decide`] whether
//! many comparisons hold together, [`estimators`] compares estimators, [`report`] makes pages. Nothing here prints or holds
//! global state: the binary, the validation and bindings are thin layers around it.

pub mod adaptive;
pub mod checkpointing;
pub mod compared;
pub mod decide;
pub mod denoise;
pub mod estimators;
mod exact_image;
pub mod features;
mod first_half;
pub mod judge;
pub mod load_options;
pub mod loaded;
pub mod machine;
pub mod memory;
pub mod metrics;
mod more_samples;
mod objections;
pub mod part;
pub mod pilot;
pub mod pipeline;
pub mod report;
pub mod resources;
pub mod scene_hash;
pub mod seeds;
mod sizes;
pub mod target;
pub mod tolerance;
pub mod watcher;
pub mod write_guard;

/// The version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
