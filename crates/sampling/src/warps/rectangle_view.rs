//! Points of a rectangle, nearly in proportion to the irradiance that they cause at a receiver.
//!
//! A point y of a uniform Lambertian emitter with normal n_y lights a surface with normal n at x by
//!
//! ```text
//! dE/dA = L |n·ω| |n_y·ω| / r²,      ω = (y − x)/r
//! ```
//!
//! Over a plane r |n_y·ω| is constant, so the density on the unit square should follow
//! |n·ω| / r³. It is the bilinear interpolation of that at the four corners (Hart, Pharr, Müller,
//! Lopes, McGuire & Shirley 2020, "Practical Product Sampling by Fitting and Composing Warps",
//! Computer Graphics Forum 39(4), section 4), which is good while the rectangle is not much larger
//! than its distance. The cosine is taken on both sides of the surface, and as if it never fell
//! below [`GRAZING`], so that no part of the rectangle is left out.

use super::line::{interval_to_linear, linear_to_interval};
use glam::{Vec2, Vec3, Vec4, vec4};

/// The least cosine at the receiver that is believed.
const GRAZING: f32 = 0.05;

/// A rectangle, or any parallelogram, as a receiver sees it.
#[derive(Clone, Copy, Debug)]
pub struct RectangleView {
    /// The density at the corners (0, 0), (1, 0), (0, 1), (1, 1), up to a factor.
    corners: Vec4,
    total: f32,
}

impl RectangleView {
    /// The parallelogram with a corner at `corner` from the receiver and two edges, for a
    /// receiver with unit normal `normal`, or zero for none.
    #[inline]
    pub fn new(corner: Vec3, edges: [Vec3; 2], normal: Vec3) -> Self {
        let spread = |c: f32, a: f32, b: f32| vec4(c, c + a, c + b, c + a + b);
        let x = spread(corner.x, edges[0].x, edges[1].x);
        let y = spread(corner.y, edges[0].y, edges[1].y);
        let z = spread(corner.z, edges[0].z, edges[1].z);
        let r2 = x * x + y * y + z * z;
        let least = if normal == Vec3::ZERO { 1.0 } else { GRAZING };
        // One distance serves for the limit at all corners.
        let limit = Vec4::splat(least * r2.x.sqrt());
        let across = (x * normal.x + y * normal.y + z * normal.z).abs();
        let corners = across.max(limit) / (r2 * r2);
        let total = corners.element_sum();
        // Beyond the range of numbers, by area.
        if total > 0.0 && total < f32::INFINITY {
            Self { corners, total }
        } else {
            Self {
                corners: Vec4::ONE,
                total: 4.0,
            }
        }
    }

    /// A point of the unit square.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec2 {
        let [a, b, c, d] = self.corners.to_array();
        let y = interval_to_linear(u.y, a + b, c + d);
        let x = interval_to_linear(u.x, a + (c - a) * y, b + (d - b) * y);
        Vec2::new(x, y)
    }

    /// The density of [`RectangleView::sample`] at a point of the unit square.
    #[inline]
    pub fn density(&self, point: Vec2) -> f32 {
        let [a, b, c, d] = self.corners.to_array();
        let low = a + (b - a) * point.x;
        let high = c + (d - c) * point.x;
        4.0 * (low + (high - low) * point.y) / self.total
    }

    /// The inverse of [`RectangleView::sample`].
    #[inline]
    pub fn invert(&self, point: Vec2) -> Vec2 {
        let [a, b, c, d] = self.corners.to_array();
        Vec2::new(
            linear_to_interval(point.x, a + (c - a) * point.y, b + (d - b) * point.y),
            linear_to_interval(point.y, a + b, c + d),
        )
    }
}
