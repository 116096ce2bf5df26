//! Whether many comparisons hold, decided together with stated error rates.
//!
//! A picture is [`judged`] against a formula or another picture; [`measure`] does so for single
//! numbers, [`convergence`] for the fall of the error, [`pixelwise`] for pictures without noise.
//! [`decision`] looks at all comparisons of a suite until each is decided ([`looks`]) and corrects
//! over all of them. None of it knows where pictures come from: the caller renders them, reads them,
//! or has another program make them.

pub mod convergence;
pub mod decision;
pub mod judged;
pub mod looks;
pub mod measure;
pub mod pixelwise;
mod samples;
