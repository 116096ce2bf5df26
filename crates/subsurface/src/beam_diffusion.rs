//! `beamdiffusion`: photon beam diffusion. Light enters at a right angle, and is scattered all along the way down,
//!
//! ```text
//! R(r) = ∫₀^∞ α'² σ't e^(−σ't z) κ(z) (C_φ φ(z) + C_E E(z)) dz  +  R₁(r)
//! ```
//!
//! where from each depth z it diffuses as from a source there and a negative one at 2z_b − z, the fluence φ and the irradiance E being
//! theirs (R. Habel, P. H. Christensen, W. Jarosz, Photon beam diffusion, 2013, eqs. 5, 6, 10 and 13; with D = (2σa + σ's)/(3σ't²) of
//! C. C. Grosjean 1956 and the factors of E. d'Eon, G. Irving, A quantized-diffusion model for rendering translucent materials, 2011),
//! and κ = 1 − e^(−2σ't (d + z)) dampens what is too near the surface for diffusion. R₁ is the light that is scattered once, integrated
//! along the beam as it leaves through the boundary (ibid., eq. 15).
//!
//! In units of the mean free path the profile depends on the albedo, the mean cosine and the index only: a table of profiles
//! for 64 albedos is computed when a scene is read.

use crate::HenyeyGreenstein;
use crate::profile_model::{Boundary, Matter, ProfileModel, Radial};
use crate::rotational::Rotational;
use core::f64::consts::{PI, TAU};
use etalon_math::{float64, fresnel};
use etalon_sampling::discrete::PiecewiseLinear;
use std::sync::Arc;

/// Albedos of the table.
const ALBEDOS: usize = 64;

/// Distances of a profile.
const DISTANCES: usize = 80;

/// Depths along the beam.
const DEPTHS: usize = 96;

/// Concentration of the albedos toward 1, where profiles change most.
const CROWDING: f64 = 8.0;

/// Profiles by albedo, in mean free paths. Cloning shares them.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamDiffusion {
    /// 2πr R, normalised, and its integral.
    rows: Arc<[(PiecewiseLinear, f64)]>,
}

impl ProfileModel for BeamDiffusion {
    type Lane<'a> = Beam<'a>;
    const OF_HALF_SPACE: bool = true;

    fn at(&self, matter: &Matter, _: &Boundary) -> Beam<'_> {
        self.of(matter)
    }
}

/// The profile of one matter.
#[derive(Clone, Copy, Debug)]
pub struct Beam<'a> {
    rows: [&'a (PiecewiseLinear, f64); 2],
    /// The light of each row.
    shares: [f64; 2],
    /// σt (m⁻¹).
    extinction: f64,
}

/// Moments of internal Fresnel reflection: 2∫F μ dμ and 3∫F μ² dμ.
fn moments(eta: f32) -> [f64; 2] {
    let count = 4096;
    let mut sums = [0.0; 2];
    for i in 0..count {
        let mu = (f64::from(i) + 0.5) / f64::from(count);
        let reflectance = f64::from(fresnel::dielectric(mu as f32, 1.0 / eta).0) / f64::from(count);
        sums[0] += 2.0 * mu * reflectance;
        sums[1] += 3.0 * mu * mu * reflectance;
    }
    sums
}

impl BeamDiffusion {
    /// For matter of this mean cosine below a boundary; `None` if that is no mean cosine.
    pub(crate) fn below(g: f32, boundary: &Boundary) -> Option<Self> {
        let phase = HenyeyGreenstein::new(g)?;
        Some(Self::new(&phase, boundary.eta.unwrap_or(1.0)))
    }

    /// For matter with this phase function below a boundary of the relative index `eta` (1 for one that lets all light pass).
    pub(crate) fn new(phase: &HenyeyGreenstein, eta: f32) -> Self {
        let g = phase.mean_cosine();
        let moments = moments(eta);
        let distances: Vec<f64> = core::iter::once(0.0)
            .chain((1..DISTANCES).map(|i| 2e-3 * float64::pow(1.18, i as f64)))
            .collect();
        let row = |index: usize| {
            let part = index as f64 / (ALBEDOS - 1) as f64;
            let albedo = (1.0 - float64::exp(-CROWDING * part)) / (1.0 - float64::exp(-CROWDING));
            let values: Vec<f64> = distances
                .iter()
                .map(|r| {
                    let r = r.max(1e-4);
                    let many = scattered_often(r, albedo, f64::from(g), moments);
                    TAU * r * (many + scattered_once(r, albedo, phase, eta)).max(0.0)
                })
                .collect();
            let density = PiecewiseLinear::new(&distances, &values);
            // Nothing leaves matter that only absorbs; any density will do.
            let flat = || PiecewiseLinear::new(&[0.0, 1.0], &[1.0, 1.0]);
            match density {
                Ok(density) => {
                    // Up to 1.04 for nearly non-absorbing media, which would gain energy.
                    let total = density.integral().min(1.0);
                    Some((density, total))
                }
                Err(_) => flat().ok().map(|density| (density, 0.0)),
            }
        };
        Self {
            rows: (0..ALBEDOS).filter_map(row).collect(),
        }
    }

