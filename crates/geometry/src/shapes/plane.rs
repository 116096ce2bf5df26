//! `plane`: z = 0 without end, under any affine map; as a solid everything below.
//!
//! A line o + t·d meets it at t = −oz/dz. So that a half-space is left as often as it is entered, a line that goes down
//! leaves it at t = ∞.

use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use etalon_params::Params;
use glam::DVec3;

/// A plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane;

impl Plane {
    /// Reads `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        Placed::from_params(params, Some(Self))
    }
}

impl OwnShape for Plane {
    fn next_crossing(&self, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let (o, d) = (line.origin.z, line.direction.z);
        let enters = d < 0.0;
        let t = -o / d;
        if d != 0.0 && t > after {
            return Some(Crossing::new(t, enters));
        }
        let stays = enters || (d == 0.0 && o < 0.0);
        (stays && after < f64::INFINITY).then(|| Crossing::new(f64::INFINITY, false))
    }

    fn surface_at(&self, p: DVec3, _: &Crossing) -> OwnPoint {
        OwnPoint {
            position: DVec3::new(p.x, p.y, 0.0),
            normal: DVec3::Z,
            uv: p.truncate(),
            dp_du: DVec3::X,
            dp_dv: DVec3::Y,
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        let low = DVec3::NEG_INFINITY;
        [low, DVec3::new(f64::INFINITY, f64::INFINITY, 0.0)]
    }
}
