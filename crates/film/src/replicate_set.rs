//! Which replicates of an image there are: a set of whole numbers, as ranges.
//!
//! As JSON it is a list of pairs, each the first replicate and the one after the last, in
//! ascending order and neither touching nor overlapping: `[[0, 3], [5, 6]]` are 0, 1, 2 and 5.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A set of replicates.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<[u32; 2]>", into = "Vec<[u32; 2]>")]
pub struct ReplicateSet(Vec<Range<u32>>);

impl ReplicateSet {
    /// The replicates of one range.
    #[must_use]
    pub fn new(range: Range<u32>) -> Self {
        Self((!range.is_empty()).then_some(range).into_iter().collect())
    }

    /// Number of replicates.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.0.iter().map(|range| range.end - range.start).sum()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// One beyond the last.
    #[must_use]
    pub fn end(&self) -> u32 {
        self.0.last().map_or(0, |range| range.end)
    }

    /// All of them, ascending.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.0.iter().flat_map(Clone::clone)
    }

    /// Those that are in either.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let mut all: Vec<_> = self.0.iter().chain(&other.0).cloned().collect();
        all.sort_unstable_by_key(|range| range.start);
        let mut joined: Vec<Range<u32>> = Vec::with_capacity(all.len());
        for range in all {
            match joined.last_mut() {
                Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
                _ => joined.push(range),
            }
        }
        Self(joined)
    }

    /// Those that are in both.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let mut common = Vec::new();
        let (mut a, mut b) = (self.0.iter().peekable(), other.0.iter().peekable());
        while let (Some(x), Some(y)) = (a.peek(), b.peek()) {
            let both = x.start.max(y.start)..x.end.min(y.end);
            if x.end < y.end {
                a.next();
            } else {
                b.next();
            }
            if !both.is_empty() {
                common.push(both);
            }
        }
        Self(common)
    }

    /// Those below `end` that are not in it.
    #[must_use]
    pub fn missing(&self, end: u32) -> Self {
        let mut gaps = Vec::new();
        let mut next = 0;
        for range in &self.0 {
            if next < range.start.min(end) {
                gaps.push(next..range.start.min(end));
            }
            next = range.end;
        }
        if next < end {
            gaps.push(next..end);
        }
        Self(gaps)
    }
}

impl std::fmt::Display for ReplicateSet {
    /// `0 to 2, 5`; `none` of an empty set.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_empty() {
            return f.write_str("none");
        }
        for (index, range) in self.0.iter().enumerate() {
            let (first, last) = (range.start, range.end - 1);
            f.write_str(if index == 0 { "" } else { ", " })?;
            if first == last {
                write!(f, "{first}")?;
            } else {
                write!(f, "{first} to {last}")?;
            }
        }
        Ok(())
    }
}

impl TryFrom<Vec<[u32; 2]>> for ReplicateSet {
    type Error = &'static str;

    fn try_from(pairs: Vec<[u32; 2]>) -> Result<Self, Self::Error> {
        let apart = pairs.windows(2).all(|pair| pair[0][1] < pair[1][0]);
        if !apart || pairs.iter().any(|[first, end]| first >= end) {
            return Err("ranges of replicates that are empty, out of order or not apart");
        }
        Ok(Self(
            pairs.into_iter().map(|[first, end]| first..end).collect(),
        ))
    }
}

impl From<ReplicateSet> for Vec<[u32; 2]> {
    fn from(set: ReplicateSet) -> Self {
        let pairs = set.0.into_iter().map(|range| [range.start, range.end]);
        pairs.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn set(bits: u32) -> ReplicateSet {
        (0..32)
            .filter(|n| bits >> n & 1 == 1)
            .fold(ReplicateSet::default(), |set, n| {
                set.union(&ReplicateSet::new(n..n + 1))
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: proptest::test_runner::RngSeed::Fixed(31),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        /// Sets of ranges are sets: held against the bits of machine words.
        #[test]
        fn ranges_are_sets(a: u32, b: u32, end in 0u32..32) {
            let (x, y) = (set(a), set(b));
            prop_assert_eq!(x.count(), a.count_ones());
            prop_assert_eq!(x.end(), 32 - a.leading_zeros());
            prop_assert!(x.iter().eq((0..32).filter(|n| a >> n & 1 == 1)));
            prop_assert_eq!(x.union(&y), set(a | b));
            prop_assert_eq!(x.intersection(&y), set(a & b));
            prop_assert_eq!(x.missing(end), set(!a & ((1 << end) - 1)));
            let pairs: Vec<[u32; 2]> = x.clone().into();
            prop_assert_eq!(ReplicateSet::try_from(pairs), Ok(x));
        }
    }

    #[test]
    fn sets_in_words() {
        assert_eq!(set(0).to_string(), "none");
        assert_eq!(set(0b10_0111).to_string(), "0 to 2, 5");
        for bad in [
            vec![[2, 2]],
            vec![[3, 2]],
            vec![[0, 2], [2, 3]],
            vec![[4, 5], [0, 1]],
        ] {
            assert!(ReplicateSet::try_from(bad).is_err());
        }
    }
}
