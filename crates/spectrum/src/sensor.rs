//! A sensor: the response of up to three channels to incident light.
//!
//! A path's result is one value per lane, already divided by the sum over the lanes of its
//! rescaled path densities:
//!
//! Lⱼ = fⱼ(x) / Σₜ Σₖ pₜ,ₖ(x),  C = Σⱼ Lⱼ s(λⱼ) / p(λⱼ)
//!
//! with s the response and p the density of the wavelength (Wilkie et al. 2014, equation 5, in the
//! notation of ARCHITECTURE.md, "Wavelengths"). For a path whose densities are equal in all lanes Lⱼ = fⱼ/(4 p(x)): the
//! sum over k already holds the division by four, so none follows here.
//!
//! The standard sensor is the CIE 1931 observer in linear Rec. 709. Others have their own curves
//! ([`Sensor::new`]), which determine p.

use crate::cie::{self, COUNT, FIRST};
use crate::colour_space::{XYZ_TO_RGB, apply};
use crate::{LAMBDA_MAX, LAMBDA_MIN, Spectrum, WavelengthDistribution, Wavelengths};
use glam::{Mat4, Vec3, Vec4};
use std::sync::Arc;

/// s(λⱼ)/p(λⱼ) for each channel and each lane, nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorWeights {
    /// Weights of the first channel: red.
    pub r: Vec4,
    /// Weights of the second channel: green.
    pub g: Vec4,
    /// Weights of the third channel: blue.
    pub b: Vec4,
}

impl SensorWeights {
    /// The sensor's channels, of the standard one linear Rec. 709, of the path result `l` (see the head of this file
    /// for its convention).
    #[inline]
    pub fn rgb(&self, l: Vec4) -> Vec3 {
        Vec3::new(l.dot(self.r), l.dot(self.g), l.dot(self.b))
    }

    /// The responses of three channels, over the density of the wavelengths.
    #[inline]
    fn new([r, g, b, _]: [Vec4; 4], wavelengths: &Wavelengths) -> Self {
        let inverse = wavelengths.density.recip();
        Self {
            r: r * inverse,
            g: g * inverse,
            b: b * inverse,
        }
    }
}

/// Responses at 360 + i nm, linear in between. The last row is repeated so that row i + 1 exists.
type Rows = [[f32; 4]; COUNT + 1];

/// Up to three response curves, and how wavelengths are drawn for them.
#[derive(Clone, Debug)]
pub struct Sensor {
    rows: Arc<Rows>,
    distribution: WavelengthDistribution,
}

impl Default for Sensor {
    /// The standard observer in linear Rec. 709.
    fn default() -> Self {
        Self {
            rows: Arc::new(RESPONSE),
            distribution: WavelengthDistribution::default(),
        }
    }
}

/// Of the wavelengths' probability, the share that is spread evenly: a curve may be larger between two
/// whole nanometres than at them.
const EVEN: f64 = 0.005;

/// In how many parts a nanometre is divided to find the mean of a curve over it.
const PARTS: u32 = 16;

impl Sensor {
    /// A sensor whose channels are ∫ L(λ) cₖ(λ) dλ for three curves cₖ of the wavelength (nm), each kept as its means over
    /// whole nanometres ± ½: what lies beyond 360–830 nm is not seen.
    pub fn new(curves: [&dyn Fn(f64) -> f64; 3]) -> Self {
        let mut rows: Rows = [[0.0; 4]; COUNT + 1];
        for (i, row) in rows.iter_mut().take(COUNT).enumerate() {
            for (value, curve) in row.iter_mut().zip(curves) {
                let part = |k: u32| (f64::from(k) + 0.5) / f64::from(PARTS) - 0.5;
                let at = (0..PARTS)
                    .map(|k| (LAMBDA_MIN + i as f64 + part(k)).clamp(LAMBDA_MIN, LAMBDA_MAX));
                *value = (at.map(curve).sum::<f64>() / f64::from(PARTS)) as f32;
            }
        }
        rows[COUNT] = rows[COUNT - 1];
        let total =
            |channel: usize| -> f64 { rows.iter().map(|row| f64::from(row[channel].abs())).sum() };
        let totals = [total(0), total(1), total(2)];
        let seen = totals.iter().filter(|total| **total > 0.0).count().max(1);
        let importance = |lambda: f64| {
            let row = row(&rows, (lambda - LAMBDA_MIN) as f32).to_array();
            let shares = row.iter().zip(totals).filter(|(_, total)| *total > 0.0);
            let sum: f64 = shares
                .map(|(value, total)| f64::from(value.abs()) / total)
                .sum();
            (1.0 - EVEN) * sum / seen as f64 + EVEN / (LAMBDA_MAX - LAMBDA_MIN)
        };
        Self {
            distribution: WavelengthDistribution::of_importance(LAMBDA_MIN, LAMBDA_MAX, importance),
            rows: Arc::new(rows),
        }
    }

