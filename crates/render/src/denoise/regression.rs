//! Local regressions of first order on features, weighted by patches of colour that are equal up to noise.
//!
//! Around a pixel p, in a window of pixels q, the colour is c(q) = β₀ + β · (f(q) − f(p)) with f the features, fitted by least
//! squares with weights
//!
//! ```text
//! w(q) = exp(−max(0, d²)),   d² = ⟨ ((x_p − x_q)² − (v_p + min(v_p, v_q))) / (ε + k² (v_p + v_q)) ⟩
//! ```
//!
//! over patches around both and colours, v the variance of a pixel (Rousselle, Knaus, Zwicker 2012, equation 4): noise alone makes d²
//! nothing. β₀ is the filtered pixel. Differences of features that are no larger than their noise are held down by its variance on the
//! diagonal, which is what noise adds to squares of differences.

use super::halves::NUMBERS;
use super::smooth::boxed;
use super::{Halves, Plane};
use etalon_math::float;
use rayon::prelude::*;

/// Radius of the window (pixels).
const WINDOW: isize = 8;

/// Radius of patches (pixels).
const PATCH: usize = 3;

/// k: how much patches may differ, in units of their noise.
const BANDWIDTHS: [f32; 2] = [0.5, 1.0];

/// Side of the tiles that are filtered at a time (pixels).
const TILE: usize = 32;

/// Keeps the distance of pixels without noise finite; relative to the square of their brightness.
const EPSILON: f32 = 1e-6;

/// Weights below this are none.
const LEAST_WEIGHT: f32 = 1e-3;

/// A constant and the features.
const TERMS: usize = NUMBERS + 1;

/// Entries of a symmetric matrix of these.
const ENTRIES: usize = TERMS * (TERMS + 1) / 2;

/// A filter's result for either half.
pub(super) type Filtered = [Plane; 2];

/// What every filter makes of either half: the regressions, and the weighted mean with the widest weights.
pub(super) fn filter(halves: &Halves) -> Vec<Filtered> {
    let noise = noise(halves);
    let [first, second] = halves
        .halves
        .each_ref()
        .map(|half| one(halves, half, &noise));
    first.into_iter().zip(second).map(|(a, b)| [a, b]).collect()
}

/// The variance of a half's pixels, smoothed: that of few replicates is noisy itself.
fn noise(halves: &Halves) -> Plane {
    let channel = |c: usize| {
        let variance: Vec<f32> = halves.variance.iter().map(|pixel| 2.0 * pixel[c]).collect();
        boxed(&variance, halves.size, 1)
    };
    let smooth = [0, 1, 2].map(channel);
    (0..halves.variance.len())
        .map(|i| smooth.each_ref().map(|channel| channel[i]))
        .collect()
}

/// The filters of one half.
fn one(halves: &Halves, half: &Plane, noise: &Plane) -> Vec<Plane> {
    let [width, height] = halves.size;
    let corners: Vec<[usize; 2]> = (0..height)
        .step_by(TILE)
        .flat_map(|y| (0..width).step_by(TILE).map(move |x| [x, y]))
        .collect();
    let tiles: Vec<_> = corners
        .par_iter()
        .map(|&corner| Tile::new(halves, half, noise, corner).filtered())
        .collect();
    let mut planes = vec![vec![[0.0; 3]; width * height]; BANDWIDTHS.len() + 1];
    for ([left, top], tile) in corners.into_iter().zip(tiles) {
        let [across, down] = extent(halves.size, [left, top]);
        for (plane, pixels) in planes.iter_mut().zip(tile) {
            for row in 0..down {
                let start = (top + row) * width + left;
                let line = &pixels[row * across..(row + 1) * across];
                plane[start..start + across].copy_from_slice(line);
            }
        }
    }
    planes
}

/// The pixels of a tile across and down.
fn extent(size: [usize; 2], corner: [usize; 2]) -> [usize; 2] {
    std::array::from_fn(|axis| TILE.min(size[axis] - corner[axis]))
}

/// The sums of a least-squares fit.
#[derive(Clone)]
struct Sums {
    matrix: [f32; ENTRIES],
    right: [[f32; 3]; TERMS],
}

impl Sums {
    const ZERO: Self = Self {
        matrix: [0.0; ENTRIES],
        right: [[0.0; 3]; TERMS],
    };

