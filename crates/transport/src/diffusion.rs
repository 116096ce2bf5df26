//! The contract of a diffusion profile: how light that has entered a surface leaves it nearby.
//!
//! ```text
//! S(xo, ωo, xi, ωi) = (1 − F(ωo)) R(|xo − xi|) S_w(ωi),   S_w(ω) = (1 − F(ω)) / (c π)
//! ```
//!
//! with R the flux that leaves per area at a point nearby, per flux that has entered, and c such that S_w has the mean 1
//! over diffuse light (M. Pharr, W. Jakob, G. Humphreys, Physically Based Rendering, 3rd ed. 2016, section 11.4).

use glam::{Vec3, Vec4};

/// A point where light leaves, as seen from where it entered: in a frame there whose z is the outward normal and whose x is along
/// ∂p/∂u.
#[derive(Clone, Copy, Debug)]
pub struct Exit {
    /// From the entry (m).
    pub offset: Vec3,
    /// The outward unit normal.
    pub normal: Vec3,
}

/// A profile at a path's wavelengths. Points are chosen by their distance, whatever else their light depends on.
pub trait DiffusionProfile {
    /// R (m⁻²) at a point, per lane.
    fn value(&self, exit: &Exit) -> Vec4;

    /// The density per area (m⁻²) with which [`DiffusionProfile::sample`] finds a point at a distance, for each lane had it been
    /// the one that chose.
    fn density(&self, distance: f32) -> Vec4;

    /// A distance by lane 0, for `u` in [0, 1); `None` if no light leaves.
    fn sample(&self, u: f32) -> Option<f32>;

    /// The distance (m) beyond which next to no light leaves.
    fn reach(&self) -> f32;

    /// S_w (sr⁻¹) for a direction with this cosine to the normal.
    fn leaving(&self, cos: f32) -> f32;

    /// The index inside over that outside.
    fn relative_index(&self) -> f32;
}

/// The profile of worlds that have none; there is no value of it.
#[derive(Clone, Copy, Debug)]
pub enum NoProfile {}

impl DiffusionProfile for NoProfile {
    fn value(&self, _: &Exit) -> Vec4 {
        match *self {}
    }

    fn density(&self, _: f32) -> Vec4 {
        match *self {}
    }

    fn sample(&self, _: f32) -> Option<f32> {
        match *self {}
    }

    fn reach(&self) -> f32 {
        match *self {}
    }

    fn leaving(&self, _: f32) -> f32 {
        match *self {}
    }

    fn relative_index(&self) -> f32 {
        match *self {}
    }
}
