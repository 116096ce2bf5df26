//! Which estimator is better on this scene, by how much, and how sure is that? The measurement
//! behind `etalon estimators`.
//!
//! An *estimator* is an integrator with a sampler and a reconstruction filter ([`EstimatorConfig`]). With
//! relMSE the squared error of one picture against a converged reference
//! ([`etalon_statistics::metrics`]) and T the wall-clock time that picture took,
//!
//! efficiency = 1 / (relMSE · T),
//!
//! so bias counts as noise does: a wrong estimator is not efficient. Every estimator renders many
//! independent pictures, at sizes and in numbers that a short pilot fixes before the measured run
//! ([`schedule`]): nothing is stopped, or continued, because of what was seen.
//!
//! - *Equal time*: every estimator takes the samples per pixel that its share of the time allows.
//! - *Equal samples*: the largest number of samples per pixel that all have in their ladders.
//! - *Convergence*: a ladder of sizes, and the exponent of the squared error along it.
//!
//! Pictures of all estimators alternate, so that a machine which slows down slows all of them.
//!
//! ```no_run
//! use etalon_render::estimators::{Options, Trial};
//!
//! let options = Options {
//!     integrators: vec!["path".to_owned(), "ptracer".to_owned()],
//!     seconds: 20.0,
//!     ..Options::default()
//! };
//! let trial = Trial::prepare("scene.xml".as_ref(), &options)?;
//! let findings = trial.run(&())?;
//! for row in &findings.estimators {
//!     println!("{}: {:?}", row.name, row.efficiency.value);
//! }
//! # Ok::<(), etalon_render::estimators::Failure>(())
//! ```

pub mod analysis;
pub mod cell;
pub mod estimator_config;
pub mod findings;
pub mod options;
pub mod page;
pub mod reference;
pub mod remarks;
pub mod schedule;
pub mod table;
pub mod trial;

pub use estimator_config::EstimatorConfig;
pub use findings::{Findings, Row};
pub use options::Options;
pub use reference::Reference;
pub use schedule::Schedule;
pub use trial::{Failure, Trial};

/// The confidence of every interval. Those of mean differences hold together, over all estimators
/// and channels (Bonferroni); every other one by itself.
pub const CONFIDENCE: f64 = 0.95;
