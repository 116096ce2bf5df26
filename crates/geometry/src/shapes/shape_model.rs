//! The methods of a shape, with defaults that most of them share.

use crate::local_interaction::LocalInteraction;
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::mesh::Mesh;
use etalon_math::DirectionCone;
use etalon_math::lane::{Lane, Vector};
use etalon_params::Params;
use etalon_transport::{LightSampleContext, SampledPoint, SurfacePoint};
use glam::{DVec2, DVec3, Vec2, Vec3};

/// A shape: triangles ([`ShapeModel::mesh`]), or pieces that are intersected by a formula of their own
/// ([`ShapeModel::next_crossing`]).
pub(crate) trait ShapeModel {
    /// Its triangles, if it is made of triangles.
    #[inline]
    fn mesh(&self) -> Option<&Mesh> {
        None
    }

    /// The same, to be changed.
    fn mesh_mut(&mut self) -> Option<&mut Mesh> {
        None
    }

    /// Number of pieces with a bounding box each, if they are intersected by a formula.
    fn pieces(&self) -> u32 {
        1
    }

    /// The smallest axis-parallel box that holds a piece (m).
    fn piece_bounds(&self, _piece: u32) -> [DVec3; 2] {
        self.mesh()
            .map_or([DVec3::INFINITY, DVec3::NEG_INFINITY], Mesh::exact_bounds)
    }

    /// The parameters of both crossings of a line with a shape that has no more, in ascending order, NaN where there is none; `None`
    /// of other shapes. By default those of a small mesh that nearly touches another shape.
    #[inline]
    fn both_crossings(&self, line: &Line) -> Option<[f64; 2]> {
        self.mesh().map(|mesh| mesh.crossings(line))
    }

    /// The first crossing of a line with a piece beyond the parameter `after`. One at or beyond `before` need not be
    /// found.
    #[inline]
    fn next_crossing(
        &self,
        _piece: u32,
        line: &Line,
        after: f64,
        _before: f64,
    ) -> Option<Crossing> {
        Crossing::of_convex(self.both_crossings(line)?, after)
    }

    /// The surface at a crossing with a piece, which is at `p` up to rounding: `p` is projected first.
    fn surface_at(&self, _piece: u32, p: DVec3, _crossing: &Crossing) -> Option<LocalInteraction> {
        self.mesh().map(|mesh| mesh.surface_near(p))
    }

    /// The point with the texture coordinates `uv`, if it knows its points by them.
    fn parametric(&self, _uv: DVec2) -> Option<LocalInteraction> {
        None
    }

    /// Whether rays that come from inside meet it.
    fn has_inner_side(&self) -> bool {
        true
    }

    /// Whether it bounds a volume, so that a line leaves it as often as it enters it.
    fn is_closed(&self) -> bool {
        false
    }

    /// Number of faces, see [`Crossing::face`].
    fn faces(&self) -> u32 {
        1
    }

    /// Whether a line crosses it twice at most.
    fn is_convex(&self) -> bool {
        true
    }

    /// The surface at a point of a triangle, `b` being the barycentric coordinates of its second and
    /// third corner; `corners` gives its corners. `None` if it has no triangles.
    #[inline]
    fn triangle(
        &self,
        primitive: u32,
        b: Vec2,
        corners: impl FnOnce() -> [Vec3; 3],
    ) -> Option<LocalInteraction> {
        Some(self.mesh()?.surface_between(corners(), primitive, b))
    }

    /// A cone that holds its normals, outside.
    fn normals(&self) -> DirectionCone {
        DirectionCone::ALL
    }

    /// Builds the tables for sampling now instead of at first use.
    fn prepare_sampling(&self) {}

    /// Whether it may be a light: whether points of it can be sampled.
    fn can_emit(&self) -> bool {
        self.area().is_some()
    }

    /// Surface area (m²); `None` if points of it cannot be sampled, so that it cannot be a light.
    fn area(&self) -> Option<f64>;

    /// A point chosen uniformly by area; `None` if there is no area.
    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint>;

    /// A point chosen for a receiver, with its density per unit solid angle there, which is not finite
    /// or 0 where it is seen edge-on.
    #[inline]
    fn sample_toward(&self, from: &LightSampleContext, u: Vec2) -> Option<SampledPoint> {
        let point = self.sample_area(u)?;
        let density = self.area_density_toward(from.position, &point);
        Some(SampledPoint { point, density })
    }

    /// The density of [`ShapeModel::sample_toward`] at a point of this shape.
    #[inline]
    fn density_toward(&self, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        self.area_density_toward(from.position, at)
    }

    /// The density per unit solid angle, seen from a point, of points chosen uniformly by area.
    #[inline]
    fn area_density_toward(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        let area = self.area().unwrap_or(f64::INFINITY);
        area_density_toward::<f32>(area as f32, from, at.position, at.normal)
    }
}

/// Uniform density by area as seen from a point: r² / (A |cos θ|), infinite edge-on.
#[inline(always)]
pub(crate) fn area_density_toward<F: Lane>(
    area: F,
    from: F::Vector,
    position: F::Vector,
    normal: F::Vector,
) -> F {
    let to = position - from;
    let distance_squared = to.dot_product(to);
    let cos_times_distance = normal.dot_product(to).abs();
    distance_squared * distance_squared.sqrt() / (cos_times_distance * area)
}

/// Reads `flip_normals`.
pub(crate) fn read_flip(params: &Params<'_>) -> bool {
    params.boolean_or("flip_normals", false)
}

/// Reads `face_normals` for a shape whose faces are flat anyway: it makes no difference there.
pub(crate) fn read_face_normals(params: &Params<'_>) {
    params.boolean_or("face_normals", false);
}
