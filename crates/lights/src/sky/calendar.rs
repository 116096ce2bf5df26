//! The days and hours that a sky passes through while the shutter is open.
//!
//! Each of the days is passed from one hour of the clock to another, one after the other, evenly: the share t of the
//! shutter interval is the moment of the day ⌊t n⌋ of n where the share t n − ⌊t n⌋ of these hours is over.

use super::sun_position::{Moment, Place, date_from_params, julian_day};
use etalon_params::Params;
use etalon_transport::Shutter;

/// Days, and the hours of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Calendar {
    place: Place,
    /// Year, month and day.
    first: [i64; 3],
    days: f64,
    /// Hours since midnight between which a day is passed.
    window: [f64; 2],
    /// What share of all this is over when the shutter of the sensor opens, and when it closes.
    over: [f64; 2],
}

impl Calendar {
    /// Reads a [`Place`], `start_year`, `start_month`, `start_day`, `end_year`, `end_month`, `end_day`,
    /// `window_start_time`, `window_end_time`, `shutter_open` and `shutter_close`; by default, as in Mitsuba, the year
    /// from 1 January 2025 on, each day from 7 to 19 o'clock, while scene time runs from 0 to 1. The last day is not
    /// passed, unless it is the first. `shutter` is that of the sensor.
    pub(crate) fn from_params(params: &Params<'_>, shutter: &Shutter) -> Self {
        let names = ["start_year", "start_month", "start_day"];
        let first = date_from_params(params, names, [2025, 1, 1]);
        let [year, month, day] = first;
        let names = ["end_year", "end_month", "end_day"];
        let last = date_from_params(params, names, [year + 1, month, day]);
        let days = julian_day(last) - julian_day(first);
        if days < 0 {
            let message = "the last day must not be before the first";
            let name = names.into_iter().find(|name| params.has(name));
            params.error_at(name.unwrap_or(names[0]), message);
        }
        let hour = |name: &str, default: f64, low: f64, what: &str| {
            params.float_where(name, default, what, |x| (low..=24.0).contains(&x))
        };
        let from = hour("window_start_time", 7.0, 0.0, "hours from 0 to 24");
        let what = "hours from `window_start_time` to 24";
        let to = hour("window_end_time", 19.0, from, what);
        let what = "a finite number";
        let open = params.float_where("shutter_open", 0.0, what, f64::is_finite);
        let what = "a finite number above `shutter_open`";
        let close = params.float_where("shutter_close", 1.0, what, |x| x > open && x.is_finite());
        Self {
            place: Place::from_params(params),
            first,
            days: days.max(1) as f64,
            window: [from, to],
            over: [shutter.open, shutter.close]
                .map(|at| (shutter.frame + at - open) / (close - open)),
        }
    }

    /// The moment when the share `time` of the sensor's shutter interval is over.
    pub(crate) fn moment(&self, time: f32) -> Moment {
        let ([open, close], [from, to]) = (self.over, self.window);
        let passed = (open + (close - open) * f64::from(time)) * self.days;
        // The very end belongs to the last day, not to the next.
        let whole = if passed == self.days {
            passed - 1.0
        } else {
            passed.floor()
        };
        let [year, month, day] = self.first;
        Moment {
            place: self.place,
            date: [year, month, day.saturating_add(whole as i64)],
            hours: from + (to - from) * (passed - whole),
        }
    }

    /// Whether it is the same moment from first to last.
    pub(crate) fn stands_still(&self) -> bool {
        self.over[0] == self.over[1]
    }
}
