//! What a shape in one smooth piece can do, as opposed to a mesh of triangles.

use crate::local_interaction::LocalInteraction;
use etalon_params::Params;
use glam::DVec3;

/// A smooth shape that intersects rays by a formula of its own.
pub(crate) trait Solid {
    /// The parameters of up to two crossings with the line o + t·d, in ascending order; NaN
    /// where there is none. The direction need not be a unit vector.
    fn crossings(&self, origin: DVec3, direction: DVec3) -> [f64; 2];

    /// The crossing nearest to `t` of the line, to the precision of double numbers; `t` itself if
    /// there is none.
    fn crossing_near(&self, origin: DVec3, direction: DVec3, t: f64) -> f64 {
        let [a, b] = self.crossings(origin, direction);
        // Also where one of them is NaN.
        let nearer = if (b - t).abs() < (a - t).abs() || a.is_nan() {
            b
        } else {
            a
        };
        if nearer.is_nan() { t } else { nearer }
    }

    /// The surface point at `p`, which is on the surface up to rounding; `p` is projected first.
    fn surface_near(&self, p: DVec3) -> LocalInteraction;

    /// The smallest axis-parallel box that holds the shape.
    fn bounds(&self) -> [DVec3; 2];
}

/// Reads `flip_normals`.
pub(crate) fn read_flip(params: &Params<'_>) -> bool {
    params.boolean_or("flip_normals", false)
}

/// Reads `face_normals` for a shape whose faces are flat anyway: it makes no difference there.
pub(crate) fn read_face_normals(params: &Params<'_>) {
    params.boolean_or("face_normals", false);
}
