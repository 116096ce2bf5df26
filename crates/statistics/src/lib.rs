//! Exact accumulators, moments, hypothesis and equivalence tests, multiplicity.
//!
//! This crate knows nothing of light: it sums numbers exactly, describes samples of independent
//! replicates, and decides with stated error rates whether two of them agree.

pub mod atomic;
pub mod exact;
pub mod fault;
pub mod moments;
pub mod summary;
pub mod wide;

pub use atomic::AtomicFixed128;
pub use exact::Fixed128;
pub use fault::{Fault, Faults};
pub use moments::Moments;
pub use summary::Summary;
pub use wide::U256;
