//! The rectangle [−1, 1]² × {0}, normal +z, as two triangles that meet at u + v = 1.
//!
//! ```text
//! p(u, v) = p₀₀ + 2u x + 2v y
//! ```
//!
//! As a light, seen from afar, its points are chosen nearly in proportion to the light that
//! they send ([`RectangleView`], Hart et al. 2020). A receiver so near that the light varies more
//! over it than that follows sees it by solid angle (Ureña, Fajardo & King 2013), unless
//! `to_world` shears it into a parallelogram.

use crate::local_interaction::LocalInteraction;
use crate::placement::{Placement, perpendicular};
use crate::shapes::mesh::{Mesh, MeshOptions};
use crate::shapes::shape_model::{ShapeModel, area_density_toward, read_face_normals, read_flip};
use etalon_math::lane::{Lane, Mask, Select, Vector, per_lane};
use etalon_math::{DirectionCone, Frame, gamma};
use etalon_params::Params;
use etalon_sampling::warps::{RectangleSides, RectangleView, SphericalRectangle};
use etalon_transport::{
    LanePoint, LaneReceiver, LightSampleContext, MeshData, SampledPoint, ShapeId, SurfacePoint,
    TexturePoint,
};
use glam::{BVec2, DVec3, Vec2, Vec3};

/// A rectangle or parallelogram.
#[derive(Debug)]
pub struct Rectangle {
    mesh: Mesh,
    corner: Vec3,
    edges: [Vec3; 2],
    /// Bound on the absolute error of each coordinate of a point.
    error: Vec3,
    /// Unit normal, outside.
    normal: Vec3,
    shading: Frame,
    sides: RectangleSides,
    area: f64,
    right_angled: bool,
}

impl Rectangle {
    /// The image of the square under `placement`; its normal is the image of +z.
    pub fn new(placement: &Placement, flip: bool) -> Result<Self, String> {
        let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE];
        let data = MeshData {
            positions: uvs.iter().map(|uv| (*uv * 2.0 - 1.0).extend(0.0)).collect(),
            uvs,
            triangles: vec![[0, 1, 2], [3, 2, 1]],
            ..MeshData::default()
        };
        let options = MeshOptions {
            placement: *placement,
            face_normals: true,
            ..MeshOptions::default()
        };
        let mesh = Mesh::new(data, &options)?.outside(flip != placement.mirrors());
        let [corner, ..] = mesh.corners(0);
        // Not between corners, whose rounding far away from the origin may be as large as a small
        // rectangle.
        let [a, b] = [DVec3::X, DVec3::Y].map(|axis| placement.vector(axis) * 2.0);
        let edges = [a, b].map(|edge| edge.as_vec3());
        let upward = a.cross(b).normalize().as_vec3();
        let normal = if flip != placement.mirrors() {
            -upward
        } else {
            upward
        };
        let reach = corner.abs() + edges[0].abs() + edges[1].abs();
        Ok(Self {
            normal,
            shading: Frame::from_normal_and_tangent(normal, edges[0]),
            // As for a triangle's point, see `Mesh::surface`.
            error: reach * gamma(9) + f32::MIN_POSITIVE,
            mesh,
            corner,
            edges,
            sides: RectangleSides::new(edges),
            area: a.cross(b).length(),
            right_angled: perpendicular(a, b, false),
        })
    }

    /// Reads `face_normals`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let placement = Placement::from_params(params);
        let flip = read_flip(params);
        read_face_normals(params);
        Self::new(&placement?, flip)
            .map_err(|message| params.error_at("to_world", message))
            .ok()
    }

    /// The surface point with barycentric coordinates `b` of a triangle's second and third
    /// corner. Nearly all of it is the same everywhere.
    #[inline]
    pub(crate) fn surface(&self, primitive: u32, b: Vec2) -> LocalInteraction {
        let uv = if primitive == 0 { b } else { 1.0 - b };
        LocalInteraction {
            position: self.corner + self.edges[0] * uv.x + self.edges[1] * uv.y,
            error: self.error,
            depth: f32::NAN,
            normal: self.normal,
            shading: self.shading,
            uv,
            dp_du: self.edges[0],
            dp_dv: self.edges[1],
            face: 0,
        }
    }

    /// The point with texture coordinates `uv`.
    #[inline]
    pub(crate) fn at(&self, uv: Vec2) -> SurfacePoint {
        // The branch would be unpredictable.
        let first = BVec2::splat(uv.x + uv.y <= 1.0);
        let position = self.corner + self.edges[0] * uv.x + self.edges[1] * uv.y;
        SurfacePoint {
            position,
            error: self.error,
            normal: self.normal,
            texture: TexturePoint {
                position,
                uv,
                shape: ShapeId::NONE,
                primitive: u32::from(!first.x),
                parameters: Vec2::select(first, uv, 1.0 - uv),
            },
        }
    }

    /// How a receiver sees it that is so near that light varies over it in ways that no simple density follows; `None` for
    /// others.
    #[inline]
    fn seen_nearby(&self, from: Vec3) -> Option<SphericalRectangle> {
        let corner = self.corner - from;
        (self.right_angled && self.sides.is_near(corner))
            .then(|| SphericalRectangle::seen(corner, &self.sides))
            .flatten()
    }

    /// How a receiver with a normal, or zero for none, sees it from afar.
    #[inline]
    fn seen_from_afar(&self, from: Vec3, normal: Vec3) -> RectangleView<f32> {
        RectangleView::new(self.corner - from, self.edges, normal)
    }

    /// The density (sr⁻¹) of a point chosen with the density `density` on the unit square.
    #[inline]
    fn per_solid_angle(&self, density: f32, from: Vec3, position: Vec3) -> f32 {
        density * area_density_toward::<f32>(self.area as f32, from, position, self.normal)
    }

    /// Points of `rectangle(i)` in lane i, chosen for a receiver with a normal, or zero for none.
    #[inline(always)]
    pub(super) fn points_toward<'s, F: Lane>(
        rectangle: impl Fn(usize) -> &'s Self,
        from: &LaneReceiver<F>,
        u: [F; 2],
    ) -> LanePoint<F> {
        let Seen {
            corner,
            edges,
            normal,
            error,
            area,
            diagonal_squared,
            right_angled,
        } = Seen::of_lanes(&rectangle);
        let outward = corner - from.position;
        let view = RectangleView::new(outward, edges, from.normal);
        let uv = view.sample(u);
        let mut position = corner + edges[0] * uv[0] + edges[1] * uv[1];
        let per_area = area_density_toward::<F>(area, from.position, position, normal);
        let mut density = view.density(uv) * per_area;
        let near = right_angled & RectangleSides::are_near::<F>(outward, edges, diagonal_squared);
        if near.any() {
            // Few are near, and what they need takes double precision.
            let nearby = per_lane::<F, _>(|i| {
                let seen = || rectangle(i).seen_nearby(from.position.at_lane(i));
                let seen = near.lane(i).then(seen)??;
                let uv = seen.sample_position(Vec2::new(u[0].lane(i), u[1].lane(i)));
                Some((rectangle(i).at(uv).position, seen.density()))
            });
            let seen = F::Mask::from_fn(|i| nearby[i].is_some());
            let of = |i: usize| nearby[i].unwrap_or_default();
            position = F::Vector::choose(seen, F::Vector::of_lanes(|i| of(i).0), position);
            density = seen.select(F::from_fn(|i| of(i).1), density);
        }
        LanePoint {
            position,
            error,
            normal,
            density,
        }
    }
}

