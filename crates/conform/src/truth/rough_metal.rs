//! What a rough metal reflects, of microfacets that reflect once.
//!
//! From the direction i into the direction o, with the half vector m, all from the surface's side,
//!
//! ```text
//! f(o, i) = F(o·m) D(m) G(o, i)/(4 cos θo cos θi)                     (Torrance and Sparrow 1967)
//! D(m) = α²/(π (1 + (α² − 1) cos² θm)²)                               (Trowbridge and Reitz 1975)
//! Λ(ω) = ½ (√(1 + α² tan² θ) − 1)                                     (Walter, Marschner, Li and Torrance 2007)
//! G = 1/((1 + Λ(o)) (1 + Λ(i))) or 1/(1 + Λ(o) + Λ(i))                (Smith 1967; Ross, Dion and Potvin 2005)
//! ```
//!
//! Under an even sky of radiance 1 it shows ∫ f cos θi dωi. With dωi = 4 (o·m) dωm, and with tan² θm = α² u/(1 − u), of which D
//! cos θm dωm is du dφ/2π, that is
//!
//! ```text
//! (1/2π) ∫∫ F G (o·m)/(cos θo cos θm) du dφ,   where i is above the surface
//! ```

use super::interfaces::conductor;
use crate::scene::Masking;
use etalon_math::float64::{cos, sin};
use glam::DVec3;
use std::f64::consts::PI;

/// A metal of index n + ik whose facets have slopes of the width `alpha`; +z is its normal.
#[derive(Clone, Copy, Debug)]
pub struct RoughMetal {
    /// Real part of the index.
    pub n: f64,
    /// Imaginary part.
    pub k: f64,
    /// α.
    pub alpha: f64,
    /// The form of G.
    pub masking: Masking,
}

impl RoughMetal {
    /// f cos θi, for unit vectors above the surface.
    pub fn reflected(&self, o: DVec3, i: DVec3) -> f64 {
        let m = (o + i).normalize();
        let a2 = self.alpha * self.alpha;
        let spread = 1.0 + (a2 - 1.0) * m.z * m.z;
        let d = a2 / (PI * spread * spread);
        conductor(o.dot(m), self.n, self.k) * d * self.unhidden(o.z, i.z) / (4.0 * o.z)
    }

    /// What is seen at this angle from the normal under a sky of radiance 1.
    pub fn under_even_sky(&self, cosine: f64) -> f64 {
        const STEPS: u32 = 512;
        const TURNS: u32 = 256;
        let o = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let (mut sum, a2) = (0.0, self.alpha * self.alpha);
        for index in 0..STEPS * TURNS {
            let u = (f64::from(index / TURNS) + 0.5) / f64::from(STEPS);
            // Half a turn shows the other half.
            let phi = PI * (f64::from(index % TURNS) + 0.5) / f64::from(TURNS);
            let z = (1.0 + a2 * u / (1.0 - u)).sqrt().recip();
            let across = (1.0 - z * z).sqrt();
            let m = DVec3::new(across * cos(phi), across * sin(phi), z);
            let facing = o.dot(m);
            let below = 2.0 * facing * z - cosine;
            if facing > 0.0 && below > 0.0 {
                let f = conductor(facing, self.n, self.k);
                sum += f * self.unhidden(cosine, below) * facing / (cosine * z);
            }
        }
        sum / f64::from(STEPS * TURNS)
    }

    /// G, by the cosines of two angles from the normal.
    fn unhidden(&self, o: f64, i: f64) -> f64 {
        let hidden = |cosine: f64| {
            let tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
            0.5 * ((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0)
        };
        let (o, i) = (hidden(o), hidden(i));
        match self.masking {
            Masking::Separable => 1.0 / ((1.0 + o) * (1.0 + i)),
            Masking::HeightCorrelated => 1.0 / (1.0 + o + i),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RoughMetal;
    use crate::scene::Masking;
    use etalon_math::float64::{cos, sin};
    use glam::DVec3;
    use std::f64::consts::{PI, TAU};

    const METAL: RoughMetal = RoughMetal {
        n: 0.2,
        k: 3.0,
        alpha: 0.5,
        masking: Masking::Separable,
    };

    /// ∫ f cos θi dωi over a grid of incident directions.
    #[test]
    fn a_sky_is_the_sum_of_its_directions() {
        let (rows, columns) = (1500, 1500);
        for masking in [Masking::Separable, Masking::HeightCorrelated] {
            for degrees in [0f64, 60.0] {
                let metal = RoughMetal { masking, ..METAL };
                let angle = degrees.to_radians();
                let o = DVec3::new(sin(angle), 0.0, cos(angle));
                let mut sum = 0.0;
                for index in 0..rows * columns {
                    let z = (f64::from(index / columns) + 0.5) / f64::from(rows);
                    let phi = TAU * (f64::from(index % columns) + 0.5) / f64::from(columns);
                    let across = (1.0 - z * z).sqrt();
                    sum += metal.reflected(o, DVec3::new(across * cos(phi), across * sin(phi), z));
                }
                sum *= TAU / f64::from(rows * columns);
                let found = metal.under_even_sky(cos(angle));
                assert!((found / sum - 1.0).abs() < 2e-5, "{found} {sum}");
            }
        }
    }

    #[test]
    fn both_directions_are_alike() {
        let (a, b) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, -0.8, 0.6));
        let one = METAL.reflected(a, b) / b.z;
        let other = METAL.reflected(b, a) / a.z;
        assert!((one - other).abs() < 1e-15);
    }

    /// Upright, of α = 1 in which D = 1/π and G = 1, a perfect mirror of facets has f = 1/(4π).
    #[test]
    fn the_roughest_is_known() {
        let metal = RoughMetal {
            n: 1e-9,
            alpha: 1.0,
            ..METAL
        };
        let found = metal.reflected(DVec3::Z, DVec3::Z);
        assert!((found - 0.25 / PI).abs() < 1e-9, "{found}");
    }
}
