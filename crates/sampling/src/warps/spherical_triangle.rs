//! The directions in which a point sees a triangle, uniform by solid angle (Arvo 1995), after
//! van Oosterom & Strackee's tangent (1983) rather than by angles and arc cosines.
//!
//! For unit vectors a, b, c the solid angle Ω obeys
//!
//! ```text
//! tan(Ω/2) = G / (1 + a·b + b·c + c·a),      G = a·(b × c)
//! ```
//!
//! Let p = b cos t + w sin t run along the arc from b to c (w ⟂ b). The part a, b, p has solid
//! angle 2s with, for τ = tan(t/2),
//!
//! ```text
//! tan s = τ a·(b × w) / ((1 + a·b) + τ a·w)    ⟺    τ = tan s (1 + a·b) / (a·(b × w) − tan s a·w)
//! ```
//!
//! so s = u₀Ω/2 gives p without an inverse trigonometric function. Along the arc from a to p,
//! 1 − cos is uniform: 1 − a·ω = u₁ (1 − a·p) = u₁ |p − a|²/2.

use etalon_math::float::sin_cos_turns;
use etalon_math::float64;
use glam::{DVec2, DVec3, Vec2, Vec3};

/// A triangle seen from a point.
///
/// The algebra is in double precision, which costs little; single precision is left for
/// the sine and cosine, whose relative error (10⁻⁷) is all the error of a sample.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    /// The corners as given, and those as unit vectors.
    corners: [DVec3; 3],
    a: DVec3,
    b: DVec3,
    c: DVec3,
    solid_angle: f64,
}

/// Solid angles between these (sr) are sampled by solid angle; smaller triangles look flat, so
/// that sampling their area is as good, and larger ones surround a point all but in their plane.
const SOLID_ANGLES: core::ops::RangeInclusive<f64> = 1e-6..=6.2;

impl SphericalTriangle {
    /// The triangle with the given corners, as seen from the origin. `None` if its solid angle
    /// lies outside 10⁻⁶ … 6.2 sr: sample its area then.
    #[inline]
    pub fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let [la, lb, lc] = corners.map(DVec3::length);
        // By edges: differences of nearby corners are exact.
        let volume = a.dot((b - a).cross(c - a));
        let sum = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        let solid_angle = 2.0 * float64::atan2(volume.abs(), sum);
        SOLID_ANGLES.contains(&solid_angle).then(|| {
            let (b, lb, c, lc) = if volume < 0.0 {
                (c, lc, b, lb)
            } else {
                (b, lb, c, lc)
            };
            Self {
                corners,
                a: a / la,
                b: b / lb,
                c: c / lc,
                solid_angle,
            }
        })
    }

    /// The solid angle (sr).
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// The density per steradian, the same for every direction that meets the triangle.
    #[inline]
    pub fn density(&self) -> f32 {
        1.0 / self.solid_angle as f32
    }

    /// The unit vector of the plane of b and c, perpendicular to b, on c's side.
    #[inline]
    fn along(&self) -> DVec3 {
        (self.c - self.b * self.b.dot(self.c)).normalize()
    }

    /// A unit direction towards the triangle, uniform by solid angle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec3 {
        let Self { a, b, .. } = *self;
        let w = self.along();
        let turns = u.x * (self.solid_angle * (0.25 / core::f64::consts::PI)) as f32;
        let (sin, cos) = sin_cos_turns(turns);
        let numerator = f64::from(sin) * (1.0 + a.dot(b));
        let denominator = f64::from(cos) * a.dot(b.cross(w)) - f64::from(sin) * a.dot(w);
        let half = DVec2::new(denominator, numerator).normalize();
        let p = b * ((half.x - half.y) * (half.x + half.y)) + w * (2.0 * half.x * half.y);

        let one_minus_cos = f64::from(u.y) * 0.5 * p.distance_squared(a);
        let sin = (one_minus_cos * (2.0 - one_minus_cos)).sqrt();
        let sideways = (p - a * a.dot(p)).normalize();
        (a * (1.0 - one_minus_cos) + sideways * sin).as_vec3()
    }

    /// The inverse of [`SphericalTriangle::sample`], for a unit direction that meets the
    /// triangle.
    #[inline]
    pub fn invert(&self, direction: Vec3) -> Vec2 {
        let Self { a, b, c, .. } = *self;
        let direction = direction.as_dvec3().normalize();
        let p = a.cross(direction).cross(b.cross(c));
        let length = p.length();
        if !(length > 0.0) {
            // The corner a itself: any u.x would do.
            return Vec2::ZERO;
        }
        let p = if p.dot(b + c) < 0.0 { -p } else { p } / length;
        let part = float64::atan2(a.dot(b.cross(p)), 1.0 + a.dot(b) + b.dot(p) + p.dot(a));
        let along = direction.distance_squared(a) / p.distance_squared(a);
        DVec2::new(2.0 * part / self.solid_angle, along)
            .clamp(DVec2::ZERO, DVec2::ONE)
            .as_vec2()
    }

    /// The barycentric coordinates (b₁, b₂), of the corners as they were given, of the point
    /// that lies in a sampled direction; never outside the triangle.
    #[inline]
    pub fn barycentric(&self, direction: Vec3) -> Vec2 {
        let [a, b, c] = self.corners;
        let (e1, e2) = (b - a, c - a);
        let across = direction.as_dvec3().cross(e2);
        let b1 = -a.dot(across) / e1.dot(across);
        let b2 = -direction.as_dvec3().dot(a.cross(e1)) / e1.dot(across);
        let inside = DVec2::new(b1, b2).max(DVec2::ZERO);
        (inside / (inside.x + inside.y).max(1.0)).as_vec2()
    }
}
