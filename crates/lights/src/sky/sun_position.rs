//! Where the sun stands at a moment and a place.
//!
//! The algorithm PSA of Blanco-Muriel, Alarcón-Padilla, López-Moratalla and Lara-Coira (2001), *Computing the Solar
//! Vector*: ecliptic coordinates of the sun as short series in the days since noon of 1 January 2000 (UT), turned to
//! the equator and then to the horizon. Off by less than 0.01° from 1999 to 2015.

use core::f64::consts::{PI, TAU};
use etalon_math::float64;
use etalon_params::Params;

/// The mean radius of the earth over the astronomical unit.
const PARALLAX: f64 = 6371.01 / 149_597_890.0;

/// A place on earth and its clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Degrees, north positive.
    latitude: f64,
    /// Degrees, east positive.
    longitude: f64,
    /// Hours of the clock before universal time.
    timezone: f64,
}

/// A moment by the clock of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moment {
    pub(crate) place: Place,
    /// Year, month and day; the day may be beyond the end of its month.
    pub(crate) date: [i64; 3],
    /// Hours since midnight, by the clock.
    pub(crate) hours: f64,
}

/// A number within bounds.
fn within(params: &Params<'_>, name: &str, default: f64, [low, high]: [f64; 2], what: &str) -> f64 {
    params.float_where(name, default, what, |x| (low..=high).contains(&x))
}

/// Reads a date from parameters with these names of year, month and day.
pub(crate) fn date_from_params(
    params: &Params<'_>,
    names: [&str; 3],
    default: [i64; 3],
) -> [i64; 3] {
    let bounds = [(1, 9999, "a year"), (1, 12, "a month"), (1, 31, "a day")];
    std::array::from_fn(|i| {
        let (low, high, what) = bounds[i];
        let value = params.integer_or(names[i], default[i]);
        if !(low..=high).contains(&value) {
            params.refuse(names[i], value, &format!("{what} from {low} to {high}"));
        }
        value.clamp(low, high)
    })
}

/// The number of the Julian day that begins at noon of a date (Fliegel and Van Flandern 1968); divisions toward zero.
pub(crate) fn julian_day([year, month, day]: [i64; 3]) -> i64 {
    let shift = (month - 14) / 12;
    (1461 * (year + 4800 + shift)) / 4 + (367 * (month - 2 - 12 * shift)) / 12
        - (3 * ((year + 4900 + shift) / 100)) / 4
        + day
        - 32075
}

impl Place {
    /// Reads `latitude`, `longitude` and `timezone`; by default Tokyo, as in Mitsuba.
    pub(crate) fn from_params(params: &Params<'_>) -> Self {
        let angle = |name: &str, default: f64, most: f64| {
            let what = format!("degrees from -{most} to {most}");
            within(params, name, default, [-most, most], &what)
        };
        Self {
            latitude: angle("latitude", 35.6894, 90.0),
            longitude: angle("longitude", 139.6917, 180.0),
            timezone: within(
                params,
                "timezone",
                9.0,
                [-14.0, 14.0],
                "hours from -14 to 14",
            ),
        }
    }
}

impl Moment {
    /// Reads a [`Place`] and `year`, `month`, `day`, `hour`, `minute`, `second`; by default, as in Mitsuba, 10 July 2010
    /// at three in the afternoon.
    pub(crate) fn from_params(params: &Params<'_>) -> Self {
        let clock = |name: &str, default: f64, end: f64, what: &str| {
            within(params, name, default, [0.0, end], what)
        };
        Self {
            place: Place::from_params(params),
            date: date_from_params(params, ["year", "month", "day"], [2010, 7, 10]),
            hours: clock("hour", 15.0, 24.0, "hours from 0 to 24")
                + clock("minute", 0.0, 60.0, "minutes from 0 to 60") / 60.0
                + clock("second", 0.0, 60.0, "seconds from 0 to 60") / 3600.0,
        }
    }

    /// Days since noon of 1 January 2000, universal time, and hours of universal time.
    fn days(&self) -> (f64, f64) {
        let hours = self.hours - self.place.timezone;
        let days = julian_day(self.date) as f64 - 0.5 + hours / 24.0;
        (days - 2_451_545.0, hours)
    }

    /// Angle from the zenith and azimuth of the sun, rad. The azimuth is 0 in the south and grows toward the west.
    pub(crate) fn sun_position(&self) -> [f64; 2] {
        let (days, hours) = self.days();
        let node = 2.1429 - 0.001_039_459_4 * days;
        let mean = 4.895_063 + 0.017_202_791_698 * days;
        let anomaly = 6.240_060 + 0.017_201_969_9 * days;
        let longitude = mean
            + 0.033_416_07 * float64::sin(anomaly)
            + 0.000_348_94 * float64::sin(2.0 * anomaly)
            - 0.000_113_4
            - 0.000_020_3 * float64::sin(node);
        let obliquity = 0.409_092_8 - 6.2140e-9 * days + 0.000_039_6 * float64::cos(node);
        let (sin_l, cos_l) = float64::sin_cos(longitude);
        let (sin_o, cos_o) = float64::sin_cos(obliquity);
        let ascension = float64::atan2(cos_o * sin_l, cos_l);
        let declination = float64::asin(sin_o * sin_l);
        let sidereal = 6.697_424_324_2 + 0.065_709_828_3 * days + hours;
        let hour_angle = (15.0 * sidereal + self.place.longitude).to_radians() - ascension;
        let (sin_h, cos_h) = float64::sin_cos(hour_angle);
        let (sin_b, cos_b) = float64::sin_cos(self.place.latitude.to_radians());
        let height = cos_b * cos_h * float64::cos(declination) + float64::sin(declination) * sin_b;
        let zenith = float64::acos(height.clamp(-1.0, 1.0));
        let azimuth = float64::atan2(-sin_h, float64::tan(declination) * cos_b - sin_b * cos_h);
        [
            zenith + PARALLAX * float64::sin(zenith),
            azimuth.rem_euclid(TAU) - PI,
        ]
    }
}
