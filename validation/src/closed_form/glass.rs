//! Radiance in glass: what refraction keeps is L/n², the radiance over the square of the index.
//!
//! - A wall of radiance L in a medium of index n₂ behind a smooth plane, seen from one of index n₁:
//!   L (1 − R(θ)) (n₁/n₂)², with R by Fresnel's equations for natural light and θ the angle at the
//!   camera's side. Light that leaves glass is dimmed by n², light that enters it gains n².
//! - Within glass of index n in equilibrium with a sky of radiance L: n² L in every direction.
//!   What the surface keeps back of the sky's light it keeps in of the glass's.
//!
//! (Clausius, "Über die Concentration von Wärme- und Lichtstrahlen", *Annalen der Physik* 197, 1864;
//! Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, section 5.2.)

use super::light::{known, rgb};
use crate::claim::Claim;
use etalon_conform::truth::interfaces::reflectance;
use etalon_conform::truth::pixels;
use etalon_math::float64::tan;
use etalon_render::judge::ExactImage;

/// The camera's angle of view (degrees); it looks at the plane at right angles.
const FIELD_OF_VIEW: f64 = 50.0;

/// The picture of a wall in one medium from another.
pub fn window(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    if size[0] != size[1] {
        return Err("the angle of view is that of a square film".to_owned());
    }
    let index = claim.number("behind")? / claim.number("before")?;
    let slope = tan(0.5 * FIELD_OF_VIEW.to_radians());
    // At the corners of the picture.
    if 2.0 * slope * slope / (1.0 + 2.0 * slope * slope) >= index * index {
        return Err("the plane must not reflect totally: the formula is for what it passes".into());
    }
    let radiance = claim.number("radiance")?;
    let unit = rgb(|_| radiance / (index * index));
    Ok(known(size, |column, row| {
        let mean = pixels::mean(size, [column, row], |x, y| {
            let cosine = 1.0 / (1.0 + slope * slope * (x * x + y * y)).sqrt();
            1.0 - reflectance(cosine, index)
        });
        unit.map(|c| c * mean)
    }))
}

/// The picture of a sky from within glass.
pub fn furnace(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
    let (radiance, index) = (claim.number("radiance")?, claim.number("index")?);
    let colour = rgb(|_| radiance * index * index);
    Ok(known(size, |_, _| colour))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(before: f64, behind: f64) -> Claim {
        toml::from_str(&format!(
            "title = \"\"\nscene = \"\"\nestimators = []\n[defines]\nradiance = 1.0\n\
             before = {before:?}\nbehind = {behind:?}\n\
             [oracle]\nkind = \"closed_form\"\nformula = \"\"\n"
        ))
        .expect("a claim")
    }

    #[test]
    fn there_and_back_is_a_pane() {
        // In the middle θ is 0 on both sides: (1 − R)² without the indices.
        let middle = |before, behind| {
            let known = window(&claim(before, behind), [101, 101]).expect("numbers");
            let unit = rgb(|_| 1.0)[1];
            known.channels[1].1[50 * 101 + 50] / unit
        };
        let (into, out) = (middle(1.5, 1.0), middle(1.0, 1.5));
        assert!((into * out - 0.96 * 0.96).abs() < 1e-5, "{into} {out}");
        assert!((into - 2.25 * 0.96).abs() < 1e-5, "{into}");
    }

    #[test]
    fn total_reflection_is_refused() {
        assert!(window(&claim(2.5, 1.0), [4, 4]).is_err());
        assert!(window(&claim(1.0, 2.5), [4, 4]).is_ok());
    }
}