    #[inline]
    fn add(&mut self, weight: f32, terms: &[f32; TERMS], colour: &[f32; 3]) {
        let mut entry = 0;
        for i in 0..TERMS {
            let weighed = weight * terms[i];
            for term in &terms[..=i] {
                self.matrix[entry] += weighed * term;
                entry += 1;
            }
            for (sum, value) in self.right[i].iter_mut().zip(colour) {
                *sum += weighed * value;
            }
        }
    }

    /// The weighted mean.
    fn mean(&self) -> [f32; 3] {
        self.right[0].map(|sum| sum / self.matrix[0])
    }

    /// β₀, with `blur` on the diagonal for each unit of weight; the mean where the fit has no solution.
    fn constant(&self, blur: &[f32; NUMBERS]) -> [f32; 3] {
        // Cholesky's decomposition, from the last term to the constant, which is solved for alone.
        let at = |i: usize, j: usize| f64::from(self.matrix[i * (i + 1) / 2 + j]);
        let weight = at(0, 0);
        // The constant comes last, so that it is the only one to be solved back.
        let order = |i: usize| (i + 1) % TERMS;
        let mut lower = [[0.0_f64; TERMS]; TERMS];
        let mut forward = [[0.0_f64; 3]; TERMS];
        for i in 0..TERMS {
            for j in 0..=i {
                let (a, b) = (order(i), order(j));
                let mut sum = at(a.max(b), a.min(b));
                if i == j && a > 0 {
                    sum += weight * f64::from(blur[a - 1]);
                }
                let before = lower[i][..j].iter().zip(&lower[j][..j]);
                sum -= before.map(|(a, b)| a * b).sum::<f64>();
                if i == j {
                    if sum <= 1e-9 * weight {
                        return self.mean();
                    }
                    lower[i][i] = sum.sqrt();
                } else {
                    lower[i][j] = sum / lower[j][j];
                }
            }
            for c in 0..3 {
                let mut sum = f64::from(self.right[order(i)][c]);
                for (j, solved) in forward[..i].iter().enumerate() {
                    sum -= lower[i][j] * solved[c];
                }
                forward[i][c] = sum / lower[i][i];
            }
        }
        let last = TERMS - 1;
        forward[last].map(|value| (value / lower[last][last]) as f32)
    }
}

/// A tile of one half.
struct Tile<'a> {
    halves: &'a Halves,
    half: &'a Plane,
    noise: &'a Plane,
    corner: [usize; 2],
    extent: [usize; 2],
}

impl<'a> Tile<'a> {
    fn new(halves: &'a Halves, half: &'a Plane, noise: &'a Plane, corner: [usize; 2]) -> Self {
        Self {
            halves,
            half,
            noise,
            corner,
            extent: extent(halves.size, corner),
        }
    }

    /// What every filter makes of its pixels.
    fn filtered(&self) -> Vec<Plane> {
        let [across, down] = self.extent;
        let mut sums = vec![vec![Sums::ZERO; across * down]; BANDWIDTHS.len()];
        for dy in -WINDOW..=WINDOW {
            for dx in -WINDOW..=WINDOW {
                let distances = self.distances([dx, dy]);
                for (sums, distances) in sums.iter_mut().zip(&distances) {
                    self.add([dx, dy], distances, sums);
                }
            }
        }
        let pixels = |sums: &[Sums], of: &dyn Fn(&Sums, usize) -> [f32; 3]| -> Plane {
            let all = sums.iter().enumerate();
            all.map(|(i, sums)| of(sums, self.index(i)).map(|value| value.max(0.0)))
                .collect()
        };
        let fitted = |sums: &Sums, pixel: usize| sums.constant(&self.halves.blur[pixel]);
        let mut planes: Vec<Plane> = sums.iter().map(|sums| pixels(sums, &fitted)).collect();
        let widest = sums.last().map(|sums| pixels(sums, &|sums, _| sums.mean()));
        planes.extend(widest);
        planes
    }

    /// The place of the tile's pixel `i` in the picture.
    fn index(&self, i: usize) -> usize {
        let [x, y] = [i % self.extent[0], i / self.extent[0]];
        (self.corner[1] + y) * self.halves.size[0] + self.corner[0] + x
    }

