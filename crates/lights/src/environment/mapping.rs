//! How an image covers the sphere of directions: where its texels are, and the solid angle of its parts.
//!
//! A map has nodes at the corners of (columns − 1) × (rows − 1) patches, which cover the unit square of *places*. Between the nodes radiance and
//! density are bilinear. The nodes are the texels and copies of those beyond the image's borders.

use core::f32::consts::PI;
use etalon_math::lane::{Lane, Select, Vector};
use etalon_math::{equal_area, float64};
use etalon_sampling::latitude_longitude;
use glam::UVec2;

/// The kind of a map, and its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mapping {
    /// u along the equator from the centre of the first column, v from pole to pole. The first column stands again at the end.
    LatitudeLongitude {
        /// Half the width of a texel.
        half_texel: f32,
    },
    /// The square of [`equal_area`], within a border of half a texel. What lies in the border is seen within the square, too: across an
    /// edge the octahedron goes on at the same edge, mirrored at its middle.
    EqualArea {
        /// Texels on a side.
        side: f32,
    },
}

impl Mapping {
    /// Columns and rows of nodes, and the nodes of an image of `size` texels, row by row.
    pub(super) fn nodes(self, size: UVec2, texels: &[[f32; 3]]) -> (UVec2, Vec<[f32; 3]>) {
        let (width, height) = (size.x as usize, size.y as usize);
        match self {
            Self::LatitudeLongitude { .. } => {
                let rows = texels.chunks_exact(width);
                let nodes = rows.flat_map(|row| row.iter().chain(&row[..1])).copied();
                (size + UVec2::X, nodes.collect())
            }
            Self::EqualArea { .. } => {
                let nodes = (0..(height + 2) * (width + 2)).map(|node| {
                    let (mut x, mut y) = (node % (width + 2), node / (width + 2));
                    // Counted from 1, so that both borders are whole numbers.
                    let last = width;
                    if x == 0 || x > last {
                        (x, y) = (x.clamp(1, last), last + 1 - y);
                    }
                    if y == 0 || y > last {
                        (x, y) = (last + 1 - x, y.clamp(1, last));
                    }
                    texels[(y - 1) * width + x - 1]
                });
                (size + UVec2::splat(2), nodes.collect())
            }
        }
    }

    /// What the density at the nodes of a row must have for a factor, to be proportional to their brightness per solid angle.
    pub(super) fn row_weights(self, height: usize) -> impl Fn(usize) -> f64 {
        let sines = sines_of_rows(height.max(2));
        move |row| match self {
            Self::LatitudeLongitude { .. } => sines(row),
            Self::EqualArea { .. } => 1.0,
        }
    }

    /// The solid angles of texels of a row, in proportion to one another.
    pub(super) fn solid_angles(self, height: usize) -> impl Fn(usize) -> f64 {
        let weights = self.row_weights(height);
        move |row| match self {
            // Half of the hat function of a row at a pole lies beyond it.
            Self::LatitudeLongitude { .. } if row == 0 || row + 1 == height => 0.5 * weights(row),
            _ => weights(row),
        }
    }

    /// The places of unit directions.
    #[inline(always)]
    pub(super) fn place<F: Lane>(self, direction: F::Vector) -> [F; 2] {
        match self {
            Self::LatitudeLongitude { half_texel } => {
                let [u, v] = latitude_longitude::to_square::<F>(direction);
                let u = u - half_texel;
                [u.lt(F::ZERO).select(u + 1.0, u), v]
            }
            Self::EqualArea { side } => {
                equal_area::to_square::<F>(direction).map(|c| (c * side + 0.5) / (side + 1.0))
            }
        }
    }

    /// The unit directions at places, and the places of these directions.
    #[inline(always)]
    pub(super) fn direction<F: Lane>(self, place: [F; 2]) -> (F::Vector, [F; 2]) {
        match self {
            Self::LatitudeLongitude { half_texel } => {
                let [u, v] = place;
                (
                    latitude_longitude::to_direction([u + half_texel, v]).0,
                    place,
                )
            }
            Self::EqualArea { side } => {
                let [x, y] = place.map(|c| (c * (side + 1.0) - 0.5) / side);
                let beyond = |c: F| c.lt(F::ZERO) | c.gt(F::ONE);
                let mirrored = |c: F| c.gt(F::ONE).select(F::splat(2.0) - c, -c);
                let [x, y] = beyond(x).select([mirrored(x), F::ONE - y], [x, y]);
                let [x, y] = beyond(y).select([F::ONE - x, mirrored(y)], [x, y]);
                let within = [x, y].map(|c| (c * side + 0.5) / (side + 1.0));
                (equal_area::to_direction([x, y]), within)
            }
        }
    }

    /// The density per solid angle (sr⁻¹) of directions at places, where the density per unit of the places' square is `per_area`.
    #[inline(always)]
    pub(super) fn per_solid_angle<F: Lane>(
        self,
        per_area: F,
        direction: F::Vector,
        place: [F; 2],
    ) -> F {
        match self {
            Self::LatitudeLongitude { .. } => {
                let [x, _, z] = direction.xyz();
                let sin_theta = (x * x + z * z).sqrt();
                let density = per_area / latitude_longitude::stretch(sin_theta);
                sin_theta.gt(F::ZERO).select(density, F::ZERO)
            }
            Self::EqualArea { side } => {
                // A place within half a texel of an edge has an equal beyond it.
                let twice = |c: F| {
                    let node = c * (side + 1.0);
                    let near = node.lt(F::ONE) | node.gt(F::splat(side));
                    near.select(F::splat(2.0), F::ONE)
                };
                let [x, y] = place.map(twice);
                let inner = side / (side + 1.0);
                per_area * x * y * (inner * inner / (4.0 * PI))
            }
        }
    }
}

/// The mean of sin πv over the hat function of each of `height` ≥ 2 rows at v = j/(h − 1), with
/// k = π/(h − 1):
///
/// ```text
/// sⱼ = sin(jk) · 2(1 − cos k)/k²,     s₀ = s₍ₕ₋₁₎ = (1 − sin k / k) · 2/k
/// ```
fn sines_of_rows(height: usize) -> impl Fn(usize) -> f64 {
    let k = core::f64::consts::PI / (height - 1) as f64;
    // sin²(k/2) for (1 − cos k)/2, and a series for 1 − sin k / k where it would cancel.
    let half = float64::sin(0.5 * k) / (0.5 * k);
    let pole = if k < 1e-2 {
        k / 3.0 * (1.0 - k * k / 20.0)
    } else {
        (1.0 - float64::sin(k) / k) * 2.0 / k
    };
    move |row| {
        if row == 0 || row + 1 == height {
            pole
        } else {
            float64::sin(row as f64 * k) * half * half
        }
    }
}
