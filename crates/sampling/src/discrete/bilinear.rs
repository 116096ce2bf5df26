//! A density on the unit square that is bilinear between the nodes of a grid, as a bitmap with
//! bilinear filtering is.
//!
//! The square is divided into (w − 1) × (h − 1) patches with nodes at their corners. The row of
//! patches is chosen by mass, then the patch; within it y by its marginal density, which
//! is linear, then x by its conditional density, which is linear too.

use super::{PiecewiseConstant2d, TableError, check_weights};
use glam::{DVec2, UVec2, Vec2};

/// A bilinearly interpolated density on [0, 1]².
#[derive(Clone, Debug)]
pub struct Bilinear {
    patches: PiecewiseConstant2d,
    nodes: Vec<f32>,
    width: usize,
    /// 1 / ∫ of the interpolated nodes.
    scale: f64,
}

impl Bilinear {
    /// The density proportional to the bilinear interpolation of `nodes`, row by row from
    /// y = 0, each of `width` nodes; the first and last rows and columns lie on the border.
    ///
    /// # Errors
    /// If the number of nodes is no multiple of `width`, there are fewer than two rows or
    /// columns, all are zero, or one is negative or not finite.
    pub fn new(nodes: &[f32], width: usize) -> Result<Self, TableError> {
        if width < 2 {
            return Err(TableError::TooShort {
                entries: width,
                needed: 2,
            });
        }
        if !nodes.len().is_multiple_of(width) || nodes.len() < 2 * width {
            return Err(TableError::WrongShape {
                entries: nodes.len(),
                needed: nodes.len().next_multiple_of(width).max(2 * width),
            });
        }
        let values: Vec<f64> = nodes.iter().map(|&v| f64::from(v)).collect();
        check_weights(&values, 4)?;
        let masses: Vec<f64> = values
            .chunks(width)
            .zip(values.chunks(width).skip(1))
            .flat_map(|(low, high)| {
                low.windows(2)
                    .zip(high.windows(2))
                    .map(|(low, high)| 0.25 * (low[0] + low[1] + high[0] + high[1]))
            })
            .collect();
        let patches = PiecewiseConstant2d::new(&masses, width - 1)?;
        Ok(Self {
            scale: 1.0 / patches.integral(),
            patches,
            nodes: nodes.to_vec(),
            width,
        })
    }

    /// The integral of the interpolated nodes over the square.
    #[inline]
    pub fn integral(&self) -> f64 {
        1.0 / self.scale
    }

    /// A point of the square with this density.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec2 {
        let (patch, place) = self.patches.choose(u.as_dvec2());
        let [[a, b], [c, d]] = self.corners(patch);
        let y = inverse_of_linear(place.y, a + b, c + d);
        let x = inverse_of_linear(place.x, a + (c - a) * y, b + (d - b) * y);
        self.patches.point_in(patch, DVec2::new(x, y))
    }

    /// The inverse of [`Bilinear::sample`].
    #[inline]
    pub fn invert(&self, point: Vec2) -> Vec2 {
        let (patch, place) = self.locate(point);
        let [[a, b], [c, d]] = self.corners(patch);
        let mass = |t: f64, from: f64, to: f64| {
            if from + to > 0.0 {
                t * (2.0 * from + t * (to - from)) / (from + to)
            } else {
                t
            }
        };
        let y = mass(place.y, a + b, c + d);
        let from = a + (c - a) * place.y;
        let to = b + (d - b) * place.y;
        let x = mass(place.x, from, to);
        self.patches.unchoose(patch, DVec2::new(x, y)).as_vec2()
    }

    /// The density at a point of the square, per unit of area.
    #[inline]
    pub fn density(&self, point: Vec2) -> f32 {
        let (patch, place) = self.locate(point);
        let [[a, b], [c, d]] = self.corners(patch);
        let low = a + (b - a) * place.x;
        let high = c + (d - c) * place.x;
        ((low + (high - low) * place.y) * self.scale) as f32
    }

    /// The patch of a point, and where in the patch it lies.
    #[inline]
    fn locate(&self, point: Vec2) -> (UVec2, DVec2) {
        let size = self.patches.size();
        let scaled = point.as_dvec2().clamp(DVec2::ZERO, DVec2::ONE) * size.as_dvec2();
        let patch = scaled.as_uvec2().min(size - UVec2::ONE);
        (patch, scaled - patch.as_dvec2())
    }

    /// The nodes at the corners of a patch, row by row.
    #[inline]
    fn corners(&self, patch: UVec2) -> [[f64; 2]; 2] {
        let first = patch.y as usize * self.width + patch.x as usize;
        let pair = |at: usize| [self.nodes[at].into(), self.nodes[at + 1].into()];
        [pair(first), pair(first + self.width)]
    }
}

/// The number t ∈ [0, 1] below which the linear density from `a` at 0 to `b` at 1 has the share
/// `u` of its mass.
#[inline]
fn inverse_of_linear(u: f64, a: f64, b: f64) -> f64 {
    let divisor = a + (a * a + u * (b - a) * (b + a)).max(0.0).sqrt();
    if divisor > 0.0 {
        (u * (a + b) / divisor).clamp(0.0, 1.0)
    } else {
        u
    }
}
