//! Orthonormal frames.
//!
//! In a local frame `z` is the normal, so that cos θ of a direction is its `z`.
//! Construction from one vector follows Duff, Burgess, Christensen, Hery, Kensler, Liani and
//! Villemin (2017), "Building an Orthonormal Basis, Revisited", JCGT 6(1), eq. 2.

use crate::lane::LaneFrame;
use glam::Vec3;

/// An orthonormal frame, right-handed (`s` × `t` = `n`) unless it is [`Frame::mirrored`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub s: Vec3,
    /// Second tangent.
    pub t: Vec3,
    /// Normal.
    pub n: Vec3,
}

impl Frame {
    /// The frame whose axes are x, y, z.
    pub const IDENTITY: Self = Self {
        s: Vec3::X,
        t: Vec3::Y,
        n: Vec3::Z,
    };

    /// Any frame with unit normal `n`.
    #[inline]
    pub fn from_normal(n: Vec3) -> Self {
        let LaneFrame { s, t, n } = LaneFrame::<f32>::from_normal(n);
        Self { s, t, n }
    }

    /// The frame with unit normal `n` whose first tangent is as near to `tangent` as it can be;
    /// any frame about `n` if the two are (nearly) parallel or `tangent` vanishes.
    #[inline(always)] // Where the caller needs no frame, nothing of it should be computed.
    pub fn from_normal_and_tangent(n: Vec3, tangent: Vec3) -> Self {
        let projected = tangent - n * n.dot(tangent);
        let length_squared = projected.length_squared();
        if !(length_squared > 1e-12 * tangent.length_squared()) || !length_squared.is_finite() {
            return Self::from_normal(n);
        }
        let mut s = projected / length_squared.sqrt();
        if length_squared < 0.1 * tangent.length_squared() {
            // Cancellation above left a remainder along n; remove it.
            s = (s - n * n.dot(s)).normalize();
        }
        Self {
            s,
            t: n.cross(s),
            n,
        }
    }

    /// Components of the world vector `v` in this frame.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.s.dot(v), self.t.dot(v), self.n.dot(v))
    }

    /// The world vector whose components in this frame are `v`.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.s * v.x + self.t * v.y + self.n * v.z
    }

    /// The same tangents about the opposite normal (left-handed tangents are swapped back by
    /// negating `t`, so the frame stays right-handed).
    #[inline]
    pub fn flipped(&self) -> Self {
        Self {
            s: self.s,
            t: -self.t,
            n: -self.n,
        }
    }

    /// The same tangents about the opposite normal: the mirror image, left-handed where this one is right-handed.
    #[inline]
    pub fn mirrored(&self) -> Self {
        Self {
            n: -self.n,
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn orthonormal(f: &Frame) -> bool {
        let e = 2e-6;
        (f.s.length() - 1.0).abs() < e
            && (f.t.length() - 1.0).abs() < e
            && f.s.dot(f.t).abs() < e
            && f.s.dot(f.n).abs() < e
            && (f.s.cross(f.t) - f.n).length() < 4.0 * e
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::with_cases(512) })]
        #[test]
        fn frames_are_right_handed_and_orthonormal(
            x in -1.0f32..1.0, y in -1.0f32..1.0, z in -1.0f32..1.0,
            tx in -1.0f32..1.0, ty in -1.0f32..1.0, tz in -1.0f32..1.0,
        ) {
            let n = Vec3::new(x, y, z);
            prop_assume!(n.length() > 1e-3);
            let n = n.normalize();
            prop_assert!(orthonormal(&Frame::from_normal(n)));
            prop_assert!(orthonormal(&Frame::from_normal_and_tangent(n, Vec3::new(tx, ty, tz))));
            prop_assert!(orthonormal(&Frame::from_normal(n).flipped()));
            let mirrored = Frame::from_normal(n).mirrored();
            prop_assert!((mirrored.s.cross(mirrored.t) + mirrored.n).length() < 1e-5);
        }
    }

    #[test]
    fn poles_and_parallel_tangents_are_no_special_case() {
        for n in [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_Y] {
            assert!(orthonormal(&Frame::from_normal(n)));
            assert!(orthonormal(&Frame::from_normal_and_tangent(n, n)));
            assert!(orthonormal(&Frame::from_normal_and_tangent(n, Vec3::ZERO)));
        }
    }
}
