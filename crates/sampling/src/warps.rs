//! Maps from the unit square (or interval) to other domains, with their inverses and densities.
//!
//! Each map takes uniform numbers in [0, 1) and is continuous wherever its domain allows, so
//! that stratified numbers give stratified results. For each, three functions agree:
//!
//! * the map, `square_to_…` or `interval_to_…`;
//! * its inverse, `…_to_square` or `…_to_interval`;
//! * the density of its results, `…_density`, equal to one over the Jacobian of the map: per unit
//!   of area, solid angle (sr) or length, as each says.
//!
//! Domains that depend on more than a number or two are types ([`SphericalTriangle`],
//! [`SphericalRectangle`], [`RectangleView`], [`SphereCone`]) with methods `sample`, `invert` and `density`.
//! Their constructors return `None` where sampling by solid angle would be ill-conditioned;
//! the condition depends on the geometry alone, so that `sample` and `density` of one light
//! always use the same technique.
//!
//! Directions are in a local frame with the axis along +z.

mod cap;
mod disk;
mod hemisphere;
mod line;
mod normal;
mod rectangle_view;
mod sphere_cone;
mod spherical_rectangle;
mod spherical_triangle;
mod triangle;

pub use cap::{
    UNIFORM_HEMISPHERE_DENSITY, UNIFORM_SPHERE_DENSITY, sphere_to_square, square_to_uniform_cone,
    square_to_uniform_hemisphere, square_to_uniform_sphere, uniform_cone_density,
    uniform_cone_to_square, uniform_hemisphere_to_square, uniform_sphere, uniform_sphere_to_square,
};
pub use disk::{
    CONCENTRIC_DISK_DENSITY, concentric_disk, concentric_disk_to_square, square_to_concentric_disk,
};
pub use hemisphere::{
    cosine_density, cosine_hemisphere, cosine_hemisphere_density, cosine_hemisphere_to_square,
    square_to_cosine_hemisphere,
};
pub use line::{
    interval_to_linear, interval_to_tent, linear_density, linear_to_interval, tent_density,
    tent_to_interval,
};
pub use normal::{
    inverse_normal_cdf, normal_cdf, normal_density, square_to_normal, standard_normal_density,
};
pub use rectangle_view::RectangleView;
pub use sphere_cone::SphereCone;
pub use spherical_rectangle::{RectangleSides, SphericalRectangle};
pub use spherical_triangle::SphericalTriangle;
pub use triangle::{square_to_triangle, triangle_density, triangle_to_square};
