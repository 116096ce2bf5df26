//! Means over squares of pixels.

/// The mean of each pixel's square of 2 `radius` + 1 pixels, as far as it lies within the picture. Sums are not updated from
/// square to square, so that a single huge value leaves no rounding behind.
pub(super) fn boxed(values: &[f32], [width, height]: [usize; 2], radius: usize) -> Vec<f32> {
    let within = |i: usize, end: usize| (i.saturating_sub(radius), (i + radius + 1).min(end));
    let mut across = vec![0.0; values.len()];
    for (sums, row) in across
        .chunks_exact_mut(width)
        .zip(values.chunks_exact(width))
    {
        for (x, sum) in sums.iter_mut().enumerate() {
            let (from, to) = within(x, width);
            *sum = row[from..to].iter().sum::<f32>() / (to - from) as f32;
        }
    }
    let mut smooth = vec![0.0; values.len()];
    for (y, sums) in smooth.chunks_exact_mut(width).enumerate() {
        let (from, to) = within(y, height);
        for row in across[from * width..to * width].chunks_exact(width) {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += value;
            }
        }
        let share = 1.0 / (to - from) as f32;
        sums.iter_mut().for_each(|sum| *sum *= share);
    }
    smooth
}

#[cfg(test)]
mod tests {
    use super::boxed;

    #[test]
    fn a_square_is_spread_evenly_and_cut_at_the_edge() {
        let mut values = vec![0.0; 5 * 4];
        values[0] = 9.0;
        let smooth = boxed(&values, [5, 4], 1);
        // The corner has four pixels around it, its neighbours six, the next nine.
        let expected = [9.0 / 4.0, 9.0 / 6.0, 0.0, 0.0, 0.0, 9.0 / 6.0, 1.0];
        for (found, known) in smooth.iter().zip(expected) {
            assert!((found - known).abs() < 1e-6, "{smooth:?}");
        }
    }
}
