//! The pile of plates: a wall of radiance L seen through m smooth interfaces that absorb nothing.
//!
//! With R(θ) the reflectance of one interface, all reflections between all of them summed:
//!
//! T = (1 − R)/(1 + (m − 1) R),   radiance L T
//!
//! (Stokes, "On the intensity of the light reflected from or transmitted through a pile of plates",
//! *Proceedings of the Royal Society* 11, 1862.) A plate is two interfaces, and thin panes are
//! plates. Stokes has this for either polarisation; a renderer that forgets it between interfaces
//! has it for R = ½ (R_s + R_p), Fresnel's equations for natural light. θ is the same in all gaps.

use super::light::{known, rgb};
use super::pixels;
use crate::claim::Claim;
use etalon_math::float64::tan;
use etalon_render::judge::ExactImage;

/// The camera's angle of view (degrees); it looks at the plates at right angles.
const FIELD_OF_VIEW: f64 = 80.0;
/// Interfaces: three plates.
const INTERFACES: u32 = 6;

/// The picture of the wall.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    if size[0] != size[1] {
        return Err("the angle of view is that of a square film".to_owned());
    }
    let (radiance, index) = (claim.number("radiance")?, claim.number("index")?);
    let unit = rgb(|_| radiance);
    let slope = tan(0.5 * FIELD_OF_VIEW.to_radians());
    Ok(known(size, |column, row| {
        let mean = pixels::mean(size, [column, row], |x, y| {
            let cosine = 1.0 / (1.0 + slope * slope * (x * x + y * y)).sqrt();
            transmittance(reflectance(cosine, index), INTERFACES)
        });
        unit.map(|c| c * mean)
    }))
}

/// R of an interface to the relative index `index` for natural light.
pub fn reflectance(cosine: f64, index: f64) -> f64 {
    // The index times the cosine behind the interface, by Snell's law.
    let behind = (index * index - 1.0 + cosine * cosine).sqrt();
    let s = (cosine - behind) / (cosine + behind);
    let p = (index * index * cosine - behind) / (index * index * cosine + behind);
    0.5 * (s * s + p * p)
}

/// T of `interfaces` interfaces that reflect the fraction `r` each.
fn transmittance(r: f64, interfaces: u32) -> f64 {
    (1.0 - r) / (1.0 + f64::from(interfaces - 1) * r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_math::float64::cos;

    #[test]
    fn one_interface_is_fresnels() {
        // n = 1.5 at 0°, 30°, 45° and 60°, by mpmath.
        let numbers = [
            (0.0, 0.04),
            (30.0, 0.041_522_625_975_821_5),
            (45.0, 0.050_239_911_012_235_9),
            (60.0, 0.089_186_712_802_212_7),
        ];
        for (degrees, expected) in numbers {
            let found = reflectance(cos(f64::to_radians(degrees)), 1.5);
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn plates_are_added_one_by_one() {
        // Light that goes to and fro between what is there and one more interface:
        // T' = T t/(1 − R r), a geometric series.
        for r in [0.04, 0.3, 0.9] {
            let mut through = 1.0 - r;
            for interfaces in 2..12 {
                let back = 1.0 - through;
                through = through * (1.0 - r) / (1.0 - back * r);
                assert!((transmittance(r, interfaces) - through).abs() < 1e-14);
            }
        }
        // Window glass passes 92.3 %, three panes of it 80 %.
        assert!((transmittance(0.04, 2) - 12.0 / 13.0).abs() < 1e-15);
        assert!((transmittance(0.04, 6) - 0.8).abs() < 1e-15);
    }
}
