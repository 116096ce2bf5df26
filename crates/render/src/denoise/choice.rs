//! Which filter is taken where, and what error it has.

use super::regression::Filtered;
use super::smooth::boxed;
use super::{Denoised, Halves, Plane};
use etalon_statistics::metrics::EPSILON;

/// Radius of the squares over which errors are averaged, twice (pixels).
const RADIUS: usize = 3;

/// Radius of the squares over which choices are blended (pixels).
const BLEND: usize = 2;

/// How much less a filter's error must seem than the picture's own for it to be taken.
const MARGIN: f32 = 0.85;

/// A candidate: a picture, its squared error, and the part of it that is variance; both are relative to [`scale`].
struct Candidate {
    colour: Plane,
    error: Plane,
    variance: Plane,
}

/// Takes at each pixel the filter whose error is least.
pub(super) fn least_error(halves: &Halves, filtered: &[Filtered]) -> Denoised {
    let scale = scale(filtered);
    let mut candidates = vec![untouched(halves, &scale)];
    let further = filtered.iter();
    candidates.extend(further.map(|filtered| candidate(halves, filtered, &scale)));
    let relative: Vec<Vec<f32>> = candidates
        .iter()
        .map(|candidate| candidate.error.iter().map(|e| e.iter().sum()).collect())
        .collect();
    let shares = shares(&relative, halves.size);
    let mut denoised = Denoised {
        colour: vec![[0.0; 3]; halves.whole.len()],
        error: vec![[0.0; 3]; halves.whole.len()],
    };
    for pixel in 0..halves.whole.len() {
        let mixed = |of: &dyn Fn(&Candidate) -> &Plane| -> [f32; 3] {
            let parts = candidates.iter().zip(&shares);
            let parts = parts.map(|(candidate, share)| (of(candidate)[pixel], share[pixel]));
            parts.fold([0.0; 3], |sum, (colour, share)| {
                std::array::from_fn(|c| sum[c] + share * colour[c])
            })
        };
        let (error, variance) = (mixed(&|c| &c.error), mixed(&|c| &c.variance));
        denoised.colour[pixel] = mixed(&|c| &c.colour);
        // An estimate of a square may be negative; no error is less than the noise that remains.
        denoised.error[pixel] =
            std::array::from_fn(|c| (error[c].max(variance[c]).max(0.0) * scale[pixel][c]).sqrt());
    }
    denoised
}

/// How much of each candidate is taken at each pixel.
fn shares(relative: &[Vec<f32>], size: [usize; 2]) -> Vec<Vec<f32>> {
    let pixels = size[0] * size[1];
    let mut taken = vec![vec![0.0; pixels]; relative.len()];
    for pixel in 0..pixels {
        let mut best = (0, MARGIN * relative[0][pixel]);
        for (i, error) in relative.iter().enumerate().skip(1) {
            if error[pixel] < best.1 {
                best = (i, error[pixel]);
            }
        }
        taken[best.0][pixel] = 1.0;
    }
    taken
        .iter()
        .map(|taken| boxed(taken, size, BLEND))
        .collect()
}

/// What squared errors are relative to where they are averaged, so that a lamp's do not spread over the wall: the square of the
/// smoothest picture's colour, and a little more.
fn scale(filtered: &[Filtered]) -> Plane {
    let Some([first, second]) = filtered.last() else {
        return Plane::new();
    };
    let pixels = first.iter().zip(second);
    pixels
        .map(|(a, b)| {
            std::array::from_fn(|c| {
                let colour = 0.5 * (a[c] + b[c]);
                // As in relMSE: dark pixels decide nothing.
                colour * colour + EPSILON as f32
            })
        })
        .collect()
}

/// The picture as it came: its error is its variance.
fn untouched(halves: &Halves, scale: &Plane) -> Candidate {
    let error = smoothed(&halves.variance, scale, halves.size);
    Candidate {
        colour: halves.whole.clone(),
        variance: error.clone(),
        error,
    }
}

/// The filtered picture: the mean of both filtered halves.
fn candidate(halves: &Halves, [first, second]: &Filtered, scale: &Plane) -> Candidate {
    let [a, b] = &halves.halves;
    let pixels = 0..halves.whole.len();
    let by_colour = |of: &dyn Fn(usize, usize) -> f32| -> Plane {
        let pixels = pixels.clone();
        pixels.map(|i| std::array::from_fn(|c| of(i, c))).collect()
    };
    let square = |x: f32| x * x;
    let colour = by_colour(&|i, c| 0.5 * (first[i][c] + second[i][c]));
    let variance = by_colour(&|i, c| 0.25 * square(first[i][c] - second[i][c]));
    let error = by_colour(&|i, c| {
        let crossed = square(first[i][c] - b[i][c]) + square(second[i][c] - a[i][c]);
        // A half has twice the variance of the whole.
        0.5 * crossed - 2.0 * halves.variance[i][c] - variance[i][c]
    });
    Candidate {
        colour,
        error: smoothed(&error, scale, halves.size),
        variance: smoothed(&variance, scale, halves.size),
    }
}

/// Squared errors relative to `scale`, averaged over neighbours.
fn smoothed(plane: &Plane, scale: &Plane, size: [usize; 2]) -> Plane {
    let channel = |c: usize| {
        let pixels = plane.iter().zip(scale);
        let values: Vec<f32> = pixels.map(|(error, scale)| error[c] / scale[c]).collect();
        boxed(&boxed(&values, size, RADIUS), size, RADIUS)
    };
    let smooth = [0, 1, 2].map(channel);
    (0..plane.len())
        .map(|i| smooth.each_ref().map(|channel| channel[i]))
        .collect()
}
