//! The table of fitted coefficients, and its interpolation.
//!
//! Jakob and Hanika tabulate the coefficients over (brightest component z, the two others divided
//! by z). Two properties of the fit make a smaller table do: the spectrum of the complement 1 − rgb
//! is one minus the spectrum of rgb, so c(1 − rgb) = −c(rgb) and only colours with
//! max + min ≤ 1 are looked up; and c grows as z^(−1/2) towards black, so c √z is stored, which
//! has a limit there. In between the tensor product of cubic Lagrange polynomials on the four
//! nearest nodes interpolates.

use super::fit::Fitter;

/// Nodes along each axis.
pub const RESOLUTION: usize = 41;

/// Number of values: three brightest components, the nodes, three coefficients.
pub const LENGTH: usize = 3 * RESOLUTION * RESOLUTION * RESOLUTION * 3;

/// Values between nodes that are neighbours along z, y and x.
const STRIDE: [usize; 3] = [RESOLUTION * RESOLUTION * 3, RESOLUTION * 3, 3];

/// Bytes that may be read as single-precision numbers.
#[repr(C, align(64))]
struct Aligned<T: ?Sized>(T);

#[cfg(not(target_endian = "little"))]
compile_error!("the coefficient table is stored little-endian and read in place");

static BYTES: &Aligned<[u8; 4 * LENGTH]> = &Aligned(*include_bytes!("../../data/rgb2spec.bin"));

/// The table of the repository, read in place.
pub(crate) fn shipped() -> &'static [f32] {
    bytemuck::cast_slice(&BYTES.0)
}

/// √z at the place `u` in [0, 1] of the first axis, the inverse of u = z^¼/(z^¼ + √(1 − z)): dense
/// near black, where coefficients change slowly but without end, and near full brightness.
fn root_of_brightness(u: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for _ in 0..60 {
        let fourth_root = 0.5 * (low + high);
        let squared = fourth_root * fourth_root;
        let place = fourth_root / (fourth_root + (1.0 - squared * squared).sqrt());
        if place < u {
            low = fourth_root;
        } else {
            high = fourth_root;
        }
    }
    let fourth_root = if u >= 1.0 { 1.0 } else { 0.5 * (low + high) };
    fourth_root * fourth_root
}

/// The ratio of a component to the brightest one at the place `u` in [0, 1] of the other axes:
/// denser near saturated colours.
fn ratio(u: f64) -> f64 {
    0.5 * (u + u * u)
}

/// Inverse of [`root_of_brightness`], from z.
#[inline]
fn place_of_brightness(z: f32) -> f32 {
    let fourth_root = z.sqrt().sqrt();
    fourth_root / (fourth_root + (1.0 - z).sqrt())
}

/// Inverse of [`ratio`].
#[inline]
fn place_of_ratio(x: f32) -> f32 {
    0.5 * ((1.0 + 8.0 * x).sqrt() - 1.0)
}

/// Coefficients of a colour that is not grey, components in [0, 1].
#[inline]
pub(crate) fn lookup(table: &[f32], rgb: [f32; 3]) -> [f32; 3] {
    let max = rgb[0].max(rgb[1]).max(rgb[2]);
    let min = rgb[0].min(rgb[1]).min(rgb[2]);
    if max + min <= 1.0 {
        lookup_dark(table, rgb, max)
    } else {
        lookup_dark(table, rgb.map(|v| 1.0 - v), 1.0 - min).map(|c| -c)
    }
}

