//! Newton's method between bounds.

/// An interval that holds a zero: Newton's steps stay within, and it is halved where they would leave it.
#[derive(Clone, Copy, Debug)]
pub struct Bracket {
    low: f64,
    high: f64,
}

impl Bracket {
    /// The interval between two bounds.
    #[inline]
    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Its middle.
    #[inline]
    pub fn middle(&self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Ends the interval at `x`, which lies above the zero or below.
    #[inline]
    pub fn cut(&mut self, x: f64, is_above: bool) {
        if is_above {
            self.high = x;
        } else {
            self.low = x;
        }
    }

    /// Where Newton's method goes if that is inside, otherwise the middle.
    #[inline]
    pub fn within(&self, newton: f64) -> f64 {
        if newton > self.low && newton < self.high {
            newton
        } else {
            self.middle()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_that_leaves_the_interval_halves_it() {
        let mut bracket = Bracket::new(0.0, 4.0);
        assert_eq!(bracket.within(3.5), 3.5);
        bracket.cut(3.0, true);
        bracket.cut(1.0, false);
        for outside in [0.5, 1.0, 3.0, 3.5, f64::NAN] {
            assert_eq!(bracket.within(outside), 2.0, "{outside}");
        }
    }
}
