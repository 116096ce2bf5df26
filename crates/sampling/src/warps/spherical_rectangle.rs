//! The directions in which a point sees a rectangle, uniform by solid angle (Ureña, Fajardo &
//! King 2013, "An Area-Preserving Parametrization for Spherical Rectangles").
//!
//! In a frame along the rectangle's edges, at the observer, it spans [x₀, x₁] × [y₀, y₁] at
//! height z. The part [x₀, x] has solid angle u·Ω where, with k = 2π − γ₂ − γ₃ from the two
//! angles of the spherical rectangle at x₀, and b₀ = −y₀/√(y₀² + z²), b₁ = y₁/√(y₁² + z²),
//!
//! ```text
//! f = (b₀ cos(uΩ + k) − b₁) / sin(uΩ + k),      x = sgn(f) |z| / √(f² − z²/(y₀² + z²))
//! ```
//!
//! (the paper's c_u, with the difference 1 − c_u² taken before it cancels). Then y/√(x² + y² + z²)
//! is uniform. The angles themselves are never needed, only their sines and cosines, which are
//! algebraic; and Ω comes from the tangents of two triangles' solid angles (see
//! `spherical_triangle`), so that neither large nor small rectangles lose precision.

use etalon_math::float::sin_cos_turns;
use etalon_math::float64;
use etalon_math::lane::{Lane, Vector};
use glam::{DVec2, DVec3, Vec2, Vec3};

/// The sides of a rectangle: what does not depend on where it is seen from.
#[derive(Clone, Copy, Debug)]
pub struct RectangleSides {
    edges: [Vec3; 2],
    x: DVec3,
    y: DVec3,
    normal: DVec3,
    size: DVec2,
    diagonal_squared: f32,
}

impl RectangleSides {
    /// Two perpendicular edges.
    pub fn new(edges: [Vec3; 2]) -> Self {
        let [x, y] = edges.map(Vec3::as_dvec3);
        let size = DVec2::new(x.length(), y.length());
        let (x, y) = (x / size.x, y / size.y);
        Self {
            edges,
            x,
            y,
            normal: x.cross(y),
            size,
            diagonal_squared: size.length_squared() as f32,
        }
    }

    /// Whether the origin is nearer to the middle of the rectangle than the length of a
    /// diagonal, for the corner at `corner`: irradiance then varies over the rectangle in
    /// ways that no simple density follows.
    #[inline]
    pub fn is_near(&self, corner: Vec3) -> bool {
        Self::are_near::<f32>(corner, self.edges, self.diagonal_squared)
    }

    /// The same of several rectangles, with these edges and squared lengths of their diagonals.
    #[inline(always)]
    pub fn are_near<F: Lane>(
        corner: F::Vector,
        edges: [F::Vector; 2],
        diagonal_squared: F,
    ) -> F::Mask {
        let middle = corner + (edges[0] + edges[1]) * F::splat(0.5);
        middle.dot_product(middle).lt(diagonal_squared)
    }

    /// The squared length of a diagonal.
    #[inline]
    pub fn diagonal_squared(&self) -> f32 {
        self.diagonal_squared
    }
}

/// A rectangle seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    corner: Vec3,
    edges: [Vec3; 2],
    /// Two corners in the rectangle's frame, and the height above it.
    low: DVec2,
    high: DVec2,
    height: f64,
    solid_angle: f64,
    /// b₀, b₁ and (cos k, sin k) of the equations above.
    b: DVec2,
    k: DVec2,
}

/// Solid angles between these (sr) are sampled by solid angle; smaller rectangles look flat, so
/// that sampling their area is as good, and larger ones surround a point all but in their plane.
const SOLID_ANGLES: core::ops::RangeInclusive<f64> = 1e-6..=6.2;

impl SphericalRectangle {
    /// The rectangle with the given corner and two perpendicular edges from it, as seen from
    /// the origin. `None` if its solid angle lies outside 10⁻⁶ … 6.2 sr: sample its area then.
    #[inline]
    pub fn new(corner: Vec3, edges: [Vec3; 2]) -> Option<Self> {
        Self::seen(corner, &RectangleSides::new(edges))
    }

