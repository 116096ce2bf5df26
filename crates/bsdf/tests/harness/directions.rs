//! Directions and uniform numbers for the tests: always the same ones.

use glam::{Vec2, Vec3};

/// A stream of uniform numbers (SplitMix64; Steele, Lea & Flood 2014).
pub(crate) struct Uniform(u64);

impl Uniform {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// In [0, 1), with 24 bits.
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    pub(crate) fn pair(&mut self) -> Vec2 {
        Vec2::new(self.next(), self.next())
    }

    /// Uniform over the sphere.
    pub(crate) fn direction(&mut self) -> Vec3 {
        etalon_sampling::warps::square_to_uniform_sphere(self.pair())
    }
}

/// The direction at `degrees` from the normal.
pub(crate) fn at(degrees: f32, azimuth: f32) -> Vec3 {
    let (sin, cos) = etalon_math::float::sin_cos(degrees.to_radians());
    let (y, x) = etalon_math::float::sin_cos(azimuth);
    Vec3::new(sin * x, sin * y, cos)
}

/// Known directions from steep to grazing on the front, and one behind.
pub(crate) fn known() -> [Vec3; 4] {
    [at(5.0, 1.0), at(50.0, 4.0), at(80.0, 2.5), at(125.0, 0.3)]
}
