//! Barycentric coordinates, uniform by area, with little distortion (Heitz 2019, "A
//! Low-Distortion Map Between Triangle and Square"): the half of the square on either side of
//! its diagonal is sheared onto half of the triangle. No square root, continuous, and cells
//! stay compact.

use glam::Vec2;

/// The barycentric coordinates (b₁, b₂) of a point of a triangle, uniform by area;
/// b₀ = 1 − b₁ − b₂ ≥ 0.
#[inline]
pub fn square_to_triangle(u: Vec2) -> Vec2 {
    if u.y > u.x {
        let x = 0.5 * u.x;
        Vec2::new(x, u.y - x)
    } else {
        let y = 0.5 * u.y;
        Vec2::new(u.x - y, y)
    }
}

/// The inverse of [`square_to_triangle`].
#[inline]
pub fn triangle_to_square(barycentric: Vec2) -> Vec2 {
    let sum = barycentric.x + barycentric.y;
    if barycentric.y > barycentric.x {
        Vec2::new(2.0 * barycentric.x, sum)
    } else {
        Vec2::new(sum, 2.0 * barycentric.y)
    }
}

/// The density of a uniform point on a triangle of the given area (m²): 1/area, in m⁻².
#[inline]
pub fn triangle_density(area: f32) -> f32 {
    1.0 / area
}
