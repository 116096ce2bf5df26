//! How linear colours are shown on a screen that ends at 1.
//!
//! ```text
//! srgb     y = min(x, 1)
//! filmic   y = a (1 + a/w²) / (1 + a),   a = k x,   w = 16 k
//! ```
//!
//! The second is the curve of E. Reinhard, M. Stark, P. Shirley, J. Ferwerda 2002, *Photographic tone reproduction for digital
//! images*, equation 4, for each of red, green and blue: it rolls highlights off, so that 16 becomes white and bright colours pale, as on
//! film. k = 1.218657… is chosen such that a mid grey of 0.18 stays what it is. Both are encoded as sRGB afterwards.

/// A way to show linear colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// Unchanged; values above 1 are clipped.
    #[default]
    Srgb,
    /// With highlights that roll off.
    Filmic,
}

/// k: from a (1 + a/w²) = 0.18 (1 + a) with a = 0.18 k, w = 16 a/0.18.
const STEEPNESS: f64 = (0.18 - 0.18 * 0.18 / 256.0) / 0.82 / 0.18;

/// What becomes white, of `filmic`.
const WHITE: f64 = 16.0 * STEEPNESS;

impl View {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Srgb, Self::Filmic];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Filmic => "filmic",
        }
    }

    /// The view of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        (Self::ALL.into_iter()).find(|view| view.name().eq_ignore_ascii_case(name))
    }

    /// What a linear sample is shown as, still linear; more than 1 is beyond white.
    #[must_use]
    pub fn shown(self, x: f64) -> f64 {
        match self {
            Self::Filmic if x > 0.0 => {
                let a = STEEPNESS * x.min(f64::from(f32::MAX));
                a * (1.0 + a / (WHITE * WHITE)) / (1.0 + a)
            }
            _ => x,
        }
    }
}

/// How a picture is made of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Development {
    /// Exposure in stops, a factor of 2 each.
    pub exposure: f32,
    /// How it is shown then.
    pub view: View,
}

impl From<f32> for Development {
    fn from(exposure: f32) -> Self {
        Self {
            exposure,
            view: View::Srgb,
        }
    }
}

impl Development {
    /// The factor of the exposure.
    #[must_use]
    pub fn gain(self) -> f64 {
        gain(self.exposure)
    }
}

/// The factor of so many stops: 2^`exposure`, held to what leaves 0 of every 32-bit float but 0
/// and ∞, or ∞. It is finite, so that black stays black.
#[must_use]
pub fn gain(exposure: f32) -> f64 {
    etalon_math::float64::pow(2.0, f64::from(exposure).clamp(-1000.0, 1000.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mid_grey_stays_and_sixteen_is_white() {
        let filmic = |x: f64| View::Filmic.shown(x);
        assert!((filmic(0.18) - 0.18).abs() < 1e-12, "{}", filmic(0.18));
        assert!((filmic(16.0) - 1.0).abs() < 1e-12, "{}", filmic(16.0));
        assert_eq!((filmic(0.0), filmic(-0.5)), (0.0, -0.5));
        let steps = (0..1000).map(|k| filmic(f64::from(k) / 50.0));
        assert!(steps.clone().zip(steps.skip(1)).all(|(a, b)| a < b));
        assert!(filmic(f64::INFINITY).is_finite());
        assert_eq!(View::Srgb.shown(3.0), 3.0);
        for view in View::ALL {
            assert_eq!(View::named(view.name()), Some(view));
        }
    }
}
