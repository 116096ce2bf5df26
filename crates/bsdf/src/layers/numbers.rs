//! Random numbers for a walk, whose count has no bound: a stream keyed by what the walk depends on.

use etalon_sampling::hash::{fold_multiply, mix64};
use etalon_sampling::{Independent, Sampler};
use glam::{Vec2, Vec3, Vec4};

/// Any odd constant with mixed bits.
const FACTOR: u64 = 0xd6e8_feb8_6659_fd93;

/// The numbers of a walk.
#[derive(Debug)]
pub(crate) struct Numbers {
    /// The first pair, if it is given.
    first: Option<Vec2>,
    stream: Independent,
}

impl Numbers {
    /// The stream of these numbers at a place with the key `key`. If `first` is given it is the first pair, and the rest depends
    /// on it.
    pub(crate) fn keyed(key: u64, by: impl IntoIterator<Item = f32>, first: Option<Vec2>) -> Self {
        let pair = first.into_iter().flat_map(|pair| pair.to_array());
        Self {
            first,
            stream: Independent::from_key(by.into_iter().chain(pair).fold(key, with)),
        }
    }

    /// A number in [0, 1).
    #[inline]
    pub(crate) fn next(&mut self) -> f32 {
        self.stream.next_1d()
    }

    /// Two of them.
    #[inline]
    pub(crate) fn pair(&mut self) -> Vec2 {
        let mut drawn = || Vec2::new(self.stream.next_1d(), self.stream.next_1d());
        self.first.take().unwrap_or_else(&mut drawn)
    }
}

#[inline]
fn with(key: u64, x: f32) -> u64 {
    fold_multiply(key ^ u64::from(x.to_bits()), FACTOR).wrapping_add(key.rotate_left(29))
}

/// The key of a place and of wavelengths: the same whichever of them chooses.
pub(crate) fn place_key(position: Vec3, lambda: Vec4) -> u64 {
    let waves = (lambda.to_array().into_iter())
        .map(|x| mix64(u64::from(x.to_bits())))
        .fold(0, u64::wrapping_add);
    position.to_array().into_iter().fold(waves, with)
}
