//! Estimators of light transport, one file each, and the loop that runs them.
//!
//! Nothing concrete is named here: no material, shape, light or film. Estimators know a scene only as
//! a [`etalon_transport::World`], so each can be tested in a world without geometry.
//!
//! Adding an estimator: its file, its module below, and one line in [`list`].

pub mod ao;
pub mod aov;
pub mod bdpt;
mod camera_ray;
mod candidates;
pub mod depth;
pub mod dimensions;
pub mod direct;
pub mod distribution;
mod equiangular;
pub mod forward;
pub mod guided;
mod light_mis;
pub mod list;
pub mod metropolis;
pub mod mmlt;
pub mod moment;
pub mod naive;
mod particle;
pub mod path;
mod path_diffusion;
mod path_hooks;
mod path_media;
mod path_state;
pub mod path_throughput;
pub mod photonmap;
pub mod photons;
mod positions;
pub mod pssmlt;
pub mod ptracer;
pub mod render;
mod render_plan;
pub mod replay;
mod rounds;
pub mod settings;
mod share;
pub mod signature;
pub mod sppm;
mod steps;
pub mod vcm;
mod visibility;
pub mod whitted;

pub use list::{AnyIntegrator, names};
pub use render::{Progress, RenderStatistics, render};
pub use render_plan::RenderPlan;
pub use share::ReplicateRange;
