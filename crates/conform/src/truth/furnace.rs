//! The grey furnace: a closed surface that emits L_e and reflects the fraction ρ diffusely.
//!
//! L = L_e + ρ L, hence L = L_e / (1 − ρ) everywhere and in every direction (Kirchhoff's law; for
//! renderers: Jensen, *Realistic Image Synthesis Using Photon Mapping*, 2001, section 2.6).

/// L of a closed surface that emits `radiance`.
pub fn closed(radiance: f64, reflectance: f64) -> f64 {
    radiance / (1.0 - reflectance)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_bounces_are_summed() {
        let (mut sum, mut bounce) = (0.0, 3.0);
        for _ in 0..400 {
            sum += bounce;
            bounce *= 0.8;
        }
        assert!((super::closed(3.0, 0.8) - sum).abs() < 1e-12);
    }
}
