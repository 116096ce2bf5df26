//! Rays.

use glam::Vec3;

/// A half-line or segment, with the time at which it travels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts (m).
    pub origin: Vec3,
    /// Its unit direction.
    pub direction: Vec3,
    /// Its length (m); infinite for a half-line. Hits lie strictly between 0 and `t_max`.
    pub t_max: f32,
    /// The moment within the shutter interval, from 0 (opening) to 1 (closing).
    pub time: f32,
}

impl Ray {
    /// A half-line.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3, time: f32) -> Self {
        Self {
            origin,
            direction,
            t_max: f32::INFINITY,
            time,
        }
    }

    /// The segment between two points that are both already off any surface; it ends a few
    /// roundings short of `to`. `None` if the points coincide.
    #[inline]
    pub fn between(from: Vec3, to: Vec3, time: f32) -> Option<Self> {
        let d = to - from;
        let distance = d.length();
        (distance > 0.0).then(|| Self {
            origin: from,
            direction: d / distance,
            t_max: distance * (1.0 - 8.0 * f32::EPSILON),
            time,
        })
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
