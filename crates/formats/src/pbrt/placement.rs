//! Where things stand: the current transformation matrix (CTM), and the transforms that change it.
//!
//! There are two matrices, for the start and the end of a motion; `ActiveTransform` says which ones a directive changes. Each
//! operation is multiplied from the right, so the last one written is applied first.

use crate::mitsuba::transform;
use etalon_params::{DMat4, DVec3};
use glam::{DAffine3, DVec4};

/// Where something stands: its transform to world space, or for the camera, from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The transform at the first of the two times.
    pub start: DMat4,
    /// The transform at the second of them.
    pub end: DMat4,
    /// The times (`TransformTimes`), in the units of the camera's shutter.
    pub times: [f64; 2],
}

impl Default for Placement {
    /// The identity, and the times 0 and 1.
    fn default() -> Self {
        Self {
            start: DMat4::IDENTITY,
            end: DMat4::IDENTITY,
            times: [0.0, 1.0],
        }
    }
}

impl Placement {
    /// Whether it moves.
    pub fn is_animated(&self) -> bool {
        self.start != self.end
    }

    /// The inverse of both transforms, if they have one.
    pub fn inverse(&self) -> Option<Self> {
        let inverse = |matrix: DMat4| match matrix.row(3) == DVec4::W {
            // Of an affine map it is affine to the last bit.
            true => DMat4::from(DAffine3::from_mat4(matrix).inverse()),
            false => matrix.inverse(),
        };
        let inverse = Self {
            start: inverse(self.start),
            end: inverse(self.end),
            times: self.times,
        };
        inverse.is_finite().then_some(inverse)
    }

    /// Changes the transforms that are active.
    pub(crate) fn change(&mut self, active: Active, change: impl Fn(DMat4) -> DMat4) {
        if active != Active::EndTime {
            self.start = change(self.start);
        }
        if active != Active::StartTime {
            self.end = change(self.end);
        }
    }

    /// Whether all numbers are finite as 32-bit floats.
    pub(crate) fn is_finite(&self) -> bool {
        self.start.as_mat4().is_finite() && self.end.as_mat4().is_finite()
    }
}

/// Which transforms the directives change (`ActiveTransform`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Active {
    #[default]
    All,
    StartTime,
    EndTime,
}

/// Rotation by `degrees` about an axis of any length but zero, counter-clockwise seen against it.
pub(crate) fn rotate(degrees: f64, axis: DVec3) -> Option<DMat4> {
    Some(transform::rotate(axis.try_normalize()?, degrees))
}

/// The transform from the world to a camera at `eye`, whose +z points at `target` and whose +y lies in the half-plane of
/// `up`. +x points to the right of the picture, as spaces are left-handed in pbrt. `None` if the points coincide, or `up` is zero or parallel to the
/// direction of view.
pub(crate) fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Option<DMat4> {
    let direction = (target - eye).try_normalize()?;
    let right = up.try_normalize()?.cross(direction).try_normalize()?;
    let above = direction.cross(right);
    // The inverse of an orthonormal frame is its transpose.
    let row = |axis: DVec3| axis.extend(-axis.dot(eye));
    let rows = DMat4::from_cols(row(right), row(above), row(direction), DVec4::W);
    Some(rows.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_maps(m: DMat4, from: [f64; 3], to: [f64; 3]) {
        let found = m.transform_point3(DVec3::from_array(from));
        assert!(
            found.distance(DVec3::from_array(to)) < 1e-12,
            "{found} is not {to:?}"
        );
    }

    #[test]
    fn rotations_need_no_unit_axis() {
        let m = rotate(90.0, DVec3::new(0.0, 0.0, 7.0)).expect("a rotation");
        assert_maps(m, [1.0, 0.0, 5.0], [0.0, 1.0, 5.0]);
        assert_eq!(rotate(90.0, DVec3::ZERO), None);
    }

    #[test]
    fn cameras_look_along_z_in_a_left_handed_space() {
        let eye = DVec3::new(3.0, 4.0, 1.5);
        let m = look_at(eye, DVec3::new(3.0, 4.0, 0.0), DVec3::Y * 9.0).expect("a camera");
        assert_maps(m, [3.0, 4.0, 1.5], [0.0, 0.0, 0.0]);
        assert_maps(m, [3.0, 4.0, -0.5], [0.0, 0.0, 2.0]);
        assert_maps(m, [3.0, 5.0, 1.5], [0.0, 1.0, 0.0]);
        // In a left-handed world, who looks along −z with +y above has +x on the left.
        assert_maps(m, [4.0, 4.0, 1.5], [-1.0, 0.0, 0.0]);
        assert_eq!(look_at(eye, eye, DVec3::Y), None);
        assert_eq!(look_at(eye, eye + DVec3::Y, DVec3::Y), None);
        assert_eq!(look_at(eye, eye + DVec3::Y, DVec3::ZERO), None);
    }

    #[test]
    fn inverses_of_affine_maps_are_affine() {
        let turned = rotate(40.0, DVec3::new(1.0, 2.0, 3.0)).expect("a rotation");
        let start = DMat4::from_translation(DVec3::new(-0.07, 3.98, 16.2)) * turned;
        let placement = Placement {
            start,
            ..Placement::default()
        };
        let inverse = placement.inverse().expect("invertible");
        assert_eq!(inverse.start.row(3), DVec4::W);
        assert!((inverse.start * start).abs_diff_eq(DMat4::IDENTITY, 1e-12));
    }

    #[test]
    fn only_active_transforms_change() {
        let mut placement = Placement::default();
        let shift = |m: DMat4| m * DMat4::from_translation(DVec3::X);
        placement.change(Active::EndTime, shift);
        assert!(placement.is_animated() && placement.start == DMat4::IDENTITY);
        placement.change(Active::StartTime, shift);
        assert!(!placement.is_animated());
        placement.change(Active::All, |_| DMat4::ZERO);
        assert_eq!(placement.inverse(), None);
    }
}
