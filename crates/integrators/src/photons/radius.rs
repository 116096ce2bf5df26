//! How far photons are looked for.
//!
//! The radius of a progression shrinks from pass to pass such that
//!
//! ```text
//! rᵢ₊₁² / rᵢ² = (i + α) / (i + 1),   i = 1, 2, …
//! ```
//!
//! (Knaus & Zwicker 2011, "Progressive Photon Mapping: A Probabilistic Approach"), in media rᵢ³. It
//! depends on the number of the pass alone, and so passes are independent. The mean of N passes
//! then has a variance of order N^−α and a bias of order N^(α−1) (ibid.); with α = 2/3
//! the squared bias falls as the variance does, N^(−2/3), which is the best exponent of their sum
//! (Kaplanyan & Dachsbacher 2013).
//!
//! Unless the scene says, the first radius is `PIXELS` times the width of a pixel on what the
//! camera sees: the median over a grid of rays of the distance between their first hits and those
//! of rays one pixel aside, if both went as far. On a small film that may be a good part of the
//! scene; where a map is dense (`held`), the radius is therefore the largest within which the
//! first hits of those rays have `MOST_FOUND` photons on average.

use crate::photons::kdtree::KdTree;
use etalon_math::{float, float64};
use etalon_params::Params;
use etalon_transport::{Camera, Pass, Surfaces, World};
use glam::{Vec2, Vec3};

/// α where the scene does not say.
pub(crate) const ALPHA: f64 = 2.0 / 3.0;

/// The default radius in pixels.
const PIXELS: f32 = 2.0;

/// The most photons that a look-up of a map finds on average where the radius is not given.
pub(crate) const MOST_FOUND: usize = 32;

/// A radius beyond everything (m) whose square is a number.
pub(crate) const ANYWHERE: f32 = 1e18;

/// Rays along each side of the film that look for the size of pixels.
const GRID: u32 = 16;

/// A shrinking radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radius {
    /// That of the first pass (m); `None` for the width of some pixels.
    pub first: Option<f32>,
    /// α.
    pub alpha: f64,
}

impl Default for Radius {
    fn default() -> Self {
        Self {
            first: None,
            alpha: ALPHA,
        }
    }
}

/// Reads a radius; `None` if it is not given.
pub(crate) fn read(params: &Params<'_>, name: &str) -> Option<f32> {
    let what = "a radius in metres, above 0";
    let radius = params.float(name)?;
    if !(radius > 0.0 && radius < 1e18) {
        params.refuse(name, radius, what);
    }
    Some(radius as f32)
}

impl Radius {
    /// Reads `radius` and `alpha`.
    pub fn from_params(params: &Params<'_>) -> Self {
        let what = "a number above 0 and at most 1";
        let accepted = |alpha| alpha > 0.0 && alpha <= 1.0;
        Self {
            first: read(params, "radius"),
            alpha: params.float_where("alpha", ALPHA, what, accepted),
        }
    }

    /// The radius of a pass on surfaces (m).
    pub(crate) fn of<W: World>(&self, world: &W, pass: &Pass) -> f32 {
        let first = self.first.unwrap_or_else(|| from_pixels(world, pass));
        (f64::from(first) * shrunk(self.alpha, pass.number).sqrt()) as f32
    }

    /// The same in media.
    pub(crate) fn in_space<W: World>(&self, world: &W, pass: &Pass) -> f32 {
        // As many pixels as make of a picture's width of photons, spread in a cube, about as many in a ball as lie in
        // a disc on a surface.
        let wider = || float::cbrt((pass.size.max_element() as f32 / PIXELS).max(1.0));
        let first = (self.first).unwrap_or_else(|| wider() * from_pixels(world, pass));
        (f64::from(first) * float64::cbrt(shrunk(self.alpha, pass.number))) as f32
    }
}

/// The disc or ball of a pass, counted from 0, over that of the first.
fn shrunk(alpha: f64, pass: u32) -> f64 {
    let ratio = |i: f64| (i + alpha) / (i + 1.0);
    (1..=pass).map(|i| ratio(f64::from(i))).product::<f64>()
}

/// What a grid of rays over the film meets: the point, and the distance to that of a ray one pixel
/// aside that goes as far.
fn seen<W: World>(world: &W, pass: &Pass) -> Vec<(Vec3, f32)> {
    let camera = world.camera();
    let points = (0..GRID * GRID).filter_map(|i| {
        let place = (Vec2::new((i % GRID) as f32, (i / GRID) as f32) + 0.5) / GRID as f32;
        let raster = pass.origin.as_vec2() + place * pass.size.as_vec2();
        let ray = camera.ray(raster, Vec2::splat(0.5), 0.5).ray;
        let t = world.surfaces().intersect(&ray)?.t;
        let aside = camera.ray(raster + Vec2::X, Vec2::splat(0.5), 0.5).ray;
        Some((ray.at(t), ray.at(t).distance(aside.at(t))))
    });
    points.collect()
}

/// Some pixels' width on what the camera sees; 1 if it sees nothing.
pub(crate) fn from_pixels<W: World>(world: &W, pass: &Pass) -> f32 {
    let seen = seen(world, pass);
    let mut widths: Vec<f32> = seen.into_iter().map(|(_, width)| width).collect();
    widths.retain(|width| *width > 0.0 && width.is_finite());
    widths.sort_by(f32::total_cmp);
    let median = widths.get(widths.len() / 2);
    median.map_or(1.0, |width| PIXELS * width)
}

/// At most `radius`, such that the points seen by the camera have no more than [`MOST_FOUND`]
/// photons within it on average.
pub(crate) fn held<W: World>(world: &W, pass: &Pass, tree: &KdTree, radius: f32) -> f32 {
    let points = seen(world, pass);
    let most = points.len() * MOST_FOUND;
    let (mut found, mut squared) = (Vec::new(), Vec::new());
    for (point, _) in &points {
        // Twice as many: places with fewer make up for those with more.
        tree.nearest(*point, 2 * MOST_FOUND, radius * radius, &mut found);
        squared.extend(found.iter().map(|photon| photon.distance_squared));
    }
    if squared.len() <= most {
        return radius;
    }
    let (_, at, _) = squared.select_nth_unstable_by(most, f32::total_cmp);
    // Zero if all photons are where the camera looks.
    if *at > 0.0 { at.sqrt() } else { radius }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_radius_falls_as_published() {
        // rᵢ² → r₁² i^(α−1) / Γ(1 + α); Γ(5/3) = 0.902745…
        let squared = shrunk(ALPHA, 99_999);
        let ratio = squared * 46.415_888_336 * 0.902_745_292_950_933;
        assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
        assert_eq!(shrunk(ALPHA, 0), 1.0);
        assert_eq!(shrunk(1.0, 7), 1.0);
    }
}
