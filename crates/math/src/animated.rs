//! Something that an affine map places and that may move while the shutter is open.

use crate::Motion;
use glam::DAffine3;
use std::sync::Arc;

/// Types that are made from an affine map: a placement, a pose.
pub trait FromAffine {
    /// That of this invertible map.
    fn from_affine(map: &DAffine3) -> Self;
}

/// Something that stands still or moves while the shutter is open.
#[derive(Clone, Debug, PartialEq)]
pub struct Animated<T> {
    still: T,
    motion: Option<Arc<Motion>>,
}

impl<T> From<T> for Animated<T> {
    fn from(still: T) -> Self {
        Self {
            still,
            motion: None,
        }
    }
}

impl<T: FromAffine> Animated<T> {
    /// Its motion, in units of the shutter interval, see [`Motion::within`].
    pub fn new(motion: Motion) -> Self {
        let still = T::from_affine(&motion.at(0.0));
        Self {
            motion: motion.moves().then(|| Arc::new(motion)),
            still,
        }
    }

    /// Calls `ask` with its value at `time`, from 0 (the shutter opens) to 1.
    #[inline]
    pub fn at<R>(&self, time: f32, ask: impl FnOnce(&T) -> R) -> R {
        match &self.motion {
            None => ask(&self.still),
            Some(motion) => ask(&T::from_affine(&motion.at(time.into()))),
        }
    }

    /// Its value when the shutter opens.
    #[inline]
    pub fn start(&self) -> &T {
        &self.still
    }

    /// Its motion, if it moves.
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_deref()
    }
}
