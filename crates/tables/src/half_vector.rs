//! Importance sampling of isotropic BRDFs by their half vectors: a lobe about the normal, and a diffuse share.
//!
//! ```text
//! p(ωi) = (1 − c) p(θh) / (4 ωo·h) + c cos θi / π
//! ```
//!
//! p(θh), per solid angle, is constant in each of 90 rings, whose borders are MERL's, θ = (k/90)² π/2: fine at the
//! normal, where lobes are. Its ring has the mean of the BRDF over some difference angles less the level of the rim,
//! times cos θh; c, the diffuse share, is what the level reflects over what both do.

use crate::BrdfTableError;
use core::f32::consts::{FRAC_1_PI, FRAC_PI_2, TAU};
use etalon_math::float;
use etalon_math::reflection::{half_way, reflect};
use etalon_sampling::discrete::PiecewiseConstant;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Rings of half vectors.
const RINGS: usize = 90;

/// Bounds of the diffuse share: never without either part.
const SHARE: [f64; 2] = [0.1, 0.95];

/// The distribution for one BRDF.
#[derive(Clone, Debug)]
pub struct HalfVectors {
    rings: PiecewiseConstant,
    /// 1 − cos θ at the borders.
    borders: Vec<f32>,
    diffuse: f32,
}

/// The border `k` of the rings.
fn border(k: f32) -> f32 {
    let x = k / RINGS as f32;
    x * x * FRAC_PI_2
}

/// Two directions by their half vector at `theta_h` from the normal, in the xz plane, and the difference of `wi`
/// from it: `theta_d` away, at the azimuth `phi_d` (Rusinkiewicz 1998).
pub fn directions(theta_h: f32, theta_d: f32, phi_d: f32) -> [Vec3; 2] {
    let ((sh, ch), (sd, cd)) = (float::sin_cos(theta_h), float::sin_cos(theta_d));
    let (sp, cp) = float::sin_cos(phi_d);
    let half = Vec3::new(sh, 0.0, ch);
    let across = Vec3::new(ch, 0.0, -sh) * (sd * cp) + Vec3::Y * (sd * sp);
    [half * cd - across, half * cd + across]
}

/// θh, θd and φd of two directions (Rusinkiewicz 1998); φd in [0, π), since exchanging the directions adds π.
#[inline]
pub fn angles(wo: Vec3, wi: Vec3) -> Option<[f32; 3]> {
    let (half, cos) = half_way(wo, wi)?;
    let across = half.truncate().length();
    let (x, y) = if across > 0.0 {
        let along = half.truncate() / across;
        let tangent = (along * half.z).extend(-across);
        (wi.dot(tangent), wi.y * along.x - wi.x * along.y)
    } else {
        (wi.x, wi.y)
    };
    let theta_d = float::atan2(Vec2::new(x, y).length(), cos);
    let mut phi_d = float::atan2(y, x);
    if phi_d < 0.0 {
        phi_d += core::f32::consts::PI;
    }
    Some([float::atan2(across, half.z), theta_d, phi_d])
}

impl HalfVectors {
    /// The distribution for the BRDF `brdf`, a function of wo and wi without the cosine.
    ///
    /// # Errors
    /// If it is zero everywhere.
    pub fn new(brdf: impl Fn(Vec3, Vec3) -> f32) -> Result<Self, BrdfTableError> {
        let mean = |k: usize| {
            let mut sum = [0.0f64; 2];
            for theta_d in [0.05, 0.25, 0.5, 0.8] {
                for phi_d in [0.0, 0.8, 1.6, 2.4] {
                    let [wo, wi] = directions(border(k as f32 + 0.5), theta_d, phi_d);
                    if wo.z > 0.0 && wi.z > 0.0 {
                        sum[0] += f64::from(brdf(wo, wi).max(0.0));
                        sum[1] += 1.0;
                    }
                }
            }
            if sum[1] > 0.0 { sum[0] / sum[1] } else { 0.0 }
        };
        let means: Vec<f64> = (0..RINGS).map(mean).collect();
        let seen = means.iter().copied().filter(|&mean| mean > 0.0);
        let level = seen.fold(f64::INFINITY, f64::min);
        if !level.is_finite() {
            return Err(BrdfTableError::new("the table reflects nothing"));
        }
        let borders: Vec<f32> = (0..=RINGS)
            .map(|k| {
                let half = float::sin(0.5 * border(k as f32));
                2.0 * half * half
            })
            .collect();
        let mut weights: Vec<f64> = (means.iter().zip(borders.windows(2)))
            .map(|(mean, z)| {
                let cos = 1.0 - 0.5 * f64::from(z[0] + z[1]);
                (mean - level).max(0.0) * f64::from(z[1] - z[0]) * cos
            })
            .collect();
        // A lobe D(h) F G / (4 cos cos) has the mean f ≈ D / 4 and reflects ∫D cos dω.
        let lobe: f64 = weights.iter().sum::<f64>() * 4.0 * core::f64::consts::TAU;
        let flat = level * core::f64::consts::PI;
        let diffuse = if lobe > 0.0 {
            flat / (flat + lobe)
        } else {
            1.0
        };
        if lobe == 0.0 {
            weights = vec![1.0; RINGS];
        }
        let rings = PiecewiseConstant::new(&weights);
        Ok(Self {
            rings: rings.map_err(|e| BrdfTableError::new(e.to_string()))?,
            borders,
            diffuse: diffuse.clamp(SHARE[0], SHARE[1]) as f32,
        })
    }

    /// The density of `wi`, per solid angle.
    #[inline]
    pub fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        let Some((half, cos)) = half_way(wo, wi) else {
            return 0.0;
        };
        let lobe = self.normal_density(half) / (4.0 * cos);
        lobe + self.diffuse * (wi.z * FRAC_1_PI - lobe)
    }

    /// p(θh).
    #[inline]
    fn normal_density(&self, half: Vec3) -> f32 {
        let z = half.truncate().length_squared() / (1.0 + half.z);
        let ring = self.borders.partition_point(|&border| border <= z);
        let ring = ring.clamp(1, RINGS) - 1;
        let area = TAU * (self.borders[ring + 1] - self.borders[ring]);
        self.rings.probability(ring) as f32 / area
    }

    /// A direction for the known `wo`, which may lie below the surface.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Vec3 {
        if u_lobe < self.diffuse {
            return square_to_cosine_hemisphere(u);
        }
        let (ring, place) = self.rings.choose(f64::from(u.x));
        let (from, to) = (self.borders[ring], self.borders[ring + 1]);
        let z = from + (to - from) * place as f32;
        let (y, x) = float::sin_cos(TAU * u.y);
        let sin = (z * (2.0 - z)).max(0.0).sqrt();
        reflect(wo, Vec3::new(sin * x, sin * y, 1.0 - z))
    }
}
