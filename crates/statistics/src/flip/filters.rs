//! The filters of ꟻLIP: contrast sensitivity, and edges and points (HPG 2020, sections 4.1.1 and
//! 4.2).
//!
//! With x in degrees, each opponent channel is blurred by Σ a √(π/b) exp(−π² x²/b), normalised: one
//! Gaussian for Y and C_x, two for C_z, each separable. Edges and points are the first and second
//! derivatives of a Gaussian of standard deviation ½ · 0.082° in one direction times the Gaussian in
//! the other; the positive and the negative weights of a derivative each sum to one in magnitude.
//! Beyond the borders the image repeats its last pixel. Radii are three standard deviations,
//! rounded up.

use std::f64::consts::PI;

/// The widths b of the Gaussians of Y and C_x.
const ACHROMATIC: f64 = 0.0047;
const RED_GREEN: f64 = 0.0053;
/// a and b of the two Gaussians of C_z.
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];
/// The visual width of an edge in degrees.
const EDGE_WIDTH: f64 = 0.082;

/// Values in rows.
pub(super) struct Plane<T> {
    values: Vec<T>,
    width: usize,
}

impl<T: Copy> Plane<T> {
    pub(super) fn new(values: Vec<T>, width: usize) -> Self {
        Self { values, width }
    }

    /// What `fold` makes of the `taps` (an odd number) neighbours of each pixel in its row; beyond
    /// the ends the last ones repeat.
    fn along_rows<U>(&self, taps: usize, fold: impl Fn(&[T]) -> U) -> Plane<U> {
        let mut values = Vec::with_capacity(self.values.len());
        let mut padded = Vec::with_capacity(self.width + taps);
        for row in self.values.chunks_exact(self.width) {
            pad(row.iter().copied(), taps / 2, &mut padded);
            values.extend(padded.windows(taps).map(&fold));
        }
        Plane {
            values,
            width: self.width,
        }
    }

    /// As [`Plane::along_rows`], in its column.
    fn along_columns<U: Copy>(&self, taps: usize, fold: impl Fn(&[T]) -> U) -> Vec<U> {
        let mut columns = Vec::with_capacity(self.values.len());
        let mut padded = Vec::with_capacity(self.values.len() / self.width + taps);
        for x in 0..self.width {
            let column = self.values[x..].iter().step_by(self.width);
            pad(column.copied(), taps / 2, &mut padded);
            columns.extend(padded.windows(taps).map(&fold));
        }
        let height = self.values.len() / self.width;
        (0..self.values.len())
            .map(|index| columns[index % self.width * height + index / self.width])
            .collect()
    }
}

/// A line with its first and last value repeated `half` times beyond its ends.
fn pad<T: Copy>(line: impl Iterator<Item = T>, half: usize, padded: &mut Vec<T>) {
    padded.clear();
    for value in line {
        if padded.is_empty() {
            padded.extend(std::iter::repeat_n(value, half));
        }
        padded.push(value);
    }
    if let Some(&last) = padded.last() {
        padded.extend(std::iter::repeat_n(last, half));
    }
}

/// The distances of the taps of a filter from its centre, in pixels.
fn offsets(radius: usize) -> impl Iterator<Item = f64> {
    (0..=2 * radius).map(move |tap| tap as f64 - radius as f64)
}

