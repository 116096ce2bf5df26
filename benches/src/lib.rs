//! Accelerators side by side: scenes, rays, Embree as an opponent, and how they are timed.
//!
//! `cargo bench --bench accelerators` follows single cases over time; `cargo xtask accelerators` makes the table and
//! the page of all of them.

pub mod contender;
pub mod embree;
pub mod material;
pub mod random;
pub mod rays;
pub mod scenes;
pub mod stopwatch;
