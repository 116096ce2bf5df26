//! Estimators of light transport, one file each, and the loop that runs them.
//!
//! Nothing concrete is named here: no material, shape, light or film. Estimators know a scene only as
//! a [`etalon_transport::World`], so each can be tested in a world without geometry.
//!
//! The files and folders here are estimators, except for three: `steps` are what they share, `render` is the loop, and [`replay`]
//! tells how a sample came about. Adding an estimator: its file, its module below, and one line in [`list`].

pub mod ao;
pub mod aov;
pub mod bdpt;
pub mod depth;
pub mod direct;
pub mod distribution;
pub mod field;
pub mod forward;
pub mod guided;
pub mod list;
pub mod metropolis;
pub mod moment;
pub mod naive;
pub mod path;
pub mod photons;
pub mod ptracer;
pub mod render;
pub mod replay;
mod steps;
pub mod vcm;
pub mod whitted;

pub use list::{AnyIntegrator, names};
pub use metropolis::{mmlt, pssmlt};
pub use photons::{photonmap, sppm};
pub use render::{Progress, RenderPlan, RenderStatistics, ReplicateRange, render, signature};
pub use steps::{dimensions, path_throughput, settings};
