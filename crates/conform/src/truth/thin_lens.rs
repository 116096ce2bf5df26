//! What is out of the focus of a thin lens of radius R: a plane at the distance D, while the lens is focused on F.
//!
//! The rays through a point of the film meet at P in the plane of focus. Those from the point a of the
//! lens reach the plane at a (1 − D/F) + P D/F: all of the lens covers a circle of radius
//! c = R |1 − D/F| there (the circle of confusion: Potmesil and Chakravarty 1981), evenly. Of a glowing form in the
//! plane is seen the share of the circle that lies on it. The area common to two circles of radii r and c, d apart, is
//!
//! ```text
//! r² acos((d² + r² − c²)/(2dr)) + c² acos((d² + c² − r²)/(2dc))
//!     − ½ √((r + c + d)(r + c − d)(d + r − c)(d − r + c)),
//! ```
//!
//! and the share of a circle of radius 1 beyond a straight edge at s from its middle (acos s − s √(1 − s²))/π.

use etalon_math::float64::acos;
use std::f64::consts::PI;

/// The radius (m) of the circle of confusion of a lens of this radius, at a distance, for another in focus (m).
pub fn confusion(lens_radius: f64, distance: f64, focus: f64) -> f64 {
    lens_radius * (1.0 - distance / focus).abs()
}

/// The share of a circle of radius 1 beyond an edge at the distance `s` from its middle, which is negative if the middle itself
/// is beyond.
pub fn beyond_edge(s: f64) -> f64 {
    let s = s.clamp(-1.0, 1.0);
    (acos(s) - s * (1.0 - s * s).sqrt()) / PI
}

/// The area (m²) common to two circles of radii `a` and `b` whose centres are `d` apart (m).
pub fn common_area(d: f64, a: f64, b: f64) -> f64 {
    if d >= a + b {
        return 0.0;
    }
    if d <= (a - b).abs() {
        let least = a.min(b);
        return PI * least * least;
    }
    let half_angle = |a: f64, b: f64| acos((d * d + a * a - b * b) / (2.0 * d * a));
    let kite = (a + b + d) * (a + b - d) * (d + a - b) * (d - a + b);
    a * a * half_angle(a, b) + b * b * half_angle(b, a) - 0.5 * kite.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{beyond_edge, common_area, confusion};
    use std::f64::consts::PI;

    #[test]
    fn two_circles_through_each_others_centres() {
        // Two thirds of π less half of √3: the vesica piscis.
        let expected = 2.0 * PI / 3.0 - 0.5 * 3.0_f64.sqrt();
        assert!((common_area(1.0, 1.0, 1.0) - expected).abs() < 1e-14);
        assert_eq!(common_area(2.0, 1.0, 0.5), 0.0);
        assert!((common_area(0.2, 1.0, 0.5) - 0.25 * PI).abs() < 1e-15);
        // Continuous where they begin to touch, up to the rounding of acos near its ends.
        assert!(common_area(1.5 - 1e-9, 1.0, 0.5) < 1e-10);
        assert!((common_area(0.5 + 1e-9, 1.0, 0.5) - 0.25 * PI).abs() < 1e-10);
    }

    #[test]
    fn an_edge_cuts_the_points_of_a_lens() {
        let n = 1000;
        for s in [-1.5, -0.7, 0.0, 0.3, 0.9] {
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
            let points = (0..n * n).map(|i| (at(i % n), at(i / n)));
            let lens = points.filter(|(x, y)| x * x + y * y < 1.0);
            let (all, beyond) = lens.fold((0, 0), |(all, beyond), (x, _)| {
                (all + 1, beyond + i32::from(x > s))
            });
            let expected = f64::from(beyond) / f64::from(all);
            assert!((beyond_edge(s) - expected).abs() < 1e-3, "{s}");
        }
    }

    #[test]
    fn what_is_in_focus_is_sharp() {
        assert_eq!(confusion(0.1, 4.0, 4.0), 0.0);
        // Halfway to the focus half of the lens is seen.
        assert_eq!(confusion(0.1, 2.0, 4.0), 0.05);
    }
}
