//! Cones of directions: what holds all the normals of a surface.

use glam::{DQuat, DVec3};

/// All unit vectors within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionCone {
    /// Unit axis.
    pub axis: DVec3,
    /// Cosine of the half angle; −1 is the whole sphere.
    pub cos: f64,
}

impl DirectionCone {
    /// Every direction.
    pub const ALL: Self = Self {
        axis: DVec3::Z,
        cos: -1.0,
    };

    /// One direction.
    pub fn along(axis: DVec3) -> Self {
        Self { axis, cos: 1.0 }
    }

    /// Whether it holds the unit vector `direction`, up to rounding.
    pub fn contains(&self, direction: DVec3) -> bool {
        self.cos <= -1.0 || self.axis.dot(direction) >= self.cos - 1e-9
    }

    fn angle(&self) -> f64 {
        crate::float64::acos(self.cos.clamp(-1.0, 1.0))
    }

    /// The smallest cone that contains both, up to rounding.
    ///
    /// ```
    /// use etalon_math::{DVec3, DirectionCone};
    /// let both = DirectionCone::along(DVec3::X).union(DirectionCone::along(DVec3::Y));
    /// assert!((both.cos - 0.5_f64.sqrt()).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let (wide, narrow) = match self.cos <= other.cos {
            true => (self, other),
            false => (other, self),
        };
        let between = crate::float64::acos(wide.axis.dot(narrow.axis).clamp(-1.0, 1.0));
        let (a, b) = (wide.angle(), narrow.angle());
        if between + b <= a {
            return wide;
        }
        let half = 0.5 * (a + between + b);
        let turn = wide.axis.cross(narrow.axis).try_normalize();
        match turn {
            Some(turn) if half < core::f64::consts::PI => {
                let (sin, cos) = crate::float64::sin_cos(0.5 * (half - a));
                let by = DQuat::from_xyzw(turn.x * sin, turn.y * sin, turn.z * sin, cos);
                Self {
                    axis: (by * wide.axis).normalize(),
                    cos: crate::float64::cos(half),
                }
            }
            // The same axis, up to rounding.
            None if wide.axis.dot(narrow.axis) > 0.0 => wide,
            _ => Self::ALL,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    fn direction() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0_f64, 0.0..core::f64::consts::TAU).prop_map(|(z, phi)| {
            let r = (1.0 - z * z).sqrt();
            let (sin, cos) = crate::float64::sin_cos(phi);
            DVec3::new(r * cos, r * sin, z)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: RngSeed::Fixed(1),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        /// Mutant rejected: a union turned about the opposite axis.
        #[test]
        fn a_union_holds_what_either_holds(
            a in direction(), b in direction(), c in direction(),
            cos_a in -1.0..1.0_f64, cos_b in -1.0..1.0_f64,
        ) {
            let first = DirectionCone { axis: a, cos: cos_a };
            let second = DirectionCone { axis: b, cos: cos_b };
            let both = first.union(second);
            for cone in [first, second] {
                prop_assert!(both.contains(cone.axis));
                if cone.contains(c) {
                    prop_assert!(both.contains(c), "{both:?} without {c} of {cone:?}");
                }
            }
            prop_assert!(both.cos <= first.cos.min(second.cos) + 1e-12);
        }
    }
}
