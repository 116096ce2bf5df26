//! The film: what it estimates, its exactness, its files and parts.
//!
//! One binary, as each takes its time to link; one concern per file.

mod exactness;
mod expectation;
mod files;
mod filters;
mod glance;
mod parts;
mod replicates;
mod settings;
mod sharing;
mod uneven;
