//! Integer samples as they are in a file, with the value of each.

/// Samples pixel after pixel, and a table of their values.
#[derive(Clone, Debug, PartialEq)]
pub struct Coded<S> {
    /// One or three for each pixel.
    pub samples: Vec<S>,
    /// The value of each integer.
    pub values: &'static [f32],
    /// Samples for each pixel, 1 or 3.
    pub channels: usize,
}

/// What is looked up by its index.
pub(crate) trait At<T> {
    /// Number `index`.
    fn at(&self, index: usize) -> T;
}

impl<T: Copy> At<T> for Vec<T> {
    #[inline(always)]
    fn at(&self, index: usize) -> T {
        self[index]
    }
}

/// Of one channel.
impl<S: Copy + Into<usize>> At<f32> for Coded<S> {
    #[inline(always)]
    fn at(&self, index: usize) -> f32 {
        self.values[self.samples[index].into()]
    }
}

/// Of three channels.
impl<S: Copy + Into<usize>> At<[f32; 3]> for Coded<S> {
    #[inline(always)]
    fn at(&self, index: usize) -> [f32; 3] {
        let [a, b, c] = triple(&self.samples, index);
        [a, b, c].map(|sample| self.values[sample.into()])
    }
}

impl<S> Coded<S> {
    /// Memory of the samples (bytes).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.samples[..])
    }
}

/// Three samples from three times `index` on.
#[inline(always)]
pub(crate) fn triple<S: Copy>(samples: &[S], index: usize) -> [S; 3] {
    let from = &samples[3 * index..][..3];
    [from[0], from[1], from[2]]
}
