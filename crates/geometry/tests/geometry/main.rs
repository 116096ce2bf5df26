//! Intersection, spawning and sampling of whole geometries.

mod accelerators;
mod description;
mod instances;
mod normals;
mod reintersection;
mod sampling;
mod things;
mod watertight;
