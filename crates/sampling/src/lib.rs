//! Samplers, random streams, low-discrepancy sequences, warps, discrete and piecewise
//! distributions, and multiple importance sampling.
//!
//! Everything random in an image begins here, and everything here is a pure function of
//! (seed, replicate, pixel, sample, dimension): see [`SampleId`].

pub mod discrete;
pub mod hash;
pub mod henyey_greenstein;
pub mod independent;
pub mod kind;
pub mod latitude_longitude;
pub mod replicate_kind;
pub mod sampler;
pub mod sobol;
pub mod stratified;
pub mod stratified_pair;
pub mod warps;

pub use independent::Independent;
pub use kind::{AnySampler, SamplerKind};
pub use replicate_kind::ReplicateKind;
pub use sampler::{SampleId, Sampler};
pub use sobol::Sobol;
pub use stratified::Stratified;
pub use stratified_pair::stratified_pair;