    /// The standard observer behind a filter of this transmittance, if there is one, whose colours are then mapped by a matrix of rows
    /// (see [`crate::white_balance`]).
    pub fn mapped(filter: Option<&Spectrum>, matrix: [[f64; 3]; 3]) -> Self {
        let seen = |channel: usize| {
            move |lambda: f64| {
                let row = row(&RESPONSE, (lambda - LAMBDA_MIN) as f32);
                let mixed: f64 = (0..3).map(|k| matrix[channel][k] * f64::from(row[k])).sum();
                mixed * filter.map_or(1.0, |filter| filter.eval_at(lambda))
            }
        };
        Self::new([&seen(0), &seen(1), &seen(2)])
    }

    /// The standard observer behind a filter of this transmittance.
    pub fn behind(filter: &Spectrum) -> Self {
        const AS_THEY_ARE: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self::mapped(Some(filter), AS_THEY_ARE)
    }

    /// Four wavelengths from one number `u` in [0, 1).
    #[inline]
    pub fn sample(&self, u: f32) -> Wavelengths {
        self.distribution.sample(u)
    }

    /// The channels' weights for the light at a path's wavelengths.
    #[inline]
    pub fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights {
        SensorWeights::new(respond(&self.rows, wavelengths.lambda), wavelengths)
    }
}

/// The weights of a path's wavelengths for the standard sensor: response over density.
#[inline]
pub fn sensor_response(wavelengths: &Wavelengths) -> SensorWeights {
    SensorWeights::new(response(wavelengths.lambda), wavelengths)
}

/// The responses (r̄, ḡ, b̄, ȳ)/N at four wavelengths in nm: linear Rec. 709 and luminance of a
/// unit of radiance per nanometre. Zero outside 360–830 nm.
#[inline]
pub fn response(lambda: Vec4) -> [Vec4; 4] {
    respond(&RESPONSE, lambda)
}

/// The curves at four wavelengths in nm.
#[inline]
fn respond(rows: &Rows, lambda: Vec4) -> [Vec4; 4] {
    let t = lambda - FIRST as f32;
    let inside = t.cmpge(Vec4::ZERO) & t.cmple(Vec4::splat((COUNT - 1) as f32));
    // A wavelength outside saturates to some row, which `inside` discards.
    let at = |t| row(rows, t);
    let lanes = Mat4::from_cols(at(t.x), at(t.y), at(t.z), at(t.w)).transpose();
    [lanes.x_axis, lanes.y_axis, lanes.z_axis, lanes.w_axis]
        .map(|channel| Vec4::select(inside, channel, Vec4::ZERO))
}

/// The responses at 360 + `t` nm.
#[inline]
fn row(rows: &Rows, t: f32) -> Vec4 {
    let i = (t as usize).min(COUNT - 1);
    let low = Vec4::from_array(rows[i]);
    let high = Vec4::from_array(rows[i + 1]);
    low + (high - low) * (t - i as f32)
}

/// Those of the standard sensor, (r̄, ḡ, b̄, ȳ)/N.
static RESPONSE: Rows = {
    let mut table = [[0.0; 4]; COUNT + 1];
    let mut i = 0;
    while i <= COUNT {
        let xyz = cie::row(if i < COUNT { i } else { COUNT - 1 });
        let [r, g, b] = apply(&XYZ_TO_RGB, xyz);
        let n = cie::NORMALISATION;
        table[i] = [
            (r / n) as f32,
            (g / n) as f32,
            (b / n) as f32,
            (xyz[1] / n) as f32,
        ];
        i += 1;
    }
    table
};
