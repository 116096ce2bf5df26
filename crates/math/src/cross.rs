//! The cross product without cancellation.
//!
//! Each component is a difference of products a·b − c·d, which loses all digits when the two are
//! nearly equal: for the edges of a sliver. With one fused operation for the product's rounding
//! and one for the difference the error stays below 1.5 ulp (Kahan; analysed by Jeannerod,
//! Louvet, Muller 2013, "Further analysis of Kahan's algorithm …", theorem 1.1).

use glam::Vec3;

/// a·b − c·d with an error below 1.5 ulp, barring underflow.
#[inline]
pub fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    let cd = c * d;
    let error = (-c).mul_add(d, cd);
    a.mul_add(b, -cd) + error
}

/// `a` × `b`, each component to 1.5 ulp.
#[inline]
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(
        difference_of_products(a.y, b.z, a.z, b.y),
        difference_of_products(a.z, b.x, a.x, b.z),
        difference_of_products(a.x, b.y, a.y, b.x),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::with_cases(2000) })]
        #[test]
        fn slivers_keep_their_normals(
            x in -1.0f32..1.0, y in -1.0f32..1.0, z in -1.0f32..1.0,
            u in -1.0f32..1.0, v in -1.0f32..1.0, w in -1.0f32..1.0,
        ) {
            let a = Vec3::new(x, y, z);
            let b = a + Vec3::new(u, v, w) * 1e-5;
            let exact = a.as_dvec3().cross(b.as_dvec3());
            let error = (cross(a, b).as_dvec3() - exact).abs();
            let bound = exact.abs() * (2.0 * f64::from(f32::EPSILON)) + 1e-30;
            prop_assert!(error.cmple(bound).all());
        }
    }
}