    /// d² of the patches of the tile's pixels and of those so far away, for each bandwidth.
    fn distances(&self, offset: [isize; 2]) -> [Vec<f32>; BANDWIDTHS.len()] {
        let [width, height] = self.halves.size;
        let [left, top] = self.corner.map(|n| n.saturating_sub(PATCH));
        let [right, bottom]: [usize; 2] = std::array::from_fn(|axis| {
            (self.corner[axis] + self.extent[axis] + PATCH).min(self.halves.size[axis])
        });
        let moved = |at: usize, by: isize, end: usize| at.saturating_add_signed(by).min(end - 1);
        let size = [right - left, bottom - top];
        let mut single = BANDWIDTHS.map(|_| Vec::with_capacity(size[0] * size[1]));
        for y in top..bottom {
            let other = moved(y, offset[1], height) * width;
            for x in left..right {
                let (p, q) = (y * width + x, other + moved(x, offset[0], width));
                for (single, distance) in single.iter_mut().zip(self.distance(p, q)) {
                    single.push(distance);
                }
            }
        }
        single.map(|single| {
            let smooth = boxed(&single, size, PATCH);
            let row = |y: usize| {
                let start = (self.corner[1] - top + y) * size[0] + self.corner[0] - left;
                &smooth[start..start + self.extent[0]]
            };
            (0..self.extent[1]).flat_map(row).copied().collect()
        })
    }

    /// d² of two pixels alone, for each bandwidth.
    #[inline]
    fn distance(&self, p: usize, q: usize) -> [f32; BANDWIDTHS.len()] {
        let ([x, y], [v, u]) = (
            [p, q].map(|i| &self.half[i]),
            [p, q].map(|i| &self.noise[i]),
        );
        let mut sums = [0.0; BANDWIDTHS.len()];
        for c in 0..3 {
            let difference = x[c] - y[c];
            let noise = v[c] + u[c].min(v[c]);
            let bright = x[c].abs() + y[c].abs();
            let least = EPSILON * (bright * bright + EPSILON);
            let excess = (difference * difference - noise) / 3.0;
            for (sum, bandwidth) in sums.iter_mut().zip(BANDWIDTHS) {
                *sum += excess / (least + bandwidth * bandwidth * (v[c] + u[c]));
            }
        }
        sums
    }

    /// Adds the pixels that are so far away from the tile's to their fits.
    fn add(&self, offset: [isize; 2], distances: &[f32], sums: &mut [Sums]) {
        let [width, height] = self.halves.size;
        let mut terms = [1.0; TERMS];
        for (i, (sums, distance)) in sums.iter_mut().zip(distances).enumerate() {
            let weight = float::exp(-distance.max(0.0));
            if weight < LEAST_WEIGHT {
                continue;
            }
            let p = self.index(i);
            let (Some(x), Some(y)) = (
                (p % width).checked_add_signed(offset[0]),
                (p / width).checked_add_signed(offset[1]),
            ) else {
                continue;
            };
            if x >= width || y >= height {
                continue;
            }
            let q = y * width + x;
            let (here, there) = (&self.halves.features[p], &self.halves.features[q]);
            for (term, (a, b)) in terms[1..].iter_mut().zip(there.iter().zip(here)) {
                *term = a - b;
            }
            sums.add(weight, &terms, &self.half[q]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_gives_the_constant_of_a_plane() {
        // Mutant rejected: the weighted mean, which is off as the features' mean is.
        let mut sums = Sums::ZERO;
        for i in 0..40_u32 {
            let feature = |j: u32| ((i * 7 + j * 13) % 11) as f32 / 11.0 - 0.2 + 0.03 * j as f32;
            let terms: [f32; TERMS] =
                std::array::from_fn(|j| if j == 0 { 1.0 } else { feature(j as u32 * i) });
            let value = 0.5 + 2.0 * terms[1] - terms[3] + 0.25 * terms[7];
            sums.add(1.0 / (1 + i) as f32, &terms, &[value, 2.0 * value, 0.0]);
        }
        let [r, g, b] = sums.constant(&[1e-7; NUMBERS]);
        assert!((r - 0.5).abs() < 1e-3 && (g - 1.0).abs() < 2e-3, "{r} {g}");
        assert_eq!(b, 0.0);
        assert!((sums.mean()[0] - 0.5).abs() > 0.05);
        // A feature that is all noise explains nothing.
        let [r, ..] = sums.constant(&[1e9; NUMBERS]);
        assert!((r - sums.mean()[0]).abs() < 1e-4, "{r}");
    }
}
