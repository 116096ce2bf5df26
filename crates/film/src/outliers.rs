//! Samples that stand out: how many there were, how large, and where the largest came from.
//!
//! A sample *stands out* if it brings more than all the others of its pixel and replicate together.
//! With fewer than [`FEWEST`] samples this is not decided. Its value is the largest component (linear
//! Rec. 709) of its contributions to its pixel and by splats. It *lifts* the pixel, in the mean of its
//! replicate, by that value over the pixel's number of samples.
//!
//! A *firefly* is a sample that stands out and lifts its pixel in the finished picture by more than
//! the picture's mean. The mean is known only at the end, so samples that stand out are counted by
//! powers of two.

use serde::{Deserialize, Serialize};

/// The fewest samples of a pixel in which one can stand out.
pub const FEWEST: u32 = 8;

/// A sample that stands out: enough to compute it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outlier {
    /// The replicate.
    pub replicate: u32,
    /// The pixel for which it was drawn.
    pub pixel: [u32; 2],
    /// Its number within pixel and replicate.
    pub sample: u32,
    /// Its value.
    pub value: f32,
    /// Its contribution to the pixel in its replicate's mean.
    pub lift: f32,
}

impl Outlier {
    /// Whether it comes before another: the one that lifts more; of equal ones the first that one
    /// thread renders.
    fn precedes(&self, other: &Self) -> bool {
        let place = |o: &Self| (o.replicate, o.pixel[1], o.pixel[0], o.sample);
        let order = other.lift.total_cmp(&self.lift);
        order.then_with(|| place(self).cmp(&place(other))).is_lt()
    }
}

/// Counts of samples that stand out, and the largest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OutlierLog {
    /// How many lift their pixel by 2ᵉ or more, but less than 2ᵉ⁺¹: pairs of e and their number, by
    /// e.
    counts: Vec<(i32, u64)>,
    /// The largest, at most [`OutlierLog::KEPT`] of them.
    largest: Vec<Outlier>,
}

impl OutlierLog {
    /// Number of outliers that are kept.
    pub const KEPT: usize = 8;

    /// Whether nothing stands out.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// The largest, the largest first.
    pub fn largest(&self) -> &[Outlier] {
        &self.largest
    }

    /// Number of those that lift their pixel in its replicate by at least 2ᵉ.
    pub fn count_from(&self, exponent: i32) -> u64 {
        let beyond = self.counts.iter().filter(|(e, _)| *e >= exponent);
        beyond.map(|(_, count)| count).sum()
    }

    /// The least e such that 2ᵉ is `value` or more; `None` unless that is positive and finite.
    pub fn exponent_above(value: f32) -> Option<i32> {
        let sound = value > 0.0 && value.is_finite();
        let exact = value.to_bits() & 0x7f_ffff == 0;
        sound.then(|| exponent(value) + i32::from(!exact))
    }

    /// Counts one, and keeps it if it is among the largest.
    pub(crate) fn note(&mut self, outlier: Outlier) {
        self.count(exponent(outlier.lift), 1);
        self.keep(outlier);
    }

    /// Adds another log; the order of additions does not matter.
    pub(crate) fn merge(&mut self, other: Self) {
        for (exponent, count) in other.counts {
            self.count(exponent, count);
        }
        other.largest.into_iter().for_each(|o| self.keep(o));
    }

    fn count(&mut self, exponent: i32, count: u64) {
        match self.counts.binary_search_by_key(&exponent, |(e, _)| *e) {
            Ok(place) => self.counts[place].1 += count,
            Err(place) => self.counts.insert(place, (exponent, count)),
        }
    }

    fn keep(&mut self, outlier: Outlier) {
        let place = (self.largest).partition_point(|kept| kept.precedes(&outlier));
        if place < Self::KEPT {
            self.largest.insert(place, outlier);
            self.largest.truncate(Self::KEPT);
        }
    }
}

/// ⌊log₂ x⌋ of a positive number; subnormal ones count as the smallest that are not.
fn exponent(x: f32) -> i32 {
    ((x.to_bits() >> 23) & 0xff) as i32 - 127
}

/// The sum and the largest of a pixel's samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DominantSample {
    total: f32,
    most: f32,
    sample: u32,
}

impl DominantSample {
    /// Sample `sample` brings `value`; not a number is nothing.
    #[inline]
    pub(crate) fn bring(&mut self, sample: u32, value: f32) {
        let value = value.max(0.0);
        self.total += value;
        if value > self.most {
            self.most = value;
            self.sample = sample;
        }
    }

    /// Its numbers as words, to be kept.
    pub(crate) fn words(&self) -> [u32; 3] {
        [self.total.to_bits(), self.most.to_bits(), self.sample]
    }

    /// From its stored words.
    pub(crate) fn from_words([total, most, sample]: [u32; 3]) -> Self {
        Self {
            total: f32::from_bits(total),
            most: f32::from_bits(most),
            sample,
        }
    }

    /// The sample that stands out among so many, and its value.
    pub(crate) fn outstanding(&self, samples: u32) -> Option<(u32, f32)> {
        let alone = samples >= FEWEST && 2.0 * self.most > self.total && self.most.is_finite();
        alone.then_some((self.sample, self.most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outlier(sample: u32, lift: f32) -> Outlier {
        Outlier {
            replicate: 0,
            pixel: [0, 0],
            sample,
            value: lift,
            lift,
        }
    }

    #[test]
    fn one_of_many_stands_out() {
        let standing = |values: &[f32]| {
            let mut standing = DominantSample::default();
            for (sample, &value) in values.iter().enumerate() {
                standing.bring(sample as u32, value);
            }
            standing.outstanding(values.len() as u32)
        };
        assert_eq!(standing(&[0.0; 20]), None);
        assert_eq!(standing(&[1.0; 20]), None);
        assert_eq!(standing(&[1.0, 9.0]), None);
        let eight = [1.0, 1.0, 9.0, 1.0, 1.0, f32::NAN, 1.0, 1.0];
        assert_eq!(standing(&eight), Some((2, 9.0)));
        let two = [1.0, 1.0, 9.0, 1.0, 9.0, 1.0, 1.0, 1.0];
        assert_eq!(standing(&two), None);
    }

    #[test]
    fn counts_and_the_largest_add_up_in_any_order() {
        let all: Vec<Outlier> = (0..40)
            .map(|i| outlier(i, 0.3 * ((i * 7) % 13) as f32 + 0.1))
            .collect();
        let log = |outliers: &[Outlier]| {
            let mut log = OutlierLog::default();
            outliers.iter().cloned().for_each(|o| log.note(o));
            log
        };
        let whole = log(&all);
        for cut in [0, 5, 20, 39] {
            let (a, b) = all.split_at(cut);
            for (first, second) in [(a, b), (b, a)] {
                let mut sum = log(first);
                sum.merge(log(second));
                assert_eq!(sum, whole);
            }
        }
        assert_eq!(whole.largest().len(), OutlierLog::KEPT);
        for exponent in -5..4 {
            let bound = if exponent < 0 {
                1.0 / (1 << -exponent) as f32
            } else {
                (1 << exponent) as f32
            };
            let expected = all.iter().filter(|o| o.lift >= bound).count();
            assert_eq!(whole.count_from(exponent), expected as u64);
            assert_eq!(OutlierLog::exponent_above(bound), Some(exponent));
            assert_eq!(OutlierLog::exponent_above(bound * 1.01), Some(exponent + 1));
        }
        assert_eq!(OutlierLog::exponent_above(0.0), None);
        assert_eq!(OutlierLog::exponent_above(f32::NAN), None);
    }
}
