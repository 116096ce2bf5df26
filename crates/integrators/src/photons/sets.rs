//! The wavelengths of a pass: sets of four that its photons share with the camera's paths.
//!
//! Photons can be merged with a camera path at their own wavelengths only. A pass has a number of
//! sets; set g takes the lanes F⁻¹(u + j/4), see [`Wavelengths`], of
//!
//! ```text
//! u = (g + φ) / (4 · sets),   φ = ξ + pass · (√5 − 1)/2 (mod 1),
//! ```
//!
//! with ξ one random number of the replicate, so that the sets of a pass lie evenly among each
//! other, those of a progression as well, and each alone is distributed as a random draw. Which
//! lane of a set chooses is drawn for each photon and each camera path: all are equally likely.

use etalon_sampling::hash::{derived_key, random_float, stream_key};
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{Pass, Sensor, World};
use glam::Vec4;

/// The fractional part of the golden ratio: its multiples are spread evenly (mod 1).
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Key of this random number among those of a replicate.
const SHIFT: u32 = 0x7761_7665;

/// The same of the lane that chooses in the first pass.
const CHOOSER: u32 = SHIFT + 1;

/// The sets of a pass.
#[derive(Clone, Debug)]
pub(crate) struct WavelengthSets {
    sets: Vec<(Wavelengths, SensorWeights)>,
}

/// Wavelengths of a path: a set, and which of its lanes chooses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WavelengthChoice {
    /// The set.
    pub(crate) set: usize,
    /// The lane that stands first.
    pub(crate) first: usize,
}

impl WavelengthChoice {
    /// Brings values per lane of the path into the order of the set.
    #[inline]
    pub(crate) fn to_set(self, value: Vec4) -> Vec4 {
        let [a, b, c, d] = value.to_array();
        Vec4::from_array(match self.first {
            0 => [a, b, c, d],
            1 => [d, a, b, c],
            2 => [c, d, a, b],
            _ => [b, c, d, a],
        })
    }

    /// Brings values per lane of the set into the order of the path.
    #[inline]
    pub(crate) fn of_set(self, value: Vec4) -> Vec4 {
        let back = Self {
            first: (4 - self.first) % 4,
            ..self
        };
        back.to_set(value)
    }
}

impl WavelengthSets {
    /// The sets of a pass.
    pub(crate) fn new<W: World>(world: &W, pass: &Pass, count: usize) -> Self {
        let key = derived_key(stream_key(pass.seed, pass.replicate), SHIFT);
        let shift = f64::from(random_float((key >> 32) as u32)) + f64::from(pass.number) * GOLDEN;
        let shift = shift - shift.floor();
        let set = |g: usize| {
            let u = ((g as f64 + shift) / (4.0 * count as f64)) as f32;
            let wavelengths = world.sensor().wavelengths(u);
            (wavelengths, world.sensor().weights(&wavelengths))
        };
        Self {
            sets: (0..count).map(set).collect(),
        }
    }

    /// Number of sets.
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.sets.len()
    }

    /// Wavelengths for a camera path, chosen with `u` in [0, 1).
    #[inline]
    pub(crate) fn choose(&self, u: f32) -> WavelengthChoice {
        let of = 4 * self.len();
        let index = ((u * of as f32) as usize).min(of - 1);
        WavelengthChoice {
            set: index / 4,
            first: index % 4,
        }
    }

    /// The wavelengths of a set.
    #[inline]
    pub(crate) fn get(&self, set: usize) -> &Wavelengths {
        &self.sets[set].0
    }

    /// The sensor's response to a set.
    #[inline]
    pub(crate) fn sensor(&self, set: usize) -> &SensorWeights {
        &self.sets[set].1
    }

    /// The wavelengths of a pass that has one set: whichever lane chooses, it does for all paths.
    pub(crate) fn of_pass(&self, pass: &Pass) -> Wavelengths {
        let key = derived_key(stream_key(pass.seed, pass.replicate), CHOOSER);
        let first = (key >> 62) as usize + pass.number as usize;
        let lanes = WavelengthChoice {
            set: 0,
            first: first % 4,
        };
        self.of(lanes)
    }

    /// The wavelengths of a path.
    #[inline]
    pub(crate) fn of(&self, lanes: WavelengthChoice) -> Wavelengths {
        self.get(lanes.set).rotated(lanes.first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_return_to_the_order_of_their_set() {
        let set = Vec4::new(0.0, 1.0, 2.0, 3.0);
        for first in 0..4 {
            let wavelengths = Wavelengths {
                lambda: set,
                density: Vec4::ONE,
            };
            let lanes = WavelengthChoice { set: 0, first };
            assert_eq!(lanes.to_set(wavelengths.rotated(first).lambda), set);
            assert_eq!(lanes.of_set(set), wavelengths.rotated(first).lambda);
        }
    }
}
