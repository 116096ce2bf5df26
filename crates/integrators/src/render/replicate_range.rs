//! Shares of an image's replicates, as parts of a render are dealt them.

/// A range of an image's replicates, each with the bits that it has in a render of all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReplicateRange {
    /// The first.
    pub first: u32,
    /// Their number.
    pub count: u32,
}

impl ReplicateRange {
    /// Share `index` of `count`, counted from 0, where `replicates` are dealt in order and as
    /// evenly as they can be; `None` if there is no such share or it would be empty.
    pub fn of(replicates: u32, index: u32, count: u32) -> Option<Self> {
        if index >= count || count > replicates {
            return None;
        }
        let begin = |index: u32| {
            let before = u64::from(replicates) * u64::from(index) / u64::from(count);
            u32::try_from(before).ok()
        };
        let first = begin(index)?;
        let count = begin(index + 1)? - first;
        Some(Self { first, count })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replicates_are_dealt_evenly_and_in_order() {
        for replicates in (1..40).chain([4095, 4096, u32::MAX]) {
            for count in (1..=replicates.min(50)).chain([replicates]).take(50) {
                let mut next = 0;
                for index in 0..count {
                    let share =
                        ReplicateRange::of(replicates, index, count).expect("enough for all");
                    assert_eq!(share.first, next);
                    assert!([0, 1].contains(&(share.count - replicates / count)));
                    next += share.count;
                }
                assert_eq!(next, replicates);
            }
            assert_eq!(
                ReplicateRange::of(replicates, 0, replicates.saturating_add(1)).is_none(),
                replicates < u32::MAX
            );
        }
        assert_eq!(ReplicateRange::of(4, 2, 2), None);
        assert_eq!(ReplicateRange::of(4, 0, 0), None);
    }
}