    /// The same, for sides that were made ready before.
    #[inline]
    pub fn seen(corner: Vec3, sides: &RectangleSides) -> Option<Self> {
        let origin = corner.as_dvec3();
        let RectangleSides {
            edges,
            x,
            y,
            normal,
            size,
            ..
        } = *sides;
        let low = DVec2::new(origin.dot(x), origin.dot(y));
        let high = low + size;
        let height = origin.dot(normal).abs();
        let solid_angle = solid_angle(low, high, height);
        SOLID_ANGLES.contains(&solid_angle).then(|| {
            let z2 = height * height;
            let hypot = |v: f64| (v * v + z2).sqrt();
            let (hx, hy0, hy1) = (hypot(low.x), hypot(low.y), hypot(high.y));
            // cos and sin of γ₂ (at x₀, y₁) and γ₃ (at x₀, y₀).
            let cos2 = low.x * high.y / (hx * hy1);
            let cos3 = -low.x * low.y / (hx * hy0);
            let sin2 = height * hypot(DVec2::new(low.x, high.y).length()) / (hx * hy1);
            let sin3 = height * hypot(low.length()) / (hx * hy0);
            Self {
                corner,
                edges,
                low,
                high,
                height,
                solid_angle,
                b: DVec2::new(-low.y / hy0, high.y / hy1),
                k: DVec2::new(cos2 * cos3 - sin2 * sin3, -(sin2 * cos3 + cos2 * sin3)),
            }
        })
    }

    /// The solid angle (sr).
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// The density per steradian, the same for every direction that meets the rectangle.
    #[inline]
    pub fn density(&self) -> f32 {
        1.0 / self.solid_angle as f32
    }

    /// A point on the rectangle, uniform by solid angle: the fractions of the two edges, in [0, 1].
    #[inline]
    pub fn sample_position(&self, u: Vec2) -> Vec2 {
        let turns = u.x * (self.solid_angle * (0.5 / core::f64::consts::PI)) as f32;
        let (sin, cos) = sin_cos_turns(turns);
        let swept = DVec2::new(cos.into(), sin.into());
        // One Newton step: the length is 1 up to single-precision rounding.
        let swept = swept * (1.5 - 0.5 * swept.length_squared());
        let angle = swept.rotate(self.k);
        let f = (angle.x * self.b.x - self.b.y) / angle.y;
        let z2 = self.height * self.height;
        let radicand = f * f - z2 / (self.low.y * self.low.y + z2);
        let x = (self.height / float64::safe_sqrt(radicand)).copysign(f);
        let x = x.clamp(self.low.x, self.high.x);

        let d2 = x * x + z2;
        let sine = |y: f64| y / (d2 + y * y).sqrt();
        let (from, to) = (sine(self.low.y), sine(self.high.y));
        let at = from + f64::from(u.y) * (to - from);
        let y = at * (d2 / (1.0 - at * at)).sqrt();
        self.fraction(DVec2::new(x, y)).as_vec2()
    }

    #[inline]
    fn fraction(&self, position: DVec2) -> DVec2 {
        ((position - self.low) / (self.high - self.low)).clamp(DVec2::ZERO, DVec2::ONE)
    }

    /// A unit direction towards the rectangle, uniform by solid angle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec3 {
        let position = self.sample_position(u);
        (self.corner + self.edges[0] * position.x + self.edges[1] * position.y).normalize()
    }

    /// The inverse of [`SphericalRectangle::sample_position`].
    #[inline]
    pub fn invert_position(&self, position: Vec2) -> Vec2 {
        let at = self.low + (self.high - self.low) * position.as_dvec2();
        let part = solid_angle(self.low, DVec2::new(at.x, self.high.y), self.height);
        let d2 = at.x * at.x + self.height * self.height;
        let sine = |y: f64| y / (d2 + y * y).sqrt();
        let (from, to) = (sine(self.low.y), sine(self.high.y));
        DVec2::new(part / self.solid_angle, (sine(at.y) - from) / (to - from))
            .clamp(DVec2::ZERO, DVec2::ONE)
            .as_vec2()
    }

    /// The inverse of [`SphericalRectangle::sample`], for a direction that meets the rectangle.
    #[inline]
    pub fn invert(&self, direction: Vec3) -> Vec2 {
        let [x, y] = self.edges.map(|edge| edge.as_dvec3().normalize());
        let direction = direction.as_dvec3();
        let scale = self.height / direction.dot(x.cross(y)).abs();
        let position = DVec2::new(direction.dot(x), direction.dot(y)) * scale;
        self.invert_position(self.fraction(position).as_vec2())
    }
}

/// The solid angle of [low, high] at `height`, as two triangles that share a diagonal: both
/// have the same volume G, and tangents of half their angles G/D.
fn solid_angle(low: DVec2, high: DVec2, height: f64) -> f64 {
    let corner = |x: f64, y: f64| DVec3::new(x, y, height);
    let [p, q, r, s] = [
        corner(low.x, low.y),
        corner(high.x, low.y),
        corner(high.x, high.y),
        corner(low.x, high.y),
    ];
    let size = high - low;
    let volume = height * size.x * size.y;
    let [lp, lr] = [p.length(), r.length()];
    let half = |m: DVec3| {
        let lm = m.length();
        lp * lr * lm + p.dot(r) * lm + r.dot(m) * lp + m.dot(p) * lr
    };
    // The sum of two angles is the argument of a product: one arc tangent serves for both.
    let (a, b) = (half(q), half(s));
    2.0 * float64::atan2(volume * (a + b), a * b - volume * volume)
}
