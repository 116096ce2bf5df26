//! Exposures and tone mappers of HDR-ꟻLIP (EG 2021, section 4).
//!
//! A tone mapper is (k₀x² + k₁x + k₂) / (k₃x² + k₄x + k₅), per channel, or for Reinhard's of the
//! luminance. The first exposure maps the reference's greatest luminance to t = 0.85, the last its
//! median; there are as many as there are powers of two between, rounded up, and at least two.

use crate::picture::{Picture, PictureError};

/// What the extreme luminances are mapped to.
const TARGET: f64 = 0.85;

/// No more exposures than this are compared: single precision has fewer powers of two.
const MOST: f64 = 300.0;

/// A tone mapper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ToneMapper {
    /// Narkowicz's (2015) fit to the ACES curve, less its pre-exposure of 0.6.
    #[default]
    Aces,
    /// Hable's (2010) filmic curve.
    Hable,
    /// Reinhard et al. (2002): over one plus the luminance.
    Reinhard,
}

impl ToneMapper {
    /// k₀ … k₅.
    fn coefficients(self) -> [f64; 6] {
        match self {
            Self::Aces => [0.36 * 2.51, 0.6 * 0.03, 0.0, 0.36 * 2.43, 0.6 * 0.59, 0.14],
            Self::Hable => [0.231_683, 0.013_791, 0.0, 0.18, 0.3, 0.018],
            Self::Reinhard => [0.0, 1.0, 0.0, 0.0, 1.0, 1.0],
        }
    }

    /// What a display shows of a linear colour, in [0, 1].
    pub(super) fn map(self, colour: [f64; 3]) -> [f64; 3] {
        let mapped = if self == Self::Reinhard {
            let denominator = 1.0 + luminance(colour);
            colour.map(|x| x / denominator)
        } else {
            let k = self.coefficients();
            colour.map(|x| {
                // The limit, before the squares overflow.
                let x = x.min(1e100);
                (x * (k[0] * x + k[1]) + k[2]) / (x * (k[3] * x + k[4]) + k[5])
            })
        };
        mapped.map(|x| x.clamp(0.0, 1.0))
    }

    /// The greater number that is mapped to [`TARGET`].
    fn inverse(self) -> f64 {
        let k = self.coefficients();
        let [a, b, c] = [0, 1, 2].map(|i| k[i] - TARGET * k[i + 3]);
        if a == 0.0 {
            return -c / b;
        }
        let half = -0.5 * b / a;
        half + (half * half - c / a).sqrt()
    }
}

/// The luminance of linear sRGB, by BT.709's rounded weights.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Equal steps of exposure.
pub(super) struct Exposures {
    start: f64,
    stop: f64,
}

impl Exposures {
    /// From the first to the last.
    pub(super) fn between(start: f64, stop: f64) -> Result<Self, PictureError> {
        if start.is_finite() && stop.is_finite() && start <= stop && stop - start <= MOST {
            Ok(Self { start, stop })
        } else {
            Err(PictureError::BadOption {
                option: "the range of exposures",
            })
        }
    }

    /// Those that suit a reference.
    pub(super) fn of(reference: &Picture<'_>, mapper: ToneMapper) -> Result<Self, PictureError> {
        let mut luminances: Vec<f64> = reference
            .pixels()
            .map(|p| luminance(p.map(|v| v.max(0.0))))
            .collect();
        luminances.sort_by(f64::total_cmp);
        let n = luminances.len();
        // Of an even number the upper of the two in the middle, as the authors' tool has it.
        let median = luminances[n / 2];
        if !(median > 0.0) {
            return Err(PictureError::NoExposure);
        }
        let bright = mapper.inverse();
        Self::between(
            libm::log2(bright / luminances[n - 1]),
            libm::log2(bright / median),
        )
    }

    /// The exposures, as powers of two.
    pub(super) fn levels(&self) -> impl Iterator<Item = f64> + use<> {
        let count = (self.stop - self.start).ceil().max(2.0) as u32;
        let (start, step) = (self.start, (self.stop - self.start) / f64::from(count - 1));
        (0..count).map(move |i| start + f64::from(i) * step)
    }
}
