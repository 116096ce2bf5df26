//! Near and far clipping: a camera sees what lies between two planes.

use etalon_params::Params;

/// Distances of the clipping planes along the camera's axis (camera space, m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipRange {
    /// Nothing nearer is seen; positive.
    pub near: f64,
    /// Nothing farther is seen; more than `near`.
    pub far: f64,
}

impl Default for ClipRange {
    fn default() -> Self {
        Self {
            near: 0.01,
            far: 10_000.0,
        }
    }
}

impl ClipRange {
    /// Reads `near_clip` and `far_clip`.
    pub fn from_params(params: &Params<'_>) -> Self {
        let default = Self::default();
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let near = params.float_where(
            "near_clip",
            default.near,
            "a finite number above 0",
            positive,
        );
        let far = params.float_where(
            "far_clip",
            default.far.max(2.0 * near),
            "a finite number above `near_clip`",
            |far| positive(far) && far > near,
        );
        Self { near, far }
    }
}
