//! A spectral BRDF over four numbers: θo × θi × φ × λ.
//!
//! The arrays of a tensor file ([`crate::tensor_file`]):
//!
//! ```text
//! theta_o, theta_i    f32, elevations in rad, increasing in [0, π/2]
//! phi                 f32, angle between the azimuths in rad, increasing in [0, π]
//! wavelengths         f32, nm, increasing
//! brdf                f32, θo × θi × φ × λ: the BRDF in sr⁻¹, without the cosine
//! description         u8, a text (optional)
//! resolution_error    f32, the greatest error of interpolation when the table was made, in units of albedo (optional)
//! ```
//!
//! Isotropic and mirror-symmetric: only the angle between the azimuths counts, 0 when `wi` lies over `wo` and π when it
//! lies opposite. Linear in each number; beyond an end, the end. Sampled by half vectors.

use crate::BrdfTableError;
use crate::half_vector::HalfVectors;
use crate::tensor_file::{self, Array, TensorFile};
use crate::warp::bracket;
use core::f32::consts::{FRAC_PI_2, PI};
use etalon_math::float;
use glam::{Vec3, Vec4};

/// The field that distinguishes this format from RGL's.
pub const FIELD: &str = "brdf";

/// The contents of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Elevations of `wo`, rad.
    pub theta_o: Vec<f32>,
    /// Elevations of `wi`, rad.
    pub theta_i: Vec<f32>,
    /// Angles between the azimuths, rad.
    pub phi: Vec<f32>,
    /// Wavelengths, nm.
    pub wavelengths: Vec<f32>,
}

/// A spectral BRDF.
#[derive(Clone, Debug)]
pub struct SpectralTable {
    grid: Grid,
    brdf: Vec<f32>,
    half_vectors: HalfVectors,
    /// What the file says of itself.
    pub description: String,
    /// The greatest error of interpolation in units of albedo, if the file states it.
    pub resolution_error: Option<f32>,
}

impl SpectralTable {
    /// A file of this format.
    ///
    /// # Errors
    /// If a field is missing, has a wrong shape, or holds a number that it must not.
    pub fn parse(file: &TensorFile<'_>) -> Result<Self, BrdfTableError> {
        let angles = |name: &str, end: f32| {
            let values = file.abscissae(name)?;
            match values.iter().find(|v| !(0.0..=end + 1e-5).contains(*v)) {
                Some(value) => Err(BrdfTableError::new(format!(
                    "the field `{name}` holds {value}; it goes from 0 to {end:.5} rad"
                ))),
                None => Ok(values),
            }
        };
        let grid = Grid {
            theta_o: angles("theta_o", FRAC_PI_2)?,
            theta_i: angles("theta_i", FRAC_PI_2)?,
            phi: angles("phi", PI)?,
            wavelengths: file.abscissae("wavelengths")?,
        };
        let brdf = file.tensor(FIELD, 4)?;
        if brdf.shape != grid.shape() {
            return Err(BrdfTableError::new(format!(
                "the field `{FIELD}` has shape {:?}; the angles and wavelengths ask for {:?}",
                brdf.shape,
                grid.shape()
            )));
        }
        if let Some(index) = brdf.data.iter().position(|&value| value < 0.0) {
            return Err(BrdfTableError::new(format!(
                "entry {index} of the field `{FIELD}` is {}, and must not be negative",
                brdf.data[index]
            )));
        }
        let middle = grid.wavelengths[grid.wavelengths.len() / 2];
        let half_vectors = HalfVectors::new(|wo, wi| {
            interpolated(&grid, &brdf.data, wo, wi, Vec4::splat(middle)).x
        })?;
        let description = if file.has("description") {
            String::from_utf8_lossy(file.bytes("description")?).into_owned()
        } else {
            String::new()
        };
        let resolution_error = if file.has("resolution_error") {
            Some(file.tensor("resolution_error", 1)?.data[0])
        } else {
            None
        };
        Ok(Self {
            grid,
            brdf: brdf.data,
            half_vectors,
            description,
            resolution_error,
        })
    }

    /// The BRDF (sr⁻¹) at four wavelengths, without the cosine.
    #[inline]
    pub fn brdf(&self, wo: Vec3, wi: Vec3, lambda: Vec4) -> Vec4 {
        interpolated(&self.grid, &self.brdf, wo, wi, lambda)
    }

    /// The distribution of half vectors for sampling.
    #[inline]
    pub fn half_vectors(&self) -> &HalfVectors {
        &self.half_vectors
    }
}

