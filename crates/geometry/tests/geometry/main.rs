//! Intersection, spawning and sampling of whole geometries.

mod accelerators;
mod bilinear;
mod commotion;
mod curve_files;
mod curves;
mod deformed_lamps;
mod description;
mod drawn_curves;
mod ellipsoids;
mod far_lights;
mod files;
mod functions;
mod grids;
mod instances;
mod lane_surfaces;
mod nets;
mod normals;
mod packets;
mod plane;
mod reintersection;
mod sampling;
mod shells;
mod solids;
mod things;
mod touching;
mod watertight;