/// Weights of Y, C_x and the two Gaussians of C_z.
fn spatial_taps(pixels_per_degree: f64) -> Vec<[f64; 4]> {
    let widest = BLUE_YELLOW[0].1;
    let deviation = (widest / (2.0 * PI * PI)).sqrt();
    let radius = (3.0 * deviation * pixels_per_degree).ceil() as usize;
    let gaussian = |x: f64, b: f64| libm::exp(-PI * PI * x * x / b);
    // √ of the amplitude, since it is applied in both directions.
    let amplitude = |(a, b): (f64, f64)| (a * (PI / b).sqrt()).sqrt();
    let mut taps: Vec<[f64; 4]> = offsets(radius)
        .map(|offset| {
            let x = offset / pixels_per_degree;
            let [wide, narrow] = BLUE_YELLOW.map(|g| amplitude(g) * gaussian(x, g.1));
            [
                gaussian(x, ACHROMATIC),
                gaussian(x, RED_GREEN),
                wide,
                narrow,
            ]
        })
        .collect();
    let sums: [f64; 4] = std::array::from_fn(|i| taps.iter().map(|tap| tap[i]).sum());
    // The two-dimensional sum of C_z is the sum of the squares.
    let both = (sums[2] * sums[2] + sums[3] * sums[3]).sqrt();
    for tap in &mut taps {
        *tap = [
            tap[0] / sums[0],
            tap[1] / sums[1],
            tap[2] / both,
            tap[3] / both,
        ];
    }
    taps
}

/// The opponent image as the eye's contrast sensitivity blurs it.
pub(super) fn spatially_filtered(image: &Plane<[f64; 3]>, pixels_per_degree: f64) -> Vec<[f64; 3]> {
    let taps = spatial_taps(pixels_per_degree);
    image
        .along_rows(taps.len(), |window| {
            let mut sum = [0.0; 4];
            for (&[y, cx, cz], tap) in window.iter().zip(&taps) {
                for (sum, term) in sum.iter_mut().zip([y, cx, cz, cz].iter().zip(tap)) {
                    *sum += term.0 * term.1;
                }
            }
            sum
        })
        .along_columns(taps.len(), |window| {
            let mut sum = [0.0; 4];
            for (value, tap) in window.iter().zip(&taps) {
                for (sum, term) in sum.iter_mut().zip(value.iter().zip(tap)) {
                    *sum += term.0 * term.1;
                }
            }
            [sum[0], sum[1], sum[2] + sum[3]]
        })
}

/// How strongly a pixel is an edge, and a point.
#[derive(Clone, Copy)]
pub(super) struct Features {
    pub(super) edge: f64,
    pub(super) point: f64,
}

/// Weights of the Gaussian and of its first and second derivative.
fn feature_taps(pixels_per_degree: f64) -> Vec<[f64; 3]> {
    let deviation = 0.5 * EDGE_WIDTH * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as usize;
    let mut taps: Vec<[f64; 3]> = offsets(radius)
        .map(|x| {
            let u = x / deviation;
            let gaussian = libm::exp(-0.5 * u * u);
            [gaussian, -x * gaussian, (u * u - 1.0) * gaussian]
        })
        .collect();
    for i in 0..3 {
        let sum = |sign: f64| taps.iter().map(|tap| (sign * tap[i]).max(0.0)).sum::<f64>();
        let (positive, negative) = (sum(1.0), sum(-1.0));
        for tap in &mut taps {
            if tap[i] > 0.0 {
                tap[i] /= positive;
            } else if tap[i] < 0.0 {
                tap[i] /= negative;
            }
        }
    }
    taps
}

/// The features of the achromatic channel, normalised to [0, 1] for black to white.
pub(super) fn feature_strengths(image: &Plane<[f64; 3]>, pixels_per_degree: f64) -> Vec<Features> {
    let taps = feature_taps(pixels_per_degree);
    image
        .along_rows(taps.len(), |window| {
            let mut sum = [0.0; 3];
            for ([y, _, _], tap) in window.iter().zip(&taps) {
                let grey = (y + 16.0) / 116.0;
                for (sum, weight) in sum.iter_mut().zip(tap) {
                    *sum += grey * weight;
                }
            }
            sum
        })
        .along_columns(taps.len(), |window| {
            let (mut dx, mut ddx, mut dy, mut ddy) = (0.0, 0.0, 0.0, 0.0);
            for ([smooth, first, second], [g, dg, ddg]) in window.iter().zip(&taps) {
                dx += g * first;
                ddx += g * second;
                dy += dg * smooth;
                ddy += ddg * smooth;
            }
            Features {
                edge: (dx * dx + dy * dy).sqrt(),
                point: (ddx * ddx + ddy * ddy).sqrt(),
            }
        })
}
