//! Geometry-free mathematics of the renderer: frames, cones, transforms, densities that carry their
//! measure, error-bounded offsets, polynomial roots and reproducible elementary functions, and SIMD lanes.
//!
//! Nothing here knows of light.

pub mod animated;
pub mod bernstein;
pub mod bessel_k0;
pub mod bracket;
pub mod cone;
pub mod cross;
pub mod density;
pub mod equal_area;
pub mod expression;
pub mod float;
pub mod float64;
pub mod frame;
pub mod fresnel;
pub mod keyframes;
pub mod lane;
pub mod motion;
pub mod noise;
pub mod offset;
mod parts;
pub mod polynomial;
pub mod reflection;
mod swept;
pub mod transform;

pub use animated::{Animated, FromAffine};
pub use bessel_k0::bessel_k0;
pub use bracket::Bracket;
pub use cone::DirectionCone;
pub use cross::{cross, difference_of_products};
pub use density::{Area, DeltaProbability, Density, Length, Measure, SolidAngle};
pub use expression::{Dual, Expression, Interval};
pub use frame::Frame;
pub use glam::{DMat4, DVec2, DVec3, Mat4, Vec2, Vec3, Vec4};
pub use keyframes::{Interpolation, Key, Keyframes};
pub use motion::{Motion, MotionError, MotionKey};
pub use offset::{gamma, offset_origin};
pub use transform::Transform;
