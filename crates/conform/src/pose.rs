//! Where a scene stands: turned, grown and moved at random, so that no program can owe its answer to round numbers.
//!
//! Faults of rounding hide from seeds: they are the same in all of them. A program without random numbers has no other
//! replicates than these.

use etalon_math::float64::{cos, sin};
use glam::{DMat3, DQuat, DVec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// A rotation, then a scale, then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The rotation.
    pub rotation: DMat3,
    /// The factor on lengths.
    pub scale: f64,
    /// The shift (m).
    pub shift: DVec3,
}

/// How freely a scene may be posed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// In every way.
    Any,
    /// In every way, and anew for each picture: for faults that depend on how sizes are rounded.
    EachAnew,
    /// Its origin stays where it is, for scenes with things so small there that single precision cannot hold their corners
    /// elsewhere.
    AboutOrigin,
}

impl Pose {
    /// As the scene is written.
    pub const AS_IS: Self = Self {
        rotation: DMat3::IDENTITY,
        scale: 1.0,
        shift: DVec3::ZERO,
    };

    /// Pose number `index` of a suite's seed: a rotation evenly among all, a scale from 1/2 to 2, a shift of up to a metre along
    /// each axis.
    pub fn draw(seed: u64, index: u32, freedom: Freedom) -> Self {
        let mut random = Pcg64Mcg::seed_from_u64(seed ^ (u64::from(index) << 32 | 0x9e37_79b9));
        let mut next = || random.random::<f64>();
        // A quaternion evenly on its sphere (Shoemake 1992, "Uniform random rotations").
        let (u, a, b) = (next(), TAU * next(), TAU * next());
        let (first, second) = ((1.0 - u).sqrt(), u.sqrt());
        let turn = DQuat::from_xyzw(
            first * sin(a),
            first * cos(a),
            second * sin(b),
            second * cos(b),
        );
        let scale = etalon_math::float64::pow(2.0, 2.0 * next() - 1.0);
        let shift = DVec3::new(next(), next(), next()) * 2.0 - 1.0;
        Self {
            rotation: DMat3::from_quat(turn.normalize()),
            scale,
            shift: match freedom {
                Freedom::Any | Freedom::EachAnew => shift,
                Freedom::AboutOrigin => DVec3::ZERO,
            },
        }
    }

    /// Where a point goes.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.vector(point) + self.shift
    }

    /// Where the difference of two points goes.
    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.direction(vector) * self.scale
    }

    /// Where a direction goes.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }
}
