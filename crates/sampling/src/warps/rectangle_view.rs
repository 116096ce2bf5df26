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
use etalon_math::lane::{Lane, Select, Spectral, Vector};
use glam::Vec2;

/// The least cosine at the receiver that is believed.
const GRAZING: f32 = 0.05;

/// A rectangle, or any parallelogram, as a receiver sees it.
#[derive(Clone, Copy, Debug)]
pub struct RectangleView<F: Lane = f32> {
    /// The density at the corners (0, 0), (1, 0), (0, 1), (1, 1), up to a factor.
    corners: F::Spectrum,
    total: F,
}

impl<F: Lane> RectangleView<F> {
    /// The parallelogram with a corner at `corner` from the receiver and two edges, for a
    /// receiver with unit normal `normal`, or zero for none.
    #[inline]
    pub fn new(corner: F::Vector, edges: [F::Vector; 2], normal: F::Vector) -> Self {
        let spread = |c: F, a: F, b: F| F::Spectrum::from_waves([c, c + a, c + b, c + a + b]);
        let ([cx, cy, cz], [a, b]) = (corner.xyz(), edges.map(F::Vector::xyz));
        let x = spread(cx, a[0], b[0]);
        let y = spread(cy, a[1], b[1]);
        let z = spread(cz, a[2], b[2]);
        let r2 = x * x + y * y + z * z;
        let least = normal.is_zero().select(F::ONE, F::splat(GRAZING));
        // One distance serves for the limit at all corners.
        let limit = least * r2.hero().sqrt();
        let [nx, ny, nz] = normal.xyz();
        let across = (x * nx + y * ny + z * nz).magnitudes();
        let corners = across.at_least(limit) / (r2 * r2);
        let total = corners.sum();
        // Beyond the range of numbers, by area.
        let finite = total.gt(F::ZERO) & total.lt(F::splat(f32::INFINITY));
        Self {
            corners: F::Spectrum::choose(finite, corners, F::Spectrum::uniform(F::ONE)),
            total: finite.select(total, F::splat(4.0)),
        }
    }

    /// A point of the unit square.
    #[inline]
    pub fn sample(&self, u: [F; 2]) -> [F; 2] {
        let [a, b, c, d] = self.corners.waves();
        let y = interval_to_linear(u[1], a + b, c + d);
        let x = interval_to_linear(u[0], a + (c - a) * y, b + (d - b) * y);
        [x, y]
    }

    /// The density of [`RectangleView::sample`] at a point of the unit square.
    #[inline]
    pub fn density(&self, [x, y]: [F; 2]) -> F {
        let [a, b, c, d] = self.corners.waves();
        let low = a + (b - a) * x;
        let high = c + (d - c) * x;
        (low + (high - low) * y) * 4.0 / self.total
    }
}

impl RectangleView {
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
