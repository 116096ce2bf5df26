//! Gradient noise in space (K. Perlin 2002, *Improving Noise*, with hashed lattice points).
//!
//! ```text
//! n(p) = Σ over the 8 lattice points q around p:  w(p − q) · g(q)·(p − q)
//! w(d) = Π (1 − s(|dᵢ|)),   s(t) = 6t⁵ − 15t⁴ + 10t³
//! ```
//!
//! with g(q) one of the 12 directions to the middles of a cube's edges. n is twice continuously differentiable,
//! vanishes on the lattice, and lies in [−1, 1].

use glam::DVec3;

/// No partial derivative of [`noise`] is greater: along an axis a difference of two faces, at most 2, is faded with
/// s' ≤ 15/8, and g adds 1.
pub const LARGEST_SLOPE: f64 = 1.0 + 2.0 * 15.0 / 8.0;

/// No second partial derivative is greater: along one axis s'' ≤ 10/√3 times 2 and 2 s' times a difference of slopes,
/// at most 2, which is 19.1; along two 4 s' for the slopes of g and s' times a difference of derivatives, at most
/// 2 [`LARGEST_SLOPE`], and as much as the slopes of g again, which is 29.1.
pub const LARGEST_CURVATURE: f64 = 30.0;

/// No difference is greater than this times the distance.
pub const LIPSCHITZ: f64 = LARGEST_SLOPE * 1.732_050_807_568_877_3;

/// n(p).
pub fn noise(p: DVec3) -> f64 {
    noise_and_gradient(p).0
}

/// n(p) and ∇n(p).
pub fn noise_and_gradient(p: DVec3) -> (f64, DVec3) {
    let cell = p.floor();
    let d = p - cell;
    let fade = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);
    let slope = 30.0 * d * d * (d * (d - 2.0) + 1.0);
    let (mut value, mut gradient) = (0.0, DVec3::ZERO);
    for corner in 0..8u32 {
        let high = DVec3::new(
            f64::from(corner & 1),
            f64::from(corner >> 1 & 1),
            f64::from(corner >> 2),
        );
        let g = direction(cell + high);
        let linear = g.dot(d - high);
        // fade toward the high corner, 1 − fade toward the low one.
        let w = (1.0 - high) + (2.0 * high - 1.0) * fade;
        let dw = (2.0 * high - 1.0) * slope;
        let weight = w.x * w.y * w.z;
        value += weight * linear;
        gradient +=
            weight * g + linear * DVec3::new(dw.x * w.y * w.z, w.x * dw.y * w.z, w.x * w.y * dw.z);
    }
    (value, gradient)
}

/// Bounds of n within `half` of `p` along each axis: by the slope at `p` and [`LARGEST_CURVATURE`], or by [`LARGEST_SLOPE`].
pub fn noise_within(p: DVec3, half: DVec3) -> [f64; 2] {
    let (value, gradient) = noise_and_gradient(p);
    let reach = half.element_sum();
    let bent = gradient.abs().dot(half) + 0.5 * LARGEST_CURVATURE * reach * reach;
    let off = bent.min(LARGEST_SLOPE * reach);
    [(value - off).max(-1.0), (value + off).min(1.0)]
}

/// A lattice point's own random number.
pub fn lattice_hash(q: DVec3) -> u32 {
    // As integers; far away, where there are no such integers, the noise repeats the last ones.
    let [x, y, z] = [q.x, q.y, q.z].map(|x| x as i64 as u64);
    let mut h = x.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ y.wrapping_mul(0xc2b2_ae3d_27d4_eb4f).rotate_left(21)
        ^ z.wrapping_mul(0x1656_67b1_9e37_79f9).rotate_left(42);
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (h >> 32) as u32
}

/// g(q).
fn direction(q: DVec3) -> DVec3 {
    let h = lattice_hash(q);
    let sign = |bit: u32| if h >> bit & 1 == 0 { 1.0 } else { -1.0 };
    // Three planes, evenly: the product's high half.
    match (u64::from(h) * 3) >> 32 {
        0 => DVec3::new(sign(0), sign(1), 0.0),
        1 => DVec3::new(sign(0), 0.0, sign(1)),
        _ => DVec3::new(0.0, sign(0), sign(1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-50.0..50.0f64).prop_map(DVec3::from)
    }

    proptest! {
        #[test]
        fn differences_keep_to_the_bound(a in point(), b in point(), near in 1e-3..1.0f64) {
            let b = a + (b - a) * near * 0.02;
            let off = (noise(a) - noise(b)).abs();
            prop_assert!(off <= LIPSCHITZ * (a - b).length() + 1e-12);
            prop_assert!(noise(a).abs() <= 1.0);
        }

        #[test]
        fn gradient_is_that_of_the_value(p in point()) {
            let (_, gradient) = noise_and_gradient(p);
            for axis in DVec3::AXES {
                let slope = (noise(p + axis * 1e-5) - noise(p - axis * 1e-5)) / 2e-5;
                prop_assert!((slope - gradient.dot(axis)).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn it_vanishes_on_the_lattice_and_varies_between() {
        assert_eq!(noise(DVec3::new(3.0, -7.0, 0.0)), 0.0);
        let values: Vec<f64> = (0..1000)
            .map(|i| noise(DVec3::new(0.37, 0.61, 0.29) * f64::from(i)))
            .collect();
        let mean = values.iter().sum::<f64>() / 1000.0;
        let square = values.iter().map(|v| v * v).sum::<f64>() / 1000.0;
        assert!(
            mean.abs() < 0.05 && (0.03..0.15).contains(&square),
            "{mean} {square}"
        );
    }
}
