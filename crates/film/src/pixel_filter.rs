//! A filter made ready for a film: drawing positions from it, and spreading splats with it.
//!
//! Camera samples are placed with the density |f(x) f(y)| / (∫|f|)², so that all samples have the
//! same weight up to its sign,
//!
//! ```text
//! weight = sign f(x) · sign f(y) · (∫|f| / ∫f)²,
//! ```
//!
//! and no sample is shared between pixels (Ernst, Stamminger and Greiner 2006). Without negative
//! lobes the weight is one.
//!
//! With negative lobes, the *first* random number alone decides the signs: its unit interval is
//! cut into four parts with the masses of the quadrants of (sign f(x), sign f(y)),
//!
//! ```text
//! 0 ─── n(1−n) ─── 2n(1−n) ──────────────────── 1 − n² ── 1       n = ∫f₋ / ∫|f|
//!   − at x   │ − at y  │       + at both          │ − at both
//! ```
//!
//! so everything that counts negatively is the one interval [0, 2n(1−n)). Any sampler whose
//! first coordinates are stratified therefore draws 2n(1−n)·N negative samples of N, give or
//! take one, in every pixel: the sign, which would otherwise dominate the noise, is fixed.
//! "Give or take one" still weighs much where a replicate has very few samples: with N = 2, a
//! single negative sample cancels the other. Filters with negative lobes want more samples per
//! replicate rather than more replicates.

use crate::filter_sampler_1d::{FilterSampler1d, part};
use crate::{BoxFilter, Filter};
use glam::Vec2;

/// A filter with the tables to sample it.
#[derive(Clone, Debug)]
pub struct PixelFilter {
    filter: Filter,
    /// ∫f.
    integral: f64,
    sampling: Sampling,
}

#[derive(Clone, Debug)]
enum Sampling {
    Box,
    Tent {
        radius: f32,
    },
    /// No negative lobes.
    Positive(FilterSampler1d),
    Signed {
        positive: FilterSampler1d,
        negative: FilterSampler1d,
        /// The ends of the first three parts of the unit interval.
        ends: [f32; 3],
        /// (∫|f| / ∫f)².
        weight: f32,
    },
}

/// Cells per pixel of the half line, and at least this many.
const CELLS: f64 = 256.0;

/// The least radius of a filter that splats are used with (pixels): one in a hundred finds a pixel then.
const NARROWEST: f32 = 0.05;

impl PixelFilter {
    /// Prepares a filter.
    pub fn new(filter: Filter) -> Self {
        let (integral, sampling) = match filter {
            Filter::Box(_) => (2.0 * BoxFilter::RADIUS, Sampling::Box),
            Filter::Tent(tent) => (
                tent.radius(),
                Sampling::Tent {
                    radius: tent.radius() as f32,
                },
            ),
            // The Gaussian is as smooth as it is wide; all others have the pixel as their scale.
            Filter::Gaussian(_) => tabulate(filter, CELLS),
            _ => tabulate(filter, CELLS.max(0.5 * CELLS * filter.radius())),
        };
        Self {
            filter,
            integral,
            sampling,
        }
    }

    /// The filter itself.
    pub fn filter(&self) -> &Filter {
        &self.filter
    }

    /// Radius (pixels).
    pub fn radius(&self) -> f32 {
        self.filter.radius() as f32
    }

    /// Whether splats find pixels often enough to make a picture.
    ///
    /// A splat counts for the pixels whose centres are within the radius. With a radius below half a pixel
    /// some splats reach no pixel and the others weigh more; with a very small one hardly any remain.
    pub fn catches_splats(&self) -> bool {
        self.radius() >= NARROWEST
    }

    /// How far (pixels) outside of the film a splat can still reach a pixel: the outermost
    /// centres lie half a pixel inside.
    pub fn margin(&self) -> f32 {
        (self.radius() - 0.5).max(0.0)
    }

    /// f(x) / ∫f (pixel⁻¹).
    #[inline]
    pub fn density(&self, x: f64) -> f64 {
        self.filter.eval(x) / self.integral
    }

    /// Draws the distance from the pixel's centre (pixels) and what the sample counts.
    #[inline]
    pub fn sample(&self, u: Vec2) -> (Vec2, f32) {
        match &self.sampling {
            Sampling::Box => (u - 0.5, 1.0),
            Sampling::Tent { radius } => {
                let tent = |u| both_sides(u, |v| radius * (1.0 - (1.0 - v).max(0.0).sqrt()));
                (Vec2::new(tent(u.x), tent(u.y)), 1.0)
            }
            Sampling::Positive(half) => {
                let draw = |u| both_sides(u, |v| half.sample(v));
                (Vec2::new(draw(u.x), draw(u.y)), 1.0)
            }
            Sampling::Signed {
                positive,
                negative,
                ends,
                weight,
            } => {
                let [first, second, third] = *ends;
                let (x, y, sign, from, to) = if u.x < first {
                    (negative, positive, -1.0, 0.0, first)
                } else if u.x < second {
                    (positive, negative, -1.0, first, second)
                } else if u.x < third {
                    (positive, positive, 1.0, second, third)
                } else {
                    (negative, negative, 1.0, third, 1.0)
                };
                let ux = (u.x - from) / (to - from);
                let offset = Vec2::new(
                    both_sides(ux, |v| x.sample(v)),
                    both_sides(u.y, |v| y.sample(v)),
                );
                (offset, sign * weight)
            }
        }
    }
}

/// The lower half of `u` goes to the left, the upper half to the right, monotonically.
#[inline]
fn both_sides(u: f32, distance: impl Fn(f32) -> f32) -> f32 {
    let v = 2.0 * u - 1.0;
    distance(v.abs()).copysign(v)
}

fn tabulate(filter: Filter, cells: f64) -> (f64, Sampling) {
    let parts = part(|x| filter.eval(x), filter.radius(), cells as u32);
    let (positive, p) = parts.positive;
    let (negative, q) = parts.negative;
    let integral = 2.0 * (p - q);
    // Rounding alone can make a sliver of nothing negative.
    if q <= 1e-9 * p {
        return (integral, Sampling::Positive(positive));
    }
    let n = q / (p + q);
    let ends = [n * (1.0 - n), 2.0 * n * (1.0 - n), 1.0 - n * n].map(|end| end as f32);
    let weight = ((p + q) / (p - q)).powi(2) as f32;
    (
        integral,
        Sampling::Signed {
            positive,
            negative,
            ends,
            weight,
        },
    )
}
