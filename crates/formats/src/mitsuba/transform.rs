//! The operations of a `<transform>`.
//!
//! Each operation is multiplied from the left, so the first one written is applied first. A
//! matrix acts on column vectors and is written row by row.

use etalon_math::float64;
use etalon_params::{DMat4, DVec3};
use glam::DVec4;

/// Rotation by `degrees` about `axis`, counter-clockwise seen against it.
///
/// R = cos θ · 1 + (1 − cos θ) · a aᵀ + sin θ · a×, which is a rotation only for |a| = 1.
/// Mitsuba 3 applies the formula to the axis as written, so a longer one shears; this is kept, with
/// a note if it is not [`is_unit`] (Mitsuba 0.x divided by the length first). Axes of unit length up
/// to their rounding in the file are normalised.
pub fn rotate(axis: DVec3, degrees: f64) -> DMat4 {
    let a = if is_unit(axis) {
        axis.normalize()
    } else {
        axis
    };
    let (sin, cos) = float64::sin_cos(degrees.to_radians());
    let column = |unit: DVec3| {
        (unit * cos + a * ((1.0 - cos) * a.dot(unit)) + a.cross(unit) * sin).extend(0.0)
    };
    DMat4::from_cols(
        column(DVec3::X),
        column(DVec3::Y),
        column(DVec3::Z),
        DVec4::W,
    )
}

/// Whether an axis has unit length within the rounding of a number of three or four digits.
pub fn is_unit(axis: DVec3) -> bool {
    (axis.length() - 1.0).abs() < 1e-3
}

/// The frame that stands at `origin`, whose +z looks at `target` and whose +y lies in the
/// half-plane of `up`; +x points to the left. Without an `up` (or with a zero one), one is made.
/// `None` if the points coincide or `up` is parallel to the direction of view.
pub fn look_at(origin: DVec3, target: DVec3, up: Option<DVec3>) -> Option<DMat4> {
    let direction = (target - origin).try_normalize()?;
    let up = up
        .filter(|up| *up != DVec3::ZERO)
        .unwrap_or_else(|| perpendicular(direction));
    let left = up.cross(direction).try_normalize()?;
    let above = direction.cross(left);
    Some(DMat4::from_cols(
        left.extend(0.0),
        above.extend(0.0),
        direction.extend(0.0),
        origin.extend(1.0),
    ))
}

/// A unit vector perpendicular to the unit vector `n`, the same one that Mitsuba takes: the first
/// tangent of Duff et al., "Building an Orthonormal Basis, Revisited" (2017), listing 3.
fn perpendicular(n: DVec3) -> DVec3 {
    let sign = 1f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    DVec3::new(
        1.0 + sign * n.x * n.x * a,
        sign * n.x * n.y * a,
        -sign * n.x,
    )
}

/// The matrix of 16 numbers, or of 9 for the linear part, row by row.
pub fn matrix(numbers: &[f64]) -> Option<DMat4> {
    match *numbers {
        [a, b, c, d, e, f, g, h, i] => Some(DMat4::from_cols(
            DVec4::new(a, d, g, 0.0),
            DVec4::new(b, e, h, 0.0),
            DVec4::new(c, f, i, 0.0),
            DVec4::W,
        )),
        _ => <&[f64; 16]>::try_from(numbers)
            .ok()
            .map(|all| DMat4::from_cols_array(all).transpose()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_rows(m: DMat4, rows: [[f64; 4]; 3]) {
        for (i, row) in rows.into_iter().enumerate() {
            let difference = (m.row(i) - DVec4::from_array(row)).abs().max_element();
            assert!(difference < 2e-6, "row {i}: {:?} is not {row:?}", m.row(i));
        }
    }

    #[test]
    fn look_at_agrees_with_mitsuba() {
        // Values printed by Mitsuba 3.9.1's parser.
        let at = |target, up| look_at(DVec3::new(1.0, 2.0, 3.0), target, up).expect("a frame");
        assert_rows(
            at(DVec3::new(4.0, -1.0, 2.0), Some(DVec3::Y)),
            [
                [-0.316228, 0.652929, 0.688247, 1.0],
                [0.0, 0.725476, -0.688247, 2.0],
                [-0.948683, -0.217643, -0.229416, 3.0],
            ],
        );
        assert_rows(
            at(DVec3::new(4.0, -1.0, 2.0), None),
            [
                [0.385292, 0.614708, 0.688247, 1.0],
                [0.614708, 0.385292, -0.688247, 2.0],
                [-0.688247, 0.688247, -0.229416, 3.0],
            ],
        );
        assert_rows(
            at(DVec3::new(4.0, 5.0, -2.0), Some(DVec3::ZERO)),
            [
                [-0.118754, 0.881246, 0.457496, 1.0],
                [0.881246, -0.118754, 0.457496, 2.0],
                [0.457496, 0.457496, -0.762493, 3.0],
            ],
        );
    }

    #[test]
    fn look_at_refuses_what_has_no_frame() {
        assert_eq!(look_at(DVec3::ONE, DVec3::ONE, Some(DVec3::Y)), None);
        assert_eq!(look_at(DVec3::ZERO, DVec3::Y, Some(DVec3::Y)), None);
    }

    #[test]
    fn rotations_agree_with_mitsuba() {
        assert_rows(
            rotate(DVec3::Y, 90.0),
            [
                [0.0, 0.0, 1.0, 0.0],
                [0.0, 1.0, 0.0, 0.0],
                [-1.0, 0.0, 0.0, 0.0],
            ],
        );
        // Axes that are not of unit length are not normalised.
        assert_rows(
            rotate(DVec3::new(1.0, 2.0, 3.0), 30.0),
            [
                [1.0, -1.232051, 1.401924, 0.0],
                [1.767949, 1.401924, 0.303848, 0.0],
                [-0.598076, 1.303848, 2.071797, 0.0],
            ],
        );
        let rounded = rotate(DVec3::splat(0.577), 120.0);
        assert!((rounded.determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn matrices_are_written_row_by_row() {
        let numbers: Vec<f64> = (1..=16).map(f64::from).collect();
        let m = matrix(&numbers).expect("sixteen numbers");
        assert_eq!(m.row(0), DVec4::new(1.0, 2.0, 3.0, 4.0));
        let m = matrix(&numbers[..9]).expect("nine numbers");
        assert_eq!(m.row(1), DVec4::new(4.0, 5.0, 6.0, 0.0));
        assert_eq!(m.row(3), DVec4::W);
        assert_eq!(matrix(&numbers[..12]), None);
    }
}