/// What receivers see of rectangles, one in each lane.
struct Seen<F: Lane> {
    corner: F::Vector,
    edges: [F::Vector; 2],
    normal: F::Vector,
    error: F::Vector,
    area: F,
    diagonal_squared: F,
    right_angled: F::Mask,
}

impl<F: Lane> Seen<F> {
    /// That of `rectangle(i)` in lane i.
    #[inline(always)]
    fn of_lanes<'s>(rectangle: impl Fn(usize) -> &'s Rectangle) -> Self {
        let first = rectangle(0);
        if (1..F::WIDTH).all(|i| core::ptr::eq(first, rectangle(i))) {
            return Self {
                corner: F::Vector::broadcast(first.corner),
                edges: first.edges.map(F::Vector::broadcast),
                normal: F::Vector::broadcast(first.normal),
                error: F::Vector::broadcast(first.error),
                area: F::splat(first.area as f32),
                diagonal_squared: F::splat(first.sides.diagonal_squared()),
                right_angled: F::Mask::splat(first.right_angled),
            };
        }
        let edges = F::Vector::pairs_of_lanes(|i| rectangle(i).edges);
        let [normal, error] =
            F::Vector::pairs_of_lanes(|i| [rectangle(i).normal, rectangle(i).error]);
        let [x, y, z, area, diagonal_squared, ..] = F::columns(|i| {
            let rectangle = rectangle(i);
            let [x, y, z] = rectangle.corner.to_array();
            let diagonal_squared = rectangle.sides.diagonal_squared();
            [
                x,
                y,
                z,
                rectangle.area as f32,
                diagonal_squared,
                0.0,
                0.0,
                0.0,
            ]
        });
        Self {
            corner: F::Vector::from_xyz(x, y, z),
            edges,
            normal,
            error,
            area,
            diagonal_squared,
            right_angled: F::Mask::from_fn(|i| rectangle(i).right_angled),
        }
    }
}

impl ShapeModel for Rectangle {
    #[inline]
    fn mesh(&self) -> Option<&Mesh> {
        Some(&self.mesh)
    }

    fn mesh_mut(&mut self) -> Option<&mut Mesh> {
        Some(&mut self.mesh)
    }

    #[inline]
    fn triangle(
        &self,
        primitive: u32,
        b: Vec2,
        _: impl FnOnce() -> [Vec3; 3],
    ) -> Option<LocalInteraction> {
        Some(self.surface(primitive, b))
    }

    fn normals(&self) -> DirectionCone {
        DirectionCone::along(self.normal.as_dvec3())
    }

    fn area(&self) -> Option<f64> {
        Some(self.area)
    }

    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint> {
        Some(self.at(u))
    }

    #[inline]
    fn sample_toward(&self, from: &LightSampleContext, u: Vec2) -> Option<SampledPoint> {
        if let Some(seen) = self.seen_nearby(from.position) {
            return Some(SampledPoint {
                point: self.at(seen.sample_position(u)),
                density: seen.density(),
            });
        }
        let view = self.seen_from_afar(from.position, from.normal);
        let uv = view.sample(u.to_array());
        let point = self.at(uv.into());
        Some(SampledPoint {
            density: self.per_solid_angle(view.density(uv), from.position, point.position),
            point,
        })
    }

    fn density_toward(&self, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        if let Some(seen) = self.seen_nearby(from.position) {
            return seen.density();
        }
        let view = self.seen_from_afar(from.position, from.normal);
        let density = view.density(at.texture.uv.to_array());
        self.per_solid_angle(density, from.position, at.position)
    }
}
