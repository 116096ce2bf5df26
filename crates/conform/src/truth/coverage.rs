//! How much of each pixel a rectangle covers whose sides are parallel to the pixels': the product of two overlaps of intervals,
//! by the definition of a box filter.
//!
//! A pinhole with the field of view φ sees the point (X, Y) of the plane at the distance D at X/(D tan ½φ) on the film, whose
//! ends are at ±1 (Brunelleschi, about 1415); parallel rays over the width w see it at 2X/w.

use super::Picture;

/// How much of the pixel lies between two ends, counted in pixels.
pub fn part(pixel: u32, [first, last]: [f64; 2]) -> f64 {
    let start = f64::from(pixel);
    (last.min(start + 1.0) - first.max(start)).max(0.0)
}

/// The picture of a rectangle of radiance 1 whose ends are at these x and y on the film: see [`Picture::of`].
pub fn rectangle(pixels: u32, [left, right]: [f64; 2], [bottom, top]: [f64; 2]) -> Picture {
    let half = 0.5 * f64::from(pixels);
    let columns = [left, right].map(|x| half * (1.0 + x));
    let rows = [top, bottom].map(|y| half * (1.0 - y));
    let at = |i: u32| part(i % pixels, columns) * part(i / pixels, rows);
    Picture::exact(pixels, (0..pixels * pixels).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::{part, rectangle};

    #[test]
    fn pixels_at_the_ends_are_covered_in_part() {
        let covered: Vec<f64> = (0..4).map(|i| part(i, [0.75, 2.5])).collect();
        assert_eq!(covered, [0.25, 1.0, 0.5, 0.0]);
        assert_eq!(part(1, [1.25, 1.5]), 0.25);
    }

    #[test]
    fn the_top_row_is_first() {
        // The left half of the upper quarter of 4 × 4 pixels.
        let picture = rectangle(4, [-1.0, 0.0], [0.5, 1.0]);
        assert_eq!(picture.means[..4], [1.0, 1.0, 0.0, 0.0]);
        assert_eq!(picture.mean(), 0.125);
    }
}
