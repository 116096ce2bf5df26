//! An affine map taken apart into what can be interpolated: translation, rotation, stretch (polar decomposition).

use core::ops::{Add, Mul};
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

/// An affine map, taken apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parts {
    pub(crate) translation: DVec3,
    pub(crate) rotation: DQuat,
    pub(crate) stretch: DMat3,
}

impl Add for Parts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            translation: self.translation + other.translation,
            rotation: self.rotation + other.rotation,
            stretch: self.stretch + other.stretch,
        }
    }
}

impl Mul<f64> for Parts {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            translation: self.translation * factor,
            rotation: self.rotation * factor,
            stretch: self.stretch * factor,
        }
    }
}

impl Parts {
    /// The parts of an invertible map with this linear part: M = R·S by Higham's iteration R ← (R + R⁻ᵀ)/2.
    pub(crate) fn of(matrix: &DMat4) -> Self {
        let linear = DMat3::from_mat4(*matrix);
        let mut r = linear * linear.determinant().signum();
        for _ in 0..64 {
            let next = (r + r.inverse().transpose()) * 0.5;
            let change = (next - r).to_cols_array().map(f64::abs);
            r = next;
            if change.into_iter().sum::<f64>() < 1e-14 {
                break;
            }
        }
        Self {
            translation: matrix.w_axis.truncate(),
            rotation: DQuat::from_mat3(&r).normalize(),
            stretch: r.transpose() * linear,
        }
    }

    /// The map that they make.
    pub(crate) fn map(&self) -> DAffine3 {
        DAffine3 {
            matrix3: DMat3::from_quat(self.rotation) * self.stretch,
            translation: self.translation,
        }
    }
}
