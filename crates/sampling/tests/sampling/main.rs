//! Samplers, warps and distributions against their definitions and by statistical tests.
//!
//! One binary, as each takes its time to link; one concern per file.

mod discrete;
mod evidence;
mod hash;
mod quadtree;
mod samplers;
mod sobol;
mod solid_angles;
mod warps;
