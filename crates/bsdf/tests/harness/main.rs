//! Holds every scattering model to account, by the exemplars it names.
//!
//! Sampling against density (χ², determinant), values against densities and against quadrature,
//! lanes against one another, radiance against importance, energy, and all of it against
//! Mitsuba's own numbers. Models that are wrong on purpose show that each test can fail.

mod adjoint;
mod descriptions;
mod determinant;
mod directions;
mod discrete;
mod ends;
mod energy;
mod flattening;
mod lanes;
mod mitsuba;
mod mutants;
mod notation;
mod pointwise;
mod relief;
mod reversal;
mod scene;
mod sphere;
mod statistical;
mod tables;
mod walk_limits;
mod walks;
