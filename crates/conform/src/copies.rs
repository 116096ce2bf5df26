//! Whether seeds made a difference: pictures that are the same are no replicates.

use crate::replicate::{self, Replicate};

/// With less noise than this in a pixel, relative to the mean, pictures of different seeds may well be the same by chance.
const NO_NOISE: f64 = 1e-3;

/// Whether seeds made a difference.
pub(crate) enum Copies {
    /// They did, or there were no two of a pose.
    None,
    /// Two seeds of one pose gave the same, others did not.
    Some(u32, u32),
    /// All of a pose are the same.
    All,
}

impl Copies {
    /// Of pictures of this many rows and columns.
    pub(crate) fn among(replicates: &[Replicate], pixels: u32) -> Self {
        let Some(mean) = replicate::mean(replicates, pixels) else {
            return Self::None;
        };
        let mut twins = None;
        let (mut pairs, mut same) = (0, 0);
        for (i, a) in replicates.iter().enumerate() {
            for b in replicates[..i].iter().filter(|b| b.pose == a.pose) {
                pairs += 1;
                if a.is_copy_of(b) {
                    same += 1;
                    // Pictures without noise may well be the same by chance.
                    if difference(&a.luminance, &mean.means) > NO_NOISE {
                        twins = twins.or(Some((b.seed, a.seed)));
                    }
                }
            }
        }
        match twins {
            _ if pairs > 0 && same == pairs => Self::All,
            None => Self::None,
            Some((a, b)) => Self::Some(a, b),
        }
    }
}

/// The greatest difference of a picture from the first. A sound picture is the same in every pose but for its noise, and so is a
/// wrong one without noise.
pub(crate) fn noise(replicates: &[Replicate]) -> f64 {
    let Some((first, others)) = replicates.split_first() else {
        return 0.0;
    };
    others
        .iter()
        .map(|other| difference(&first.luminance, &other.luminance))
        .fold(0.0, f64::max)
}

/// Whether pictures differ by more than rounding.
pub(crate) fn are_noisy(replicates: &[Replicate]) -> bool {
    noise(replicates) > NO_NOISE
}

/// The difference of two pictures, root mean square over pixels, relative to their mean.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    let sum: f64 = a.iter().chain(b).sum();
    match square > 0.0 {
        true => (square * a.len() as f64).sqrt() / (0.5 * sum.abs()),
        false => 0.0,
    }
}
