//! Numbers for scenes and rays, the same in every run.

use etalon_math::{Vec2, Vec3};

/// Uniform numbers from a counter: SplitMix64 (Steele, Lea & Flood 2014, "Fast Splittable Pseudorandom Number
/// Generators").
pub struct Random(pub u64);

impl Random {
    /// A number in [0, 1).
    pub fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    }

    /// A point in the unit square.
    pub fn square(&mut self) -> Vec2 {
        Vec2::new(self.number(), self.number())
    }

    /// A point in the cube from −1 to 1.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number()) * 2.0 - 1.0
    }

    /// The same things in another order (Fisher and Yates).
    pub fn shuffle<T>(&mut self, things: &mut [T]) {
        for last in (1..things.len()).rev() {
            things.swap(last, (self.number() * (last + 1) as f32) as usize);
        }
    }
}