    /// The profile of matter: a mixture of those of the nearest albedos.
    pub(crate) fn of(&self, matter: &Matter) -> Beam<'_> {
        let extinction = f64::from(matter.absorption + matter.scattering);
        let albedo = f64::from(matter.scattering) / extinction;
        let rest = 1.0 - albedo * (1.0 - float64::exp(-CROWDING));
        let place = (-float64::ln(rest) / CROWDING).clamp(0.0, 1.0) * (ALBEDOS - 1) as f64;
        let index = (place as usize).min(ALBEDOS - 2);
        let part = place - index as f64;
        let rows = [&self.rows[index], &self.rows[index + 1]];
        Beam {
            rows,
            shares: [(1.0 - part) * rows[0].1, part * rows[1].1],
            extinction,
        }
    }
}

/// Light that diffuses, at r mean free paths.
fn scattered_often(r: f64, albedo: f64, g: f64, [twice, thrice]: [f64; 2]) -> f64 {
    let (absorption, scattering) = (1.0 - albedo, albedo * (1.0 - g));
    let reduced = absorption + scattering;
    let reduced_albedo = scattering / reduced;
    let diffusion = (2.0 * absorption + scattering) / (3.0 * reduced * reduced);
    let transport = (absorption / diffusion).sqrt();
    // The boundary of the linear extrapolation, above the surface.
    let boundary = -2.0 * diffusion * (1.0 + thrice) / (1.0 - twice);
    let (of_fluence, of_irradiance) = (0.25 * (1.0 - twice), 0.5 * (1.0 - thrice));
    let sum: f64 = (0..DEPTHS)
        .map(|i| {
            let z = -float64::ln(1.0 - (i as f64 + 0.5) / DEPTHS as f64) / reduced;
            let mirrored = 2.0 * boundary - z;
            let [near, far] = [z, mirrored].map(|z| (r * r + z * z).sqrt());
            let [e_near, e_far] = [near, far].map(|d| float64::exp(-transport * d));
            let fluence = (e_near / near - e_far / far) / (4.0 * PI * diffusion);
            let gradient = |z: f64, d: f64, e: f64| z * (1.0 + transport * d) * e / (d * d * d);
            let irradiance =
                (gradient(z, near, e_near) - gradient(mirrored, far, e_far)) / (4.0 * PI);
            let damping = 1.0 - float64::exp(-2.0 * reduced * (near + z));
            damping * (of_fluence * fluence + of_irradiance * irradiance)
        })
        .sum();
    reduced_albedo * reduced_albedo * sum / DEPTHS as f64
}

/// Light that is scattered once, at r mean free paths, and leaves through the boundary.
fn scattered_once(r: f64, albedo: f64, phase: &HenyeyGreenstein, eta: f32) -> f64 {
    // Nearer the surface it would be reflected totally.
    let nearest = r * f64::from((eta * eta - 1.0).max(0.0).sqrt());
    let sum: f64 = (0..DEPTHS)
        .map(|i| {
            let z = nearest - float64::ln(1.0 - (i as f64 + 0.5) / DEPTHS as f64);
            let d = (r * r + z * z).sqrt();
            let cos = z / d;
            let passing = 1.0 - f64::from(fresnel::dielectric(cos as f32, 1.0 / eta).0);
            // Downward, then up: it turns by more than a right angle.
            let scattered = f64::from(phase.value(-cos as f32));
            float64::exp(-(d + nearest)) / (d * d) * scattered * passing * cos
        })
        .sum();
    albedo * sum / DEPTHS as f64
}

impl Radial for Beam<'_> {
    fn value(&self, r: f32) -> f32 {
        let x = f64::from(r) * self.extinction;
        let parts = self.rows.iter().zip(self.shares);
        let sum: f64 = parts.map(|(row, share)| share * row.0.density(x)).sum();
        (sum * self.extinction * self.extinction / (TAU * x)) as f32
    }

    fn total(&self) -> f32 {
        (self.shares[0] + self.shares[1]) as f32
    }

    fn sample(&self, u: f32) -> f32 {
        let first = self.shares[0] / (self.shares[0] + self.shares[1]);
        let u = f64::from(u);
        let x = if u < first {
            self.rows[0].0.sample(u / first)
        } else {
            self.rows[1].0.sample((u - first) / (1.0 - first))
        };
        (x / self.extinction) as f32
    }
}
