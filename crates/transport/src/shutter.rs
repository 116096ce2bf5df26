//! The shutter: the interval of scene time that a picture averages over, and what moves while it is open.

use crate::RollingShutter;
use etalon_math::Motion;
use etalon_params::Params;

/// The moments between which light is gathered. A ray's `time` in [0, 1] runs from `open` to
/// `close`. As long as nothing in a scene moves, no pixel depends on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shutter {
    /// Scene time at which the shutter opens.
    pub open: f64,
    /// Scene time at which it closes; not before `open`.
    pub close: f64,
    /// How rows are exposed, if not all at once.
    pub rolling: Option<RollingShutter>,
    /// The scene time that `open` and `close` count from: 0, but for a frame of a film. What moves in the description counts from
    /// it, too.
    pub frame: f64,
}

impl Shutter {
    /// Reads `shutter_open`, `shutter_close` and the parameters of a rolling shutter, for a film of `rows` rows.
    pub fn from_params(params: &Params<'_>, rows: u32) -> Self {
        let rolling = RollingShutter::from_params(params, rows);
        let open = params.float_where("shutter_open", 0.0, "a finite number", f64::is_finite);
        let close = params.float_or("shutter_close", 0.0);
        if close >= open && close.is_finite() {
            return Self {
                open,
                close,
                rolling,
                frame: 0.0,
            };
        }
        let what = "a finite number not below `shutter_open`";
        if params.has("shutter_close") {
            params.refuse("shutter_close", close, what);
        } else {
            params.missing("shutter_close", what);
        }
        Self {
            open,
            close: open,
            rolling,
            frame: 0.0,
        }
    }

    /// Scene time of a ray's `time` in [0, 1].
    pub fn moment(&self, time: f32) -> f64 {
        self.open + (self.close - self.open) * f64::from(time)
    }

    /// Reads how the property `name` (a transform or an animation) moves things, in units of this interval;
    /// the identity if it is not given. After a mistake, which has been recorded, `None`.
    pub fn motion(&self, params: &Params<'_>, name: &str) -> Option<Motion> {
        Some(params.motion(name)?.within(self.open, self.close))
    }
}
