//! A rolling shutter: the rows of a picture are exposed one after another, from the top, as in Blender's Cycles.
//!
//! Of the interval of the shutter, [0, 1], row i of n is exposed during the share d around its own moment:
//!
//! ```text
//! t = (1 − d) (i + 1/2) / n + d u,   u in [0, 1)
//! ```

use etalon_params::Params;

/// When the rows of a picture are exposed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RowExposure {
    /// All of them while the shutter is open.
    #[default]
    Together,
    /// One after another, each for a while.
    InTurn,
    /// One after another, each at one moment.
    Instants,
}

/// Rows that are exposed one after another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingShutter {
    /// n.
    rows: f32,
    /// d.
    duration: f32,
}

impl RollingShutter {
    /// Reads `rolling_shutter_type`, `none` (default) or `top`, and `rolling_shutter_duration` (0.1), for a film of `rows` rows.
    /// `None` if all rows are exposed at the same time.
    pub fn from_params(params: &Params<'_>, rows: u32) -> Option<Self> {
        let kind = params.choice("rolling_shutter_type", "none", &["none", "top"]);
        let what = "a share of the shutter's interval, 0 to 1";
        let is_share = |share| (0.0..=1.0).contains(&share);
        let duration = params.float_where("rolling_shutter_duration", 0.1, what, is_share);
        (kind == "top").then_some(Self {
            rows: rows as f32,
            duration: duration as f32,
        })
    }

    /// t for the row that the film position `y` (pixels of the whole film) lies in.
    #[inline]
    pub fn moment(&self, y: f32, u: f32) -> f32 {
        self.begin(y) + self.duration * u
    }

    /// The density of [`RollingShutter::moment`] at the moment t, if d is above 0.
    #[inline]
    pub fn exposure(&self, y: f32, time: f32) -> f32 {
        let since = time - self.begin(y);
        if (0.0..self.duration).contains(&since) {
            1.0 / self.duration
        } else {
            0.0
        }
    }

    /// When rows are exposed.
    pub fn rows(&self) -> RowExposure {
        match self.duration > 0.0 {
            true => RowExposure::InTurn,
            false => RowExposure::Instants,
        }
    }

    /// When the row of `y` begins to be exposed.
    #[inline]
    fn begin(&self, y: f32) -> f32 {
        let row = y.floor().clamp(0.0, self.rows - 1.0);
        (1.0 - self.duration) * ((row + 0.5) / self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four rows, each exposed for a fifth of the interval; what is around the film has the moments of its nearest row.
    #[test]
    fn rows_follow_one_another() {
        let rolling = RollingShutter {
            rows: 4.0,
            duration: 0.2,
        };
        let exposures = [0.1, 0.3, 0.5, 0.7].map(|open| [open, open + 0.2]);
        for (y, [open, close]) in [0.9, 1.0, 2.5, 3.0].into_iter().zip(exposures) {
            assert!((rolling.moment(y, 0.0) - open).abs() < 1e-6, "{y}");
            assert!((rolling.moment(y, 1.0) - close).abs() < 1e-6, "{y}");
        }
        for (y, time) in [(0.5, 0.11), (0.5, 0.29), (3.9, 0.71), (3.9, 0.89)] {
            assert_eq!(rolling.exposure(y, time), 5.0, "{y} {time}");
        }
        for (y, time) in [(0.5, 0.09), (0.5, 0.31), (3.9, 0.69), (3.9, 0.91)] {
            assert_eq!(rolling.exposure(y, time), 0.0, "{y} {time}");
        }
        assert_eq!(rolling.moment(-3.0, 0.5), rolling.moment(0.0, 0.5));
        assert_eq!(rolling.moment(9.0, 0.5), rolling.moment(3.0, 0.5));
        let whole = RollingShutter {
            rows: 4.0,
            duration: 1.0,
        };
        assert_eq!(whole.moment(2.0, 0.3), 0.3);
    }
}
