//! Means over pixels, by Gauss and Legendre's rule with 4 × 4 points.

/// Nodes on [−1, 1] and their weights, halved (Abramowitz and Stegun 1964, table 25.4).
const RULE: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.173_927_422_568_726_93),
    (-0.339_981_043_584_856_26, 0.326_072_577_431_273_07),
    (0.339_981_043_584_856_26, 0.326_072_577_431_273_07),
    (0.861_136_311_594_052_6, 0.173_927_422_568_726_93),
];

/// The mean of `f` over the pixel (`column`, `row`) of a film of `size`. The film's coordinates
/// run from −1 to 1 to the right, and by as much per pixel upward, with 0 in the centre.
pub fn mean(size: [u32; 2], [column, row]: [u32; 2], f: impl Fn(f64, f64) -> f64) -> f64 {
    let [width, height] = size.map(f64::from);
    let mut sum = 0.0;
    for (u, wu) in RULE {
        for (v, wv) in RULE {
            let x = (2.0 * f64::from(column) + 1.0 + u - width) / width;
            let y = (height - 2.0 * f64::from(row) - 1.0 - v) / width;
            sum += wu * wv * f(x, y);
        }
    }
    sum
}

/// As [`mean`], with the rule in each of `cells` × `cells` parts of the pixel: for functions with
/// kinks.
pub fn mean_of_cells(
    size: [u32; 2],
    [column, row]: [u32; 2],
    cells: u32,
    f: impl Fn(f64, f64) -> f64,
) -> f64 {
    let fine = size.map(|n| n * cells);
    let sum: f64 = (0..cells * cells)
        .map(|i| {
            let cell = [column * cells + i % cells, row * cells + i / cells];
            mean(fine, cell, &f)
        })
        .sum();
    sum / f64::from(cells * cells)
}

#[cfg(test)]
mod tests {
    use super::{mean, mean_of_cells};

    #[test]
    fn cells_make_up_the_pixel() {
        let f = |x: f64, y: f64| x * x - 3.0 * x * y;
        let (whole, parts) = (mean([6, 4], [4, 1], f), mean_of_cells([6, 4], [4, 1], 3, f));
        assert!((whole - parts).abs() < 1e-14);
        // |x| over the pixel from −1/3 to 1/3.
        let kink = mean_of_cells([3, 3], [1, 1], 2, |x, _| x.abs());
        assert!((kink - 1.0 / 6.0).abs() < 1e-14);
    }

    #[test]
    fn polynomials_are_exact() {
        // Pixel (3, 0) of 4 × 2: x from 0.5 to 1, y from 0 to 0.5.
        let found = mean([4, 2], [3, 0], |x, y| x * x * x * y + 1.0);
        let expected = (1.0 - 0.0625) / 4.0 / 0.5 * 0.25 + 1.0;
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}
