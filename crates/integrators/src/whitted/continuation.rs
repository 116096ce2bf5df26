//! Rays that leave a surface in a direction of their own.

use glam::{Vec3, Vec4};

/// A ray that leaves a surface in a direction of its own.
#[derive(Clone, Copy, Debug)]
pub struct Continuation {
    /// Its direction.
    pub wi: Vec3,
    /// The weight of the radiance along it, per lane; zero for lanes with another direction than lane 0.
    pub value: Vec4,
    /// Zero for lanes that go elsewhere, or nowhere.
    pub together: Vec4,
    /// Whether it is the null interaction.
    pub is_straight: bool,
}
