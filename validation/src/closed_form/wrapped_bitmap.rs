//! A grey image on four strips of a plane under an even sky of radiance L, far beyond its borders.
//!
//! Texel i of n is i mod n where the image is repeated, the nearer end where it is clamped, and j or
//! 2n − 1 − j with j = i mod 2n where it is mirrored. Between the centres of texels,
//! which are at (i + ½)/n, the reflectance is bilinear, or that of the texel around the point. Rows
//! begin at v = 0. (Mitsuba 3's documentation of `bitmap`.) The bytes of the file are decoded as sRGB.
//!
//! A plane sends back ρ L.

use super::light::{decoded, known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::pixels;
use etalon_render::judge::ExactImage;

/// The bytes of `scenes/wrapped-bitmap/texels.png`.
const TEXELS: [[u8; 4]; 3] = [[40, 200, 120, 255], [90, 0, 230, 160], [180, 70, 20, 140]];

/// Strips from the top.
const STRIPS: u32 = 4;
/// Copies of the image along a strip and across it.
const COPIES: [f64; 2] = [3.0, 2.0];
/// Texture coordinates of a strip's lower left corner.
const FIRST: [f64; 2] = [-1.0, -0.5];

/// The texel in 0..n for texel `i` of the unbounded image.
type Wrap = fn(i64, i64) -> i64;

fn repeat(i: i64, n: i64) -> i64 {
    i.rem_euclid(n)
}

fn mirror(i: i64, n: i64) -> i64 {
    let j = i.rem_euclid(2 * n);
    if j < n { j } else { 2 * n - 1 - j }
}

fn hold(i: i64, n: i64) -> i64 {
    i.max(0).min(n - 1)
}

/// The picture of the strips. Texels must be of an even number of pixels, so that no kink lies within
/// a pixel.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let [width, height] = size;
    if width != height || !width.is_multiple_of(24) {
        return Err("the film must be square, of a multiple of 24 pixels".to_owned());
    }
    let radiance = claim.number("radiance")?;
    let unit = rgb(|_| radiance);
    Ok(known(size, |column, row| {
        let mean = pixels::mean(size, [column, row], |x, y| {
            // From the top of the picture, in strips.
            let down = 0.5 * (1.0 - y) * f64::from(STRIPS);
            let strip = row * STRIPS / height;
            let u = FIRST[0] + COPIES[0] * 0.5 * (x + 1.0);
            let v = FIRST[1] + COPIES[1] * (f64::from(strip + 1) - down);
            match strip {
                0 => bilinear(u, v, repeat),
                1 => bilinear(u, v, mirror),
                2 => bilinear(u, v, hold),
                _ => nearest(u, v, repeat),
            }
        });
        unit.map(|c| c * mean)
    }))
}

fn bilinear(u: f64, v: f64, wrap: Wrap) -> f64 {
    let (x, y) = (4.0 * u - 0.5, 3.0 * v - 0.5);
    let (s, t) = (x - x.floor(), y - y.floor());
    let at = |i: f64, j: f64| texel(x.floor() + i, y.floor() + j, wrap);
    (1.0 - t) * ((1.0 - s) * at(0.0, 0.0) + s * at(1.0, 0.0))
        + t * ((1.0 - s) * at(0.0, 1.0) + s * at(1.0, 1.0))
}

fn nearest(u: f64, v: f64, wrap: Wrap) -> f64 {
    texel((4.0 * u).floor(), (3.0 * v).floor(), wrap)
}

fn texel(i: f64, j: f64, wrap: Wrap) -> f64 {
    let (i, j) = (wrap(i as i64, 4) as usize, wrap(j as i64, 3) as usize);
    decoded(TEXELS[j][i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folders;

    #[test]
    fn the_table_is_the_file() {
        let path = folders::scenes().join("wrapped-bitmap/texels.png");
        let bytes = std::fs::read(&path).expect("the bitmap of a claim");
        let raster = etalon_images::raster_file::decode(&bytes, &path).expect("a picture");
        let expected: Vec<f32> = TEXELS
            .iter()
            .flatten()
            .map(|b| f32::from(*b) / 255.0)
            .collect();
        assert_eq!(raster.to_floats(), expected);
    }

    #[test]
    fn beyond_the_border_is_what_the_mode_says() {
        let row = |wrap: Wrap| (-4..8).map(|i| wrap(i, 3)).collect::<Vec<i64>>();
        assert_eq!(row(repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(row(mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
        assert_eq!(row(hold), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
    }

    #[test]
    fn centres_of_texels_are_the_texels() {
        // 255 is 1 and 0 is 0; 128/255 would be 0.2158605.
        assert_eq!(bilinear(3.5 / 4.0, 0.5 / 3.0, repeat), 1.0);
        assert_eq!(nearest(1.2 / 4.0, 1.9 / 3.0, repeat), 0.0);
        let half = bilinear(4.0 / 4.0, 0.5 / 3.0, hold);
        assert_eq!(half, 1.0);
        let seam = bilinear(4.0 / 4.0, 0.5 / 3.0, repeat);
        assert!((seam - 0.5 * (1.0 + texel(0.0, 0.0, repeat))).abs() < 1e-15);
    }
}
