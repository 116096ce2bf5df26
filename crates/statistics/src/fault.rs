//! Numbers an accumulator refuses, and how many of each kind there were.

/// Why a number was not accumulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InvalidValue {
    /// It is not a number.
    NotANumber,
    /// It is infinite.
    Infinite,
    /// It, or the sum with it, is out of range.
    OutOfRange,
}

impl InvalidValue {
    /// The fault of a number that is known to be unusable.
    pub(crate) fn of(x: f64) -> Self {
        if x.is_nan() {
            Self::NotANumber
        } else if x.is_infinite() {
            Self::Infinite
        } else {
            Self::OutOfRange
        }
    }
}

impl std::fmt::Display for InvalidValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NotANumber => "not a number",
            Self::Infinite => "infinite",
            Self::OutOfRange => "out of the accumulator's range",
        })
    }
}

impl std::error::Error for InvalidValue {}

/// How many numbers were refused, by kind. Counts add up in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Faults {
    /// Not numbers.
    pub nan: u64,
    /// Infinities.
    pub infinite: u64,
    /// Out of range.
    pub overflow: u64,
}

impl Faults {
    /// None yet.
    pub const NONE: Self = Self {
        nan: 0,
        infinite: 0,
        overflow: 0,
    };

    /// Counts one fault.
    pub fn count(&mut self, fault: InvalidValue) {
        let counter = match fault {
            InvalidValue::NotANumber => &mut self.nan,
            InvalidValue::Infinite => &mut self.infinite,
            InvalidValue::OutOfRange => &mut self.overflow,
        };
        *counter += 1;
    }

    /// Counts the fault, if there was one; says whether all was well.
    #[inline]
    pub fn note(&mut self, outcome: Result<(), InvalidValue>) -> bool {
        match outcome {
            Ok(()) => true,
            Err(fault) => {
                self.count(fault);
                false
            }
        }
    }

    /// Adds another count.
    pub fn merge(&mut self, other: Self) {
        self.nan += other.nan;
        self.infinite += other.infinite;
        self.overflow += other.overflow;
    }

    /// All kinds together.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.nan + self.infinite + self.overflow
    }

    /// Whether nothing was refused.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.total() == 0
    }
}