/// Coefficients of a colour with max + min ≤ 1, whose greatest component is `max` > 0.
#[inline]
fn lookup_dark(table: &[f32], rgb: [f32; 3], max: f32) -> [f32; 3] {
    let brightest = if rgb[0] == max {
        0
    } else if rgb[1] == max {
        1
    } else {
        2
    };
    let x = rgb[(brightest + 1) % 3] / max;
    let y = rgb[(brightest + 2) % 3] / max;
    let (k, wz) = cubic(place_of_brightness(max));
    let (j, wy) = cubic(place_of_ratio(y));
    let (i, wx) = cubic(place_of_ratio(x));
    let corner = brightest * RESOLUTION * STRIDE[0] + k * STRIDE[0] + j * STRIDE[1] + i * STRIDE[2];
    // One slice that holds all 4³ nodes, so that bounds are checked once.
    let nodes = &table[corner..corner + 3 * STRIDE[0] + 3 * STRIDE[1] + 12];
    // Sums over z and y of the four nodes along x, three coefficients each.
    let mut row = [0.0_f32; 12];
    for (a, weight_z) in wz.iter().enumerate() {
        for (b, weight_y) in wy.iter().enumerate() {
            let weight = weight_z * weight_y;
            let start = a * STRIDE[0] + b * STRIDE[1];
            for (sum, value) in row.iter_mut().zip(&nodes[start..start + 12]) {
                *sum += weight * value;
            }
        }
    }
    let inverse_root = 1.0 / max.sqrt();
    std::array::from_fn(|c| {
        (wx[0] * row[c] + wx[1] * row[3 + c] + wx[2] * row[6 + c] + wx[3] * row[9 + c])
            * inverse_root
    })
}

/// First of four neighbouring nodes around the place `u` in [0, 1], and their Lagrange weights.
#[inline]
fn cubic(u: f32) -> (usize, [f32; 4]) {
    let t = u * (RESOLUTION - 1) as f32;
    let first = (t as usize).clamp(1, RESOLUTION - 3) - 1;
    let f = t - first as f32;
    let (a, b, c) = (f - 1.0, f - 2.0, f - 3.0);
    let weights = [
        a * b * c * (-1.0 / 6.0),
        f * b * c * 0.5,
        f * a * c * -0.5,
        f * a * b * (1.0 / 6.0),
    ];
    (first, weights)
}

/// The colour of a node, with the indices of its brightest component, z, y and x.
pub fn node_colour(brightest: usize, [k, j, i]: [usize; 3]) -> [f64; 3] {
    let last = (RESOLUTION - 1) as f64;
    let root = root_of_brightness(k as f64 / last);
    colour(
        brightest,
        root,
        ratio(j as f64 / last),
        ratio(i as f64 / last),
    )
}

fn colour(brightest: usize, root: f64, y: f64, x: f64) -> [f64; 3] {
    let z = root * root;
    let mut rgb = [0.0; 3];
    rgb[brightest] = z;
    rgb[(brightest + 1) % 3] = x * z;
    rgb[(brightest + 2) % 3] = y * z;
    rgb
}

/// Fits the whole table: [`LENGTH`] values c √z, ordered by brightest component, z, y, x and
/// coefficient. The same bits on every machine; some seconds.
pub fn build() -> Vec<f32> {
    let fitter = Fitter::new();
    let mut table = vec![0.0; LENGTH];
    for brightest in 0..3 {
        for j in 0..RESOLUTION {
            for i in 0..RESOLUTION {
                let column = fit_column(&fitter, brightest, j, i);
                for (k, stored) in column.iter().enumerate() {
                    let at = ((brightest * RESOLUTION + k) * RESOLUTION + j) * RESOLUTION + i;
                    table[3 * at..3 * at + 3].copy_from_slice(&stored.map(|v| v as f32));
                }
            }
        }
    }
    table
}

/// c √z at every node of one column along z, each fit begun at its neighbour's result, from the
/// middle outwards.
fn fit_column(fitter: &Fitter, brightest: usize, j: usize, i: usize) -> Vec<[f64; 3]> {
    let last = (RESOLUTION - 1) as f64;
    let (y, x) = (ratio(j as f64 / last), ratio(i as f64 / last));
    let fit = |root: f64, start: [f64; 3]| {
        let rgb = colour(brightest, root, y, x);
        let begin = start.map(|v| v / root);
        fitter.fit(rgb, begin).coefficients.map(|v| v * root)
    };
    let middle = RESOLUTION / 2;
    let mut column = vec![[0.0; 3]; RESOLUTION];
    let mut start = [0.0; 3];
    for (k, node) in column.iter_mut().enumerate().skip(middle) {
        start = fit(root_of_brightness(k as f64 / last), start);
        *node = start;
    }
    start = column[middle];
    for (k, node) in column.iter_mut().enumerate().take(middle).skip(1).rev() {
        start = fit(root_of_brightness(k as f64 / last), start);
        *node = start;
    }
    // Black itself has no finite coefficients: its node holds those of z = 10⁻⁸.
    column[0] = fit(1e-4, start);
    column
}
