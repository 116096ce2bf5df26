//! Chains on small problems with exact answers.

mod expectation;
mod steps;
