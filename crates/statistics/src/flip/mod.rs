//! ꟻLIP: how different two images look when one is flipped for the other.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström & Fairchild, "FLIP: A Difference Evaluator
//! for Alternating Images", HPG 2020; for high dynamic range Andersson, Nilsson, Shirley &
//! Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images", EG 2021. Per pixel,
//!
//! ΔE = ΔE_c^(1 − ΔE_f) ∈ [0, 1],
//!
//! - ΔE_c, colour: both images in the opponent space YC_xC_z are blurred by the eye's contrast
//!   sensitivity (`filters`), clamped to the display's gamut, and compared in Hunt-adjusted L*a*b*
//!   by the HyAB distance d; d^0.7 is stretched so that 0.4 of its greatest value (green against
//!   blue) becomes 0.95;
//! - ΔE_f, features: ((1/√2) max of the differences of edge and of point strength of Y)^½;
//! - HDR-ꟻLIP: the maximum over exposures 2^e, e in equal steps from where the brightest to where
//!   the median pixel of the reference maps to 0.85, both images tone-mapped and clamped.
//!
//! Values agree with version 1.7 of the authors' tool to its single precision (test `flip`).

mod colour;
mod exposure;
mod filters;

pub use exposure::ToneMapper;

use crate::picture::{Picture, PictureError};
use colour::{hunt_lab, hyab, largest_distance, linear_to_ycxcz, srgb_to_linear, ycxcz_to_linear};
use exposure::Exposures;
use filters::{Plane, feature_strengths, spatially_filtered};

/// The exponent of the colour distance, q_c.
const COLOUR_EXPONENT: f64 = 0.7;
/// Where the stretch of colour distances bends, p_c, as a share of the greatest distance.
const BEND: f64 = 0.4;
/// What it becomes there, p_t.
const BENT: f64 = 0.95;

/// The pixels per degree of visual angle of a display 0.7 m wide with 3840 pixels, seen from 0.7 m:
/// 3840 π / 180.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// How images are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Pixels per degree of visual angle.
    pub pixels_per_degree: f64,
    /// For high dynamic range: the tone mapper.
    pub tone_mapper: ToneMapper,
    /// For high dynamic range: the first and last exposure, as powers of two; from the reference
    /// if absent.
    pub exposures: Option<(f64, f64)>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            pixels_per_degree: PIXELS_PER_DEGREE,
            tone_mapper: ToneMapper::Aces,
            exposures: None,
        }
    }
}

/// The error of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    map: Vec<f32>,
    mean: f64,
    exposures: Vec<f64>,
}

impl Flip {
    /// One error in [0, 1] per pixel, row by row.
    #[must_use]
    pub fn map(&self) -> &[f32] {
        &self.map
    }

    /// Their mean.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The exposures compared, as powers of two; none for low dynamic range.
    #[must_use]
    pub fn exposures(&self) -> &[f64] {
        &self.exposures
    }

    fn new(map: &[f64], exposures: Vec<f64>) -> Self {
        Self {
            map: map.iter().map(|&error| error as f32).collect(),
            mean: map.iter().sum::<f64>() / map.len() as f64,
            exposures,
        }
    }
}

/// LDR-ꟻLIP of images that are sRGB-encoded; values outside [0, 1] count as the nearer end.
///
/// # Errors
/// [`PictureError`] where the sizes differ or the pixels per degree are not in (0, 10⁴].
pub fn ldr(
    test: &Picture<'_>,
    reference: &Picture<'_>,
    options: &Options,
) -> Result<Flip, PictureError> {
    check(test, reference, options)?;
    let linear = |picture: &Picture<'_>| -> Vec<[f64; 3]> {
        let encoded = picture.pixels();
        encoded
            .map(|p| p.map(|v| srgb_to_linear(v.clamp(0.0, 1.0))))
            .collect()
    };
    let map = displayed(linear(test), linear(reference), test.width(), options);
    Ok(Flip::new(&map, Vec::new()))
}

/// HDR-ꟻLIP of images of linear sRGB; negative values count as zero.
///
/// # Errors
/// [`PictureError`] where the sizes differ, an option is out of range, or the range of exposures
/// is to follow from a reference whose median luminance is not positive.
pub fn hdr(
    test: &Picture<'_>,
    reference: &Picture<'_>,
    options: &Options,
) -> Result<Flip, PictureError> {
    check(test, reference, options)?;
    let exposures = match options.exposures {
        Some((start, stop)) => Exposures::between(start, stop),
        None => Exposures::of(reference, options.tone_mapper),
    }?;
    let shown = |picture: &Picture<'_>, exposure: f64| -> Vec<[f64; 3]> {
        let factor = libm::exp2(exposure);
        picture
            .pixels()
            .map(|p| options.tone_mapper.map(p.map(|v| v.max(0.0) * factor)))
            .collect()
    };
    let levels: Vec<f64> = exposures.levels().collect();
    let mut greatest = vec![0.0_f64; test.width() * test.height()];
    for &level in &levels {
        let map = displayed(
            shown(test, level),
            shown(reference, level),
            test.width(),
            options,
        );
        for (greatest, error) in greatest.iter_mut().zip(map) {
            *greatest = greatest.max(error);
        }
    }
    Ok(Flip::new(&greatest, levels))
}

fn check(
    test: &Picture<'_>,
    reference: &Picture<'_>,
    options: &Options,
) -> Result<(), PictureError> {
    test.same_size(reference)?;
    // Beyond this the filters are wider than any picture.
    if options.pixels_per_degree > 0.0 && options.pixels_per_degree <= 1e4 {
        Ok(())
    } else {
        Err(PictureError::BadOption {
            option: "pixels per degree",
        })
    }
}

/// The error of each pixel of linear images as a display shows them, in [0, 1].
fn displayed(
    test: Vec<[f64; 3]>,
    reference: Vec<[f64; 3]>,
    width: usize,
    options: &Options,
) -> Vec<f64> {
    let opponent = |pixels: Vec<[f64; 3]>| -> Plane<[f64; 3]> {
        Plane::new(pixels.into_iter().map(linear_to_ycxcz).collect(), width)
    };
    let (test, reference) = (opponent(test), opponent(reference));
    let density = options.pixels_per_degree;
    let features = feature_strengths(&test, density)
        .into_iter()
        .zip(feature_strengths(&reference, density))
        .map(|(t, r)| {
            let edge = (t.edge - r.edge).abs();
            let point = (t.point - r.point).abs();
            (std::f64::consts::FRAC_1_SQRT_2 * edge.max(point)).sqrt()
        });
    let perceived = |plane: &Plane<[f64; 3]>| -> Vec<[f64; 3]> {
        spatially_filtered(plane, density)
            .into_iter()
            .map(|p| hunt_lab(ycxcz_to_linear(p).map(|v| v.clamp(0.0, 1.0))))
            .collect()
    };
    let greatest = libm::pow(largest_distance(), COLOUR_EXPONENT);
    perceived(&test)
        .into_iter()
        .zip(perceived(&reference))
        .zip(features)
        .map(|((t, r), feature)| {
            let colour = stretch(libm::pow(hyab(t, r), COLOUR_EXPONENT), greatest);
            libm::pow(colour, 1.0 - feature)
        })
        .collect()
}

/// Maps [0, BEND · greatest] to [0, BENT], and what is above to [BENT, 1].
fn stretch(distance: f64, greatest: f64) -> f64 {
    let bend = BEND * greatest;
    if distance < bend {
        BENT * distance / bend
    } else {
        BENT + (1.0 - BENT) * (distance - bend) / (greatest - bend)
    }
}
