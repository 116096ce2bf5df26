//! The clear sky and the sun of Hošek and Wilkie.
//!
//! ```text
//! L(θ, γ) = M (1 + A exp(B / (cos θ + 0.01))) (C + D exp(E γ) + F cos²γ + G χ(H, γ) + I √cos θ)
//! χ(H, γ) = (1 + cos²γ) / (1 + H² − 2H cos γ)^{3/2}
//! ```
//!
//! at each of 11 wavelengths (320 to 720 nm), θ from the zenith, γ from the sun (Hošek and Wilkie 2012, *An Analytic Model
//! for Full Spectral Sky-Dome Radiance*, eqs. 8 to 10). A … I and M are quintic Bézier curves in (2η/π)^{1/3}, η the
//! sun's elevation, between which turbidity (1 to 10) and the albedo of the ground (0 and 1) are interpolated. The sun's
//! radiance toward an elevation is a cubic in each of 45 intervals, and darkens to its limb by a polynomial of degree
//! five (Hošek and Wilkie 2013, *Adding a Solar-Radiance Function to the Hošek-Wilkie Skylight Model*).

use core::f32::consts::{FRAC_PI_2, PI, TAU};
use etalon_math::float;
use etalon_tables::tensor_file::TensorFile;
use glam::Vec3;
use std::sync::LazyLock;

/// Wavelengths that the data have.
pub(crate) const BANDS: usize = 11;
/// The first of them, nm.
pub(crate) const FIRST: f32 = 320.0;
/// Their distance, nm.
pub(crate) const STEP: f32 = 40.0;
/// Half of the angle under which the data see the sun, rad.
pub(crate) const SUN_RADIUS: f32 = 0.5 * 0.5358 * PI / 180.0;

const TURBIDITIES: usize = 10;
const CONTROLS: usize = 6;
/// A to H.
const PARAMETERS: usize = 9;
const SEGMENTS: usize = 45;
const POWERS: usize = 4;
const LIMB: usize = 6;

struct Data {
    /// turbidity × albedo × control × band × parameter.
    parameters: Vec<f32>,
    /// turbidity × albedo × control × band.
    radiance: Vec<f32>,
    /// turbidity × interval of elevation × band × power.
    sun: Vec<f32>,
    /// band × power.
    limb: Vec<f32>,
}

static DATA: LazyLock<Data> = LazyLock::new(|| {
    let bytes = include_bytes!("../../data/hosek_wilkie.bin");
    let file = TensorFile::parse(bytes).expect("the file is part of the program");
    let field = |name: &str, shape: &[usize]| {
        let tensor = file.tensor(name, shape.len()).expect("the file has it");
        assert_eq!(tensor.shape, shape, "{name}");
        tensor.data
    };
    Data {
        parameters: field(
            "sky_params_spec",
            &[TURBIDITIES, 2, CONTROLS, BANDS, PARAMETERS],
        ),
        radiance: field("sky_rad_spec", &[TURBIDITIES, 2, CONTROLS, BANDS]),
        sun: field("sun_rad_spec", &[TURBIDITIES, SEGMENTS, BANDS, POWERS]),
        limb: field("sun_ld_spec", &[BANDS, LIMB]),
    }
});

/// A, B, C, D, E, F, G, I, H and M at a band, as the data have them.
type Parameters = [f32; PARAMETERS + 1];

/// A band above black and above white ground.
pub(crate) type Band = [Parameters; 2];

/// The shares of the control points of the curves.
pub(crate) type Weights = [f32; CONTROLS];

/// The skies of one turbidity, wherever the sun is.
#[derive(Clone, Debug)]
pub(crate) struct HosekWilkie {
    controls: [[Band; BANDS]; CONTROLS],
    sun: Vec<[[f32; POWERS]; BANDS]>,
}

/// The shares of the control points while the sun is at `theta` from the zenith (rad): those of quintic Bézier curves.
pub(crate) fn weights(theta: f32) -> Weights {
    let elevation = (FRAC_PI_2 - theta).max(0.0);
    let x = float::cbrt(elevation / FRAC_PI_2);
    let binomial = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    std::array::from_fn(|i| {
        binomial[i] * x.powi(i as i32) * (1.0 - x).powi((CONTROLS - 1 - i) as i32)
    })
}

