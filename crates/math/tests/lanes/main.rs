//! Lanes: equal bits at every width, and the errors of elementary functions.

mod accuracy;
mod geometry;
mod widths;
