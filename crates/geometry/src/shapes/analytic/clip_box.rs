//! The axis-parallel box that cuts an endless surface, and whose faces close the solid that it bounds.

use crate::shapes::analytic::crossing::Line;
use crate::shapes::analytic::placed::OwnPoint;
use core::f64::consts::{PI, TAU};
use etalon_math::float64::atan2;
use etalon_params::Params;
use glam::{DVec2, DVec3};

/// The face of the surface in the box; those of the box follow: low x, high x, low y, ….
pub(crate) const CURVED: u32 = 0;

/// The number of faces.
pub(crate) const FACES: u32 = 7;

/// A box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClipBox {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl ClipBox {
    /// Reads the corners `min` and `max` (from −1 to 1 along each axis); `None` after a mistake.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        Self::from_params_or(params, 1.0)
    }

    /// The same, from −`half` to `half` if the scene does not say.
    pub(crate) fn from_params_or(params: &Params<'_>, half: f64) -> Option<Self> {
        let low = params.vector("min").unwrap_or(DVec3::splat(-half));
        let high = params.vector("max").unwrap_or(DVec3::splat(half));
        if !(low.cmplt(high).all() && low.is_finite() && high.is_finite()) {
            let message = format!(
                "`max` of `{}` must be above `min`, and both finite",
                params.node.plugin.value
            );
            params.error_at("max", message);
            return None;
        }
        Some(Self { low, high })
    }

    /// The entry and exit of a line, with the faces.
    pub(crate) fn cut(&self, line: &Line) -> Option<[(f64, u32); 2]> {
        let (mut first, mut last) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for axis in 0..3 {
            let (o, d) = (line.origin[axis], line.direction[axis]);
            let face = 1 + 2 * axis as u32;
            if d == 0.0 {
                if !(o >= self.low[axis] && o <= self.high[axis]) {
                    return None;
                }
                continue;
            }
            let mut planes = [
                ((self.low[axis] - o) / d, face),
                ((self.high[axis] - o) / d, face + 1),
            ];
            if d < 0.0 {
                planes.swap(0, 1);
            }
            if planes[0].0 > first.0 {
                first = planes[0];
            }
            if planes[1].0 < last.0 {
                last = planes[1];
            }
        }
        (first.0 < last.0).then_some([first, last])
    }

    /// The point of one of the box's faces that is at `p` up to rounding; `None` if the face is [`CURVED`].
    pub(crate) fn face(&self, face: u32, p: DVec3) -> Option<OwnPoint> {
        let side = face.checked_sub(1)?;
        let axis = side as usize / 2;
        let mut normal = DVec3::ZERO;
        let mut position = p;
        (normal[axis], position[axis]) = if side % 2 == 0 {
            (-1.0, self.low[axis])
        } else {
            (1.0, self.high[axis])
        };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let size = self.high - self.low;
        let part = (p - self.low) / size;
        Some(OwnPoint {
            position,
            normal,
            uv: DVec2::new(part[u], part[v]),
            dp_du: DVec3::AXES[u] * size[u],
            dp_dv: DVec3::AXES[v] * size[v],
        })
    }

    /// A point of the surface with a unit normal: u is the azimuth about the box's middle, v the height.
    pub(crate) fn curved(&self, position: DVec3, normal: DVec3) -> OwnPoint {
        let across = position - 0.5 * (self.low + self.high);
        let radius = across.truncate().length();
        let around = DVec3::new(-across.y, across.x, 0.0).try_normalize();
        let tangent = around.unwrap_or(DVec3::X);
        let tangent =
            (tangent - normal * normal.dot(tangent)).normalize_or(normal.any_orthonormal_vector());
        let height = (position.z - self.low.z) / (self.high.z - self.low.z);
        OwnPoint {
            position,
            normal,
            uv: DVec2::new(
                (atan2(across.y, across.x) / TAU).rem_euclid(1.0),
                height.clamp(0.0, 1.0),
            ),
            dp_du: tangent * (2.0 * PI * radius.max(1e-12)),
            dp_dv: normal.cross(tangent) * (self.high.z - self.low.z),
        }
    }
}
