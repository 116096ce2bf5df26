//! Estimators in a world of parallel planes, held against exact radiances.
//!
//! Planes reflect into lobes that differ from wavelength to wavelength, let light pass with a
//! transmittance that does, and glow. However wild the lobes are, they are normalised for every
//! direction of view, and what glows does so alike in all directions: so the radiance between two
//! planes depends only on whether it travels up or down, and a recursion over segments gives it
//! exactly, for any limit on the length of paths. See [`exact`].

mod agreement;
mod camera_1d;
mod channels;
mod exact;
mod guided;
mod lanes;
mod loops;
mod measure;
mod naive;
mod recursive;
mod rolling;
mod scatter;
mod tally;
mod together;
mod trees;
mod visibility;
mod world;
