//! Shapes, instances and accelerators.
//!
//! A [`Shape`] is made from its description ([`Shape::from_params`]); a [`GeometryBuilder`]
//! collects shapes, groups and instances; a [`Geometry`] answers what a ray hits
//! ([`Geometry::intersect`], [`Geometry::occluded`]), what is known of that point
//! ([`Geometry::vertex`]), and how points on lights are chosen
//! ([`Shapes`](etalon_transport::Shapes)).
//!
//! Accelerators hold triangles of all shapes in one tree; a group has a tree of its own that all
//! its instances share.

pub mod accelerator;
pub mod builder;
pub mod geometry;
mod nearest;
pub mod placement;
mod probe;
mod scope;
pub mod shapes;
mod surface;
mod touching;
mod world;

pub use accelerator::{AcceleratorKind, Bounds};
pub use builder::{GeometryBuilder, GroupId};
pub use geometry::{Geometry, GeometryStatistics};
pub use placement::Placement;
pub use shapes::Shape;
