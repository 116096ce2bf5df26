//! Shapes, instances and accelerators.
//!
//! A [`Shape`] is made from its description ([`Shape::from_params`]); a [`GeometryBuilder`]
//! collects shapes, groups and instances; a [`Geometry`] intersects rays
//! ([`Geometry::intersect`], [`Geometry::occluded`]), computes the vertex at a hit
//! ([`Geometry::vertex`]), and samples points on lights ([`Shapes`](etalon_transport::Shapes)).
//!
//! Accelerators hold triangles of all shapes in one tree; a group has a tree of its own that all
//! its instances share.

pub mod accelerator;
mod batch;
pub mod builder;
mod closest_hit;
pub mod geometry;
mod group_others;
mod instance;
mod lane_surfaces;
mod local_interaction;
mod moving_light;
mod piece;
pub mod placement;
mod primitive_index;
pub mod shapes;
mod touching;
mod traversal_ray;
mod world_others;

pub use accelerator::observer::{Obstruction, Visits};
pub use accelerator::{AcceleratorKind, Bounds};
pub use builder::GeometryBuilder;
pub use geometry::{Geometry, GeometryStatistics};
pub use instance::GroupId;
pub use placement::Placement;
pub use shapes::Shape;
pub use shapes::curves::control_points;
pub use shapes::mesh::file_mesh::mesh_format;
