//! One part of many: `I/N`, as work is split between machines or days.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

/// Part I of N.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartOfMany {
    /// Which one, counted from 1.
    pub number: u32,
    /// How many there are.
    pub count: u32,
}

impl PartOfMany {
    /// Whether the part is dealt the thing at `place`, counted from 0. Things are dealt in turn, so
    /// that neighbours, which are often alike, go to different parts.
    pub fn is_dealt(self, place: usize) -> bool {
        place as u64 % u64::from(self.count) + 1 == u64::from(self.number)
    }
}

impl FromStr for PartOfMany {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let part = text.split_once('/').and_then(|(number, count)| {
            Some(Self {
                number: number.parse().ok()?,
                count: count.parse().ok()?,
            })
        });
        part.filter(|part| (1..=part.count).contains(&part.number))
            .ok_or_else(|| {
                "expected I/N with I from 1 to N, such as 1/4 for the first of four".to_owned()
            })
    }
}

impl Display for PartOfMany {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_is_dealt_to_one_part() {
        for count in 1..7 {
            for place in 0..50 {
                let parts =
                    (1..=count).filter(|&number| PartOfMany { number, count }.is_dealt(place));
                assert_eq!(parts.count(), 1, "{place} of {count}");
            }
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let part = PartOfMany {
            number: 2,
            count: 3,
        };
        assert_eq!(part.to_string().parse(), Ok(part));
        for wrong in ["", "1", "0/2", "3/2", "1/0", "-1/2", "a/b", "1/2/3"] {
            assert!(wrong.parse::<PartOfMany>().is_err(), "{wrong}");
        }
    }
}