impl HosekWilkie {
    /// The skies of a `turbidity` in [1, 10].
    pub(crate) fn new(turbidity: f32) -> Self {
        let data = &*DATA;
        let place = (turbidity - 1.0).clamp(0.0, (TURBIDITIES - 1) as f32);
        let low = (place as usize).min(TURBIDITIES - 2);
        let t = place - low as f32;
        let mix = |table: &[f32], stride: usize, index: usize| {
            let (a, b) = (
                table[low * stride + index],
                table[(low + 1) * stride + index],
            );
            a + (b - a) * t
        };
        let parameter = |control: usize, band: usize, albedo: usize, p: usize| {
            let entry = (albedo * CONTROLS + control) * BANDS + band;
            if p < PARAMETERS {
                let stride = 2 * CONTROLS * BANDS * PARAMETERS;
                mix(&data.parameters, stride, entry * PARAMETERS + p)
            } else {
                mix(&data.radiance, 2 * CONTROLS * BANDS, entry)
            }
        };
        let sun = |segment: usize, band: usize, power: usize| {
            let index = (segment * BANDS + band) * POWERS + power;
            mix(&data.sun, SEGMENTS * BANDS * POWERS, index)
        };
        Self {
            controls: std::array::from_fn(|i| {
                std::array::from_fn(|band| {
                    [0, 1].map(|albedo| std::array::from_fn(|p| parameter(i, band, albedo, p)))
                })
            }),
            sun: (0..SEGMENTS)
                .map(|i| std::array::from_fn(|band| std::array::from_fn(|p| sun(i, band, p))))
                .collect(),
        }
    }

    /// A band of the sky while the sun is where the control points have these `weights`.
    #[inline]
    pub(crate) fn band(&self, weights: &Weights, band: usize) -> Band {
        let mut sum = [[0.0; PARAMETERS + 1]; 2];
        for (weight, control) in weights.iter().zip(&self.controls) {
            for (sum, control) in sum.iter_mut().zip(&control[band]) {
                for (sum, control) in sum.iter_mut().zip(control) {
                    *sum += weight * control;
                }
            }
        }
        sum
    }

    /// All bands of the sky.
    pub(crate) fn bands(&self, weights: &Weights) -> [Band; BANDS] {
        std::array::from_fn(|band| self.band(weights, band))
    }

    /// The sun's radiance at a band toward the elevation `elevation`, `share` of its radius from its centre.
    pub(crate) fn sun(&self, band: usize, elevation: f32, share: f32) -> f32 {
        let x = float::cbrt((elevation / FRAC_PI_2).clamp(0.0, 1.0)) * SEGMENTS as f32;
        let segment = (x as usize).min(SEGMENTS - 1);
        let start = FRAC_PI_2 * (segment as f32 / SEGMENTS as f32).powi(3);
        let from = elevation - start;
        let bright = polynomial(&self.sun[segment][band], from);
        let psi = float::safe_sqrt(1.0 - share * share);
        let limb = &DATA.limb[band * LIMB..][..LIMB];
        (bright * polynomial(limb, psi)).max(0.0)
    }

    /// The mean radiance at a band over the disk of the sun at `theta` from the zenith, by rings of equal area; what is
    /// below the horizon is black.
    pub(crate) fn mean_sun(&self, band: usize, theta: f32) -> f32 {
        const RINGS: usize = 16;
        const TURNS: usize = 24;
        let mut sum = 0.0;
        for ring in 0..RINGS {
            let share = ((ring as f32 + 0.5) / RINGS as f32).sqrt();
            for turn in 0..TURNS {
                let angle = TAU * (turn as f32 + 0.5) / TURNS as f32;
                let elevation = FRAC_PI_2 - theta + share * SUN_RADIUS * float::sin(angle);
                if elevation > 0.0 {
                    sum += self.sun(band, elevation, share);
                }
            }
        }
        sum / (RINGS * TURNS) as f32
    }
}

/// The sky's radiance in a band, for the cosine to the zenith and the angle to the sun, above ground of this albedo.
#[inline]
pub(crate) fn radiance([black, white]: &Band, cos: f32, gamma: f32, albedo: f32) -> f32 {
    let [a, b, c, d, e, f, g, i, h, mean]: Parameters =
        std::array::from_fn(|p| black[p] + (white[p] - black[p]) * albedo);
    let cos_gamma = float::cos(gamma);
    let square = cos_gamma * cos_gamma;
    let base = (1.0 + h * h - 2.0 * h * cos_gamma).max(1e-6);
    let chi = (1.0 + square) / (base * base.sqrt());
    let zenith = 1.0 + a * float::exp(b / (cos + 0.01));
    let around = c + d * float::exp(e * gamma) + f * square + g * chi + i * cos.max(0.0).sqrt();
    (zenith * around * mean).max(0.0)
}

/// Σ cᵢ xⁱ.
fn polynomial(coefficients: &[f32], x: f32) -> f32 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The direction at an angle from the zenith, which is z, and an azimuth.
pub(crate) fn direction(theta: f32, phi: f32) -> Vec3 {
    let ((s, c), (y, x)) = (float::sin_cos(theta), float::sin_cos(phi));
    Vec3::new(s * x, s * y, c)
}