impl Grid {
    /// So many elevations, each, and `wavelengths` within 360–830 nm, in equal steps; angles between azimuths denser
    /// toward π, where mirrors reflect.
    pub fn new(theta: usize, phi: usize, wavelengths: usize) -> Self {
        let steps = |count: usize, from: f32, to: f32| -> Vec<f32> {
            let last = (count.max(2) - 1) as f32;
            (0..count.max(2))
                .map(|i| from + (to - from) * i as f32 / last)
                .collect()
        };
        Self {
            theta_o: steps(theta, 0.0, FRAC_PI_2),
            theta_i: steps(theta, 0.0, FRAC_PI_2),
            phi: steps(phi, 1.0, 0.0)
                .iter()
                .map(|t| PI * (1.0 - t * t))
                .collect(),
            wavelengths: steps(wavelengths, 360.0, 830.0),
        }
    }

    /// Entries along each dimension.
    pub fn shape(&self) -> [usize; 4] {
        [
            self.theta_o.len(),
            self.theta_i.len(),
            self.phi.len(),
            self.wavelengths.len(),
        ]
    }

    /// The directions with these elevations and this angle between their azimuths. At the horizon, a hair above it.
    pub fn directions(theta_o: f32, theta_i: f32, phi: f32) -> [Vec3; 2] {
        const HORIZON: f32 = FRAC_PI_2 - 1e-3;
        let (so, co) = float::sin_cos(theta_o.min(HORIZON));
        let (si, ci) = float::sin_cos(theta_i.min(HORIZON));
        let (y, x) = float::sin_cos(phi);
        [Vec3::new(so, 0.0, co), Vec3::new(si * x, si * y, ci)]
    }
}

#[inline]
fn interpolated(grid: &Grid, brdf: &[f32], wo: Vec3, wi: Vec3, lambda: Vec4) -> Vec4 {
    let [so, si] = [wo, wi].map(|v| v.truncate().length());
    let phi = if so > 0.0 && si > 0.0 {
        let (a, b) = (wo.truncate() / so, wi.truncate() / si);
        float::atan2(a.perp_dot(b).abs(), a.dot(b))
    } else {
        0.0
    };
    let axes = [
        (&grid.theta_o, float::atan2(so, wo.z)),
        (&grid.theta_i, float::atan2(si, wi.z)),
        (&grid.phi, phi),
    ]
    .map(|(nodes, value)| (bracket(nodes, value), nodes.len()));
    let lanes = lambda
        .to_array()
        .map(|lambda| bracket(&grid.wavelengths, lambda));
    let count = grid.wavelengths.len();
    let mut sum = [0.0; 4];
    for corner in 0..8 {
        let (mut row, mut weight) = (0, 1.0);
        for (axis, ((index, fraction), length)) in axes.iter().enumerate() {
            let step = corner >> axis & 1;
            weight *= if step == 1 { *fraction } else { 1.0 - fraction };
            row = row * length + (index + step).min(length - 1);
        }
        if weight > 0.0 {
            let spectrum = &brdf[row * count..][..count];
            for (sum, (index, fraction)) in sum.iter_mut().zip(lanes) {
                let (a, b) = (spectrum[index], spectrum[(index + 1).min(count - 1)]);
                *sum += weight * (a + (b - a) * fraction);
            }
        }
    }
    Vec4::from_array(sum)
}

/// The bytes of a file for the BRDF `spectrum` (sr⁻¹ at each of the grid's wavelengths, without the cosine).
pub fn write(
    grid: &Grid,
    spectrum: impl Fn(Vec3, Vec3) -> Vec<f32>,
    description: &str,
    resolution_error: Option<f32>,
) -> Vec<u8> {
    let mut brdf = Vec::with_capacity(grid.shape().iter().product());
    for &theta_o in &grid.theta_o {
        for &theta_i in &grid.theta_i {
            for &phi in &grid.phi {
                let [wo, wi] = Grid::directions(theta_o, theta_i, phi);
                brdf.extend(spectrum(wo, wi));
            }
        }
    }
    let lengths = grid.shape();
    let error = resolution_error.map(|error| [error]);
    let mut fields = vec![
        ("theta_o", Array::Floats(&grid.theta_o, &lengths[0..1])),
        ("theta_i", Array::Floats(&grid.theta_i, &lengths[1..2])),
        ("phi", Array::Floats(&grid.phi, &lengths[2..3])),
        (
            "wavelengths",
            Array::Floats(&grid.wavelengths, &lengths[3..4]),
        ),
        (FIELD, Array::Floats(&brdf, &lengths)),
        ("description", Array::Bytes(description.as_bytes())),
    ];
    if let Some(error) = &error {
        fields.push(("resolution_error", Array::Floats(error, &[1])));
    }
    tensor_file::write(&fields)
}
