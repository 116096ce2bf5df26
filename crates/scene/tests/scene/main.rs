//! From scene files to compiled scenes: defaults, sharing, lights, instances, surfaces that let
//! light pass, settings of samplers, and what is said of mistakes.

mod attributes;
mod compiled;
mod darkness;
mod lanes;
mod media;
mod mistakes;
mod passing;
mod reading;
mod rolling;
