//! Statistics for testing simulations against each other: exact accumulators, hypothesis and
//! equivalence tests, multiplicity, power, group-sequential plans, resampling, image metrics.
//!
//! This crate knows nothing of light: it sums numbers exactly ([`Fixed128`], [`AtomicFixed128`],
//! [`Moments`]), describes samples of independent replicates ([`Summary`]), and decides with stated
//! error rates whether they agree ([`Estimate`], [`Family`], [`tiles`]).
//!
#![doc = include_str!("../README.md")]

pub mod atomic;
pub mod bootstrap;
pub mod boundaries;
pub mod chi_squared;
pub mod e_value;
pub mod estimate;
pub mod family;
pub mod fault;
pub mod fixed128;
pub mod flip;
pub mod interval;
pub mod judgement;
pub mod line;
pub mod lowered;
pub mod metrics;
pub mod moments;
pub mod noncentral_t;
pub mod normal;
pub mod picture;
pub mod power;
pub mod proportion;
mod quadrature;
mod random;
pub mod ratio;
pub mod resampling_test;
mod scale_error;
pub mod sign_flip;
pub mod spending;
pub mod student_t;
pub mod studentised;
pub mod summary;
pub mod tails;
pub mod tiles;
pub mod u256;
pub mod verdict;

pub use atomic::AtomicFixed128;
pub use boundaries::{Boundaries, LookError};
pub use estimate::Estimate;
pub use family::{Decision, Family};
pub use fault::{Faults, InvalidValue};
pub use fixed128::Fixed128;
pub use interval::Interval;
pub use judgement::Judgement;
pub use line::{Line, LineWithErrors};
pub use moments::Moments;
pub use picture::{Picture, PictureError};
pub use ratio::Ratio;
pub use resampling_test::ResamplingTest;
pub use spending::Spending;
pub use summary::Summary;
pub use tails::Tails;
pub use tiles::{Replicates, TileDecision, TileDifferences, TilesError};
pub use u256::U256;
pub use verdict::Verdict;
