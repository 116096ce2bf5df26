//! Rays.

use crate::{MediumId, ShapeId};
use etalon_math::lane::{Lane, Vector};
use etalon_sampling::Independent;
use etalon_sampling::hash::mix64;
use glam::Vec3;

/// Where a ray crosses the surface that it leaves, behind its origin.
///
/// Rays start a little off their surface, so that they do not hit it again. A second surface may
/// lie in between, closer than single precision resolves: a crossing after `t` counts as ahead of
/// the ray if it belongs to another shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    /// The shape that is left.
    pub shape: ShapeId,
    /// Its primitive.
    pub primitive: u32,
    /// The parameter of the crossing, not above 0.
    pub t: f32,
}

impl Departure {
    /// From no surface, or from one that is not known to more than single precision.
    pub const NONE: Self = Self {
        shape: ShapeId::NONE,
        primitive: 0,
        t: 0.0,
    };
}

/// Unit directions and lengths (m) of segments between points that are off any surface, a few roundings short of `to`; the lanes
/// where the two do not coincide.
#[inline(always)]
pub(crate) fn segments<F: Lane>(from: F::Vector, to: F::Vector) -> (F::Vector, F, F::Mask) {
    let way = to - from;
    let distance = way.norm();
    let exists = distance.gt(F::ZERO);
    (
        way.over(distance),
        distance * (1.0 - 8.0 * f32::EPSILON),
        exists,
    )
}

/// A half-line or segment, with the time at which it travels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin (m).
    pub origin: Vec3,
    /// Its unit direction.
    pub direction: Vec3,
    /// Its length (m); infinite for a half-line. Hits lie strictly between 0 and `t_max`.
    pub t_max: f32,
    /// The moment within the shutter interval, from 0 (opening) to 1 (closing).
    pub time: f32,
    /// The surface that it leaves.
    pub departure: Departure,
    /// The medium that it travels in.
    pub medium: MediumId,
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
            departure: Departure::NONE,
            medium: MediumId::NONE,
        }
    }

    /// The segment between two points that are both already off any surface; it ends a few
    /// roundings short of `to`. `None` if the points coincide.
    #[inline]
    pub fn between(from: Vec3, to: Vec3, time: f32) -> Option<Self> {
        let (direction, t_max, exists) = segments::<f32>(from, to);
        exists.then_some(Self {
            origin: from,
            direction,
            t_max,
            time,
            departure: Departure::NONE,
            medium: MediumId::NONE,
        })
    }

    /// A stream of random numbers for tracking along the ray, seeded by the bits of the ray and `u`.
    pub fn stream(&self, u: f32) -> Independent {
        let numbers = (self.origin.to_array().into_iter()).chain(self.direction.to_array());
        let key = |key, x: f32| mix64(key ^ u64::from(x.to_bits()));
        Independent::from_key(numbers.fold(u64::from(u.to_bits()), key))
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
