//! The BRDFs of the MERL database.
//!
//! ```text
//! dimensions: i32 × 3 = 90, 90, 180     red, green, blue: f64 each, scaled by 1/1500, 1.15/1500, 1.66/1500
//! entry φd + 180 (θd + 90 θh)           θh = (k/90)² π/2, θd = k°, φd = k°
//! ```
//!
//! Matusik, Pfister, Brand and McMillan (2003), *A Data-Driven Reflectance Model*: isotropic, by the half vector and
//! the difference (Rusinkiewicz 1998). Colours are linear Rec. 709; as spectra they are sums of three smooth ones
//! ([`etalon_spectrum::upsample::basis`]). Entries are interpolated linearly along each angle; those below zero are
//! where nothing was measured, and do not count.

use crate::BrdfTableError;
use crate::half_vector::{self, HalfVectors};
use core::f32::consts::{FRAC_PI_2, PI};
use glam::Vec3;

/// What entries of the red, green and blue plane are multiplied by.
const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];

/// Entries along θh, θd and φd in the database.
pub const DIMENSIONS: [usize; 3] = [90, 90, 180];

/// A measured material.
#[derive(Clone, Debug)]
pub struct Merl {
    dimensions: [usize; 3],
    /// Red, green, blue (sr⁻¹); below zero where nothing was measured.
    entries: Vec<[f32; 3]>,
    half_vectors: HalfVectors,
}

impl Merl {
    /// Whether a file begins as MERL's do, with three small numbers.
    pub fn recognises(bytes: &[u8]) -> bool {
        dimensions(bytes).is_some_and(|d| d.iter().all(|&n| (1..=4096).contains(&n)))
    }

    /// A `.binary` file of the database.
    ///
    /// # Errors
    /// If its length is not the one that its dimensions ask for, an entry is not finite, or all are zero.
    pub fn parse(bytes: &[u8]) -> Result<Self, BrdfTableError> {
        let given = dimensions(bytes)
            .ok_or_else(|| BrdfTableError::new("the file ends before its three dimensions"))?;
        let dimensions = given.map(|n| usize::try_from(n).unwrap_or(0));
        let count = dimensions
            .iter()
            .try_fold(1usize, |product, &n| product.checked_mul(n))
            .filter(|&count| count > 0);
        let needed = count.and_then(|count| count.checked_mul(24)?.checked_add(12));
        if needed != Some(bytes.len()) {
            return Err(BrdfTableError::new(format!(
                "dimensions {} × {} × {} ask for {} bytes; the file has {}",
                given[0],
                given[1],
                given[2],
                needed.map_or("more".to_owned(), |needed| needed.to_string()),
                bytes.len()
            )));
        }
        let count = bytes.len() / 24;
        let number = |plane: usize, index: usize| {
            let at = 12 + 8 * (plane * count + index);
            let mut eight = [0; 8];
            eight.copy_from_slice(&bytes[at..at + 8]);
            (f64::from_le_bytes(eight) * SCALE[plane]) as f32
        };
        let entries: Vec<[f32; 3]> = (0..count)
            .map(|index| [0, 1, 2].map(|plane| number(plane, index)))
            .collect();
        if let Some(index) = entries
            .iter()
            .position(|e| e.iter().any(|v| !v.is_finite()))
        {
            return Err(BrdfTableError::new(format!(
                "entry {index} is {:?}",
                entries[index]
            )));
        }
        let half_vectors = HalfVectors::new(|wo, wi| {
            half_vector::angles(wo, wi).map_or(0.0, |angles| {
                interpolated(&entries, dimensions, angles).element_sum()
            })
        })?;
        Ok(Self {
            dimensions,
            entries,
            half_vectors,
        })
    }

    /// Red, green and blue of the BRDF (sr⁻¹), without the cosine.
    #[inline]
    pub fn brdf(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        half_vector::angles(wo, wi).map_or(Vec3::ZERO, |angles| {
            interpolated(&self.entries, self.dimensions, angles)
        })
    }

    /// The distribution of half vectors for sampling.
    #[inline]
    pub fn half_vectors(&self) -> &HalfVectors {
        &self.half_vectors
    }
}

/// The three numbers at the beginning of a file.
fn dimensions(bytes: &[u8]) -> Option<[i32; 3]> {
    let head = bytes.get(..12)?;
    let number =
        |at: usize| i32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    Some([number(0), number(4), number(8)])
}

/// The colour at θh, θd, φd.
#[inline]
fn interpolated(entries: &[[f32; 3]], [nh, nd, np]: [usize; 3], angles: [f32; 3]) -> Vec3 {
    let [theta_h, theta_d, phi_d] = angles;
    let place = |x: f32, count: usize| {
        let x = x.clamp(0.0, (count - 1) as f32);
        let index = (x as usize).min(count.saturating_sub(2));
        (index, x - index as f32)
    };
    let (h, fh) = place((theta_h / FRAC_PI_2).sqrt() * nh as f32, nh);
    let (d, fd) = place(theta_d / FRAC_PI_2 * nd as f32, nd);
    // φd is periodic: after the last entry comes the first.
    let turn = phi_d / PI * np as f32;
    let p = turn as usize;
    let fp = turn - p as f32;
    let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
    for (i, wh) in [(h, 1.0 - fh), ((h + 1).min(nh - 1), fh)] {
        for (j, wd) in [(d, 1.0 - fd), ((d + 1).min(nd - 1), fd)] {
            for (k, wp) in [(p % np, 1.0 - fp), ((p + 1) % np, fp)] {
                let entry = Vec3::from_array(entries[k + np * (j + nd * i)]);
                let share = wh * wd * wp;
                if share > 0.0 && entry.min_element() >= 0.0 {
                    sum += entry * share;
                    weight += share;
                }
            }
        }
    }
    if weight > 0.0 {
        sum / weight
    } else {
        Vec3::ZERO
    }
}

/// The bytes of a file with these dimensions for the BRDF `rgb` (sr⁻¹, without the cosine).
pub fn write(dimensions: [usize; 3], rgb: impl Fn(Vec3, Vec3) -> [f64; 3]) -> Vec<u8> {
    let [nh, nd, np] = dimensions;
    let mut planes: [Vec<u8>; 3] = Default::default();
    for h in 0..nh {
        let x = h as f32 / nh as f32;
        for d in 0..nd {
            for p in 0..np {
                let [wo, wi] = half_vector::directions(
                    x * x * FRAC_PI_2,
                    d as f32 / nd as f32 * FRAC_PI_2,
                    p as f32 / np as f32 * PI,
                );
                let above = wo.z > 0.0 && wi.z > 0.0;
                let values = if above { rgb(wo, wi) } else { [-1.0; 3] };
                for ((plane, value), scale) in planes.iter_mut().zip(values).zip(SCALE) {
                    plane.extend((value / scale).to_le_bytes());
                }
            }
        }
    }
    let mut out: Vec<u8> = (dimensions.iter())
        .flat_map(|&n| (n as u32).to_le_bytes())
        .collect();
    out.extend(planes.concat());
    out
}
