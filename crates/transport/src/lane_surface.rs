//! Surfaces that rays hit, in lanes.

use crate::{Leaving, SurfaceInteraction, TexturePoint};
use core::fmt;
use etalon_math::Frame;
use etalon_math::lane::{Lane, LaneFrame, MOST_LANES, Vector};
use etalon_spectrum::Wavelengths;
use glam::Vec3;

/// Points of surfaces, as [`SurfaceInteraction`] describes them, as far as paths ask for them that are scattered together.
#[derive(Clone, Copy, Debug)]
pub struct LaneSurface<F: Lane> {
    /// The points and their geometric normals.
    pub leaving: Leaving<F>,
    /// Shading frames.
    pub shading: LaneFrame<F>,
    /// The primitives within their shapes.
    pub primitives: [u32; MOST_LANES],
}

/// One of these points.
#[derive(Clone, Copy, Debug)]
pub struct ShadedPoint {
    /// Position (m, world).
    pub position: Vec3,
    /// Bound on the absolute error of each coordinate of `position`.
    pub error: Vec3,
    /// Offset of the surface from `position` along `normal` (m); NaN if it is not known.
    pub depth: f32,
    /// Unit geometric normal, outside.
    pub normal: Vec3,
    /// Shading frame.
    pub shading: Frame,
    /// The primitive within its shape.
    pub primitive: u32,
}

impl From<&SurfaceInteraction> for ShadedPoint {
    #[inline]
    fn from(vertex: &SurfaceInteraction) -> Self {
        Self {
            position: vertex.position,
            error: vertex.error,
            depth: vertex.depth,
            normal: vertex.normal,
            shading: vertex.shading,
            primitive: vertex.primitive,
        }
    }
}

impl<F: Lane> LaneSurface<F> {
    /// `point(i)` in lane i.
    #[inline(always)]
    pub fn of_lanes(point: impl Fn(usize) -> ShadedPoint) -> Self {
        // Rows of eight numbers that are written where they stay.
        let mut rows = [[[0.0; 8]; MOST_LANES]; 3];
        let mut primitives = [0; MOST_LANES];
        for i in 0..F::WIDTH {
            let ShadedPoint {
                position: p,
                error: e,
                depth,
                normal,
                shading: Frame { s, t, n },
                primitive,
            } = point(i);
            rows[0][i] = [p.x, p.y, p.z, e.x, e.y, e.z, n.x, n.y];
            rows[1][i] = [s.x, s.y, s.z, t.x, t.y, t.z, n.z, depth];
            rows[2][i] = [normal.x, normal.y, normal.z, 0.0, 0.0, 0.0, 0.0, 0.0];
            primitives[i] = primitive;
        }
        let [px, py, pz, ex, ey, ez, nx, ny] = F::columns(|i| rows[0][i]);
        let [sx, sy, sz, tx, ty, tz, nz, depth] = F::columns(|i| rows[1][i]);
        let [x, y, z, ..] = F::columns(|i| rows[2][i]);
        Self {
            leaving: Leaving {
                position: F::Vector::from_xyz(px, py, pz),
                error: F::Vector::from_xyz(ex, ey, ez),
                depth,
                normal: F::Vector::from_xyz(x, y, z),
            },
            shading: LaneFrame {
                s: F::Vector::from_xyz(sx, sy, sz),
                t: F::Vector::from_xyz(tx, ty, tz),
                n: F::Vector::from_xyz(nx, ny, nz),
            },
            primitives,
        }
    }
}

/// Vertices of one kind of several paths.
#[derive(Clone, Copy)]
pub struct LaneVertices<'a, F: Lane> {
    /// The surfaces.
    pub surface: &'a LaneSurface<F>,
    /// The point in any lane, for textures.
    pub texture_point: &'a dyn Fn(usize) -> TexturePoint,
    /// The wavelengths of the paths, one for each lane.
    pub wavelengths: &'a [Wavelengths],
}

impl<F: Lane> fmt::Debug for LaneVertices<'_, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LaneVertices")
            .field("surface", self.surface)
            .field("wavelengths", &self.wavelengths)
            .finish_non_exhaustive()
    }
}
