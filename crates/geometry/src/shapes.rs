//! Every shape, and the one list through which a plugin's name finds its shape.
//!
//! To add a shape, write its file and add one line to the list.

pub(crate) mod analytic;
mod attributes;
pub mod bilinear;
pub mod bspline_curve;
pub mod cone;
pub mod csg;
pub mod cube;
mod curve;
pub mod curves;
pub mod cylinder;
pub mod disk;
pub mod ellipsoids;
pub mod extrusion;
pub mod implicit;
mod lane_shapes;
pub mod linear_curve;
pub mod mesh;
mod net;
pub mod plane;
mod profile;
pub mod quadric;
pub mod rectangle;
pub mod revolution;
pub mod sdf_grid;
mod shape_model;
pub mod sphere;
pub mod torus;

use crate::accelerator::Bounds;
use crate::local_interaction::LocalInteraction;
use analytic::crossing::{Crossing, Line};
use analytic::field::Field;
use analytic::placed::Placed;
use bilinear::Bilinear;
use bspline_curve::RoundSpline;
use cone::Cone;
use csg::Csg;
use curves::Curves;
use cylinder::Cylinder;
use disk::Disk;
use ellipsoids::{Ellipsoids, shells};
use etalon_math::DirectionCone;
use etalon_params::Params;
use etalon_transport::{Build, LightSampleContext, SampledPoint, SurfacePoint};
use extrusion::Extrusion;
use glam::{DVec2, DVec3, Vec2, Vec3};
use implicit::Implicit;
use linear_curve::RoundCone;
use mesh::{Mesh, file_mesh};
use plane::Plane;
use quadric::Quadric;
use rectangle::Rectangle;
use revolution::Revolution;
use sdf_grid::SdfGrid;
use shape_model::ShapeModel;
use sphere::Sphere;
use torus::Torus;

macro_rules! shapes {
    ($($(#[doc = $doc:literal])* $kind:ident($model:ty) { $($plugin:literal => $read:expr,)* })*) => {
        /// A shape in the world (or in the space of the group it belongs to).
        #[derive(Debug)]
        #[allow(clippy::large_enum_variant)] // Shapes are few; a box would be one more place to look.
        pub enum Shape {
            $($(#[doc = $doc])* $kind($model),)*
        }

        /// The names of the shape plugins.
        const NAMES: &[&str] = &[$($($plugin,)*)*];

        /// Reads the shape of this name; `None` if it is none of the list, or after a mistake.
        fn read(name: &str, params: &Params<'_>, build: &mut dyn Build) -> Option<Shape> {
            match name {
                $($($plugin => {
                    let read: fn(&Params<'_>, &mut dyn Build) -> Option<$model> = $read;
                    read(params, build).map(Shape::$kind)
                })*)*
                _ => None,
            }
        }

        /// Dispatches to the shape.
        macro_rules! ask {
            ($shape:expr, $it:ident => $answer:expr) => {
                match $shape {
                    $(Shape::$kind($it) => $answer,)*
                }
            };
        }
    };
}

// The list: a line for each plugin, under the type that it makes.
shapes! {
    /// Triangles.
    Mesh(Mesh) {
        "obj" => file_mesh::obj,
        "ply" => file_mesh::ply,
        "serialized" => file_mesh::serialized,
        "ellipsoidsmesh" => shells::mesh,
        "cube" => |params, _| cube::from_params(params),
        "bicubic" => |params, _| net::bicubic(params),
        "curve" => |params, _| curve::from_params(params),
        "heightfield" => net::heightfield,
    }
    /// A rectangle.
    Rectangle(Rectangle) { "rectangle" => |params, _| Rectangle::from_params(params), }
    /// A disk.
    Disk(Disk) { "disk" => |params, _| Disk::from_params(params), }
    /// A sphere.
    Sphere(Sphere) { "sphere" => |params, _| Sphere::from_params(params), }
    /// An open cylinder.
    Cylinder(Cylinder) { "cylinder" => |params, _| Cylinder::from_params(params), }
    /// A plane without end.
    Plane(Placed<Plane>) { "plane" => |params, _| Plane::from_params(params), }
    /// A patch of four corners.
    Bilinear(Placed<Bilinear>) { "bilinear" => |params, _| Bilinear::from_params(params), }
    /// A solid cone, also a truncated one.
    Cone(Placed<Cone>) { "cone" => |params, _| Cone::from_params(params), }
    /// A surface of second degree in a box.
    Quadric(Placed<Quadric>) {
        "quadric" => |params, _| Quadric::from_params(params),
        "ellipsoid" => |params, _| Quadric::ellipsoid(params),
    }
    /// A cloud of ellipsoids.
    Ellipsoids(Ellipsoids) { "ellipsoids" => Ellipsoids::from_params, }
    /// The zero set of a function, in a box.
    Implicit(Placed<Implicit>) {
        "implicit" => |params, _| Implicit::from_params(params),
        "superellipsoid" => |params, _| Implicit::of(params, Field::superellipsoid(params)),
        "blob" => |params, _| Implicit::of(params, Field::blob(params)),
        "julia" => |params, _| Implicit::of(params, Field::julia(params)),
    }
    /// A curve turned about an axis.
    Revolution(Placed<Revolution>) { "revolution" => |params, _| Revolution::from_params(params), }
    /// A curve moved along an axis.
    Extrusion(Placed<Extrusion>) { "extrusion" => |params, _| Extrusion::from_params(params), }
    /// Polylines of balls.
    LinearCurve(Curves<RoundCone>) { "linearcurve" => |params, build| Curves::from_params(params, build), "hair" => |params, build| Curves::hair(params, build), }
    /// Splines of circles.
    SplineCurve(Curves<RoundSpline>) {
        "bsplinecurve" => |params, build| Curves::from_params(params, build),
        "beziercurve" => RoundSpline::bezier_curves,
    }
    /// A function on a grid.
    SdfGrid(Placed<SdfGrid>) { "sdfgrid" => |params, build| SdfGrid::from_params(params, build), }
    /// A torus.
    Torus(Placed<Torus>) { "torus" => |params, _| Torus::from_params(params), }
    /// Solids made of solids; their operands are the scene's to read.
    Csg(Csg) { }
}

impl Shape {
    /// The names of the shape plugins.
    pub fn plugins() -> impl Iterator<Item = &'static str> {
        NAMES.iter().copied()
    }

    /// Makes a shape from its description. Only the shape's own parameters are read; nested
    /// materials, lights and media are the caller's, as is [`Params::finish`]. After a mistake,
    /// which has been recorded, or if the plugin is not a shape of the list, `None`.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        read(params.node.plugin.value.as_str(), params, build)
    }

    /// The triangles, if it is made of triangles.
    #[inline]
    pub(crate) fn mesh(&self) -> Option<&Mesh> {
        ask!(self, shape => shape.mesh())
    }

    /// The triangles that an accelerator intersects.
    #[inline]
    pub(crate) fn triangles(&self) -> Option<&Mesh> {
        self.mesh().filter(|mesh| !mesh.touches)
    }

    /// Says that it nearly touches another shape, so that single precision does not tell them apart.
    pub(crate) fn set_touching(&mut self) {
        if let Some(mesh) = ask!(self, shape => shape.mesh_mut()) {
            mesh.touches = true;
        }
    }

    /// Whether it intersects rays by a formula of its own: a smooth shape, or a mesh that nearly touches another
    /// shape.
    #[inline]
    pub(crate) fn is_analytic(&self) -> bool {
        self.triangles().is_none()
    }

    /// Number of primitives: triangles, or pieces.
    pub(crate) fn primitives(&self) -> u32 {
        match self.triangles() {
            Some(mesh) => mesh.triangle_count() as u32,
            None => ask!(self, shape => shape.pieces()),
        }
    }

    /// Number of pieces that are intersected by a formula, independent of the accelerator.
    pub(crate) fn primitives_analytic(&self) -> u32 {
        ask!(self, shape => shape.pieces())
    }

    /// Number of faces, each of which may have its own material.
    pub fn faces(&self) -> u32 {
        ask!(self, shape => shape.faces())
    }

    /// Whether it may be an operand of constructive solid geometry: it bounds a volume, and is no mesh but a small,
    /// convex one without holes.
    pub fn is_solid(&self) -> bool {
        match self.mesh() {
            Some(mesh) => mesh.is_small_and_convex() && mesh.has_no_border(),
            None => ask!(self, shape => shape.is_closed()),
        }
    }

    /// Whether rays that come from inside meet it.
    pub fn has_inner_side(&self) -> bool {
        ask!(self, shape => shape.has_inner_side())
    }

    /// Whether it has a border, so that it bounds no volume.
    pub fn is_open(&self) -> bool {
        match self.mesh() {
            Some(mesh) => !mesh.has_no_border(),
            None => !ask!(self, shape => shape.is_closed()),
        }
    }

    /// See [`ShapeModel::both_crossings`].
    #[inline]
    pub(crate) fn both_crossings(&self, line: &Line) -> Option<[f64; 2]> {
        ask!(self, shape => shape.both_crossings(line))
    }

    /// See [`ShapeModel::next_crossing`].
    #[inline]
    pub(crate) fn next_crossing(
        &self,
        piece: u32,
        line: &Line,
        after: f64,
        before: f64,
    ) -> Option<Crossing> {
        ask!(self, shape => shape.next_crossing(piece, line, after, before))
    }

    /// The crossing with a piece nearest to the parameter `t`, known to single precision; one at `t` if there is none.
    pub(crate) fn crossing_near(&self, piece: u32, line: &Line, t: f64) -> Crossing {
        if let Some(both) = self.both_crossings(line) {
            return Crossing::nearest_of_convex(both, t);
        }
        let scale = line.origin.abs().max_element() / line.direction.length() + t.abs();
        // Some roundings of single precision, and as much more as it takes: a grazing ray starts far from where
        // its line crosses the surface that it leaves.
        let reaches = [1e-5, 1e-3, 1e-1, f64::INFINITY].map(|reach| reach * scale);
        let found = reaches.into_iter().find_map(|reach| {
            let mut nearest: Option<Crossing> = None;
            let mut after = t - reach;
            while let Some(next) = self.next_crossing(piece, line, after, t + reach)
                && next.t <= t + reach
            {
                if nearest.is_some_and(|best| (best.t - t).abs() <= (next.t - t).abs()) {
                    break;
                }
                after = next.t;
                nearest = Some(next);
            }
            nearest
        });
        found.unwrap_or(Crossing::new(t, true))
    }

    /// The surface at a crossing with a piece, which is at `p` up to rounding.
    pub(crate) fn surface_at(
        &self,
        piece: u32,
        p: DVec3,
        crossing: &Crossing,
    ) -> Option<LocalInteraction> {
        ask!(self, shape => shape.surface_at(piece, p, crossing))
    }

    /// See [`ShapeModel::parametric`].
    pub(crate) fn parametric(&self, uv: DVec2) -> Option<LocalInteraction> {
        ask!(self, shape => shape.parametric(uv))
    }

    /// Whether it can be moved by a texture, see [`Shape::displaced`].
    pub fn can_be_displaced(&self) -> bool {
        self.mesh().is_some() || self.parametric(DVec2::splat(0.5)).is_some()
    }

    /// See [`ShapeModel::is_convex`]; a mesh is examined itself.
    pub(crate) fn is_convex(&self) -> bool {
        match self.mesh() {
            Some(mesh) => mesh.is_small_and_convex(),
            None => ask!(self, shape => shape.is_convex()),
        }
    }

    /// See [`ShapeModel::triangle`].
    #[inline]
    pub(crate) fn triangle(
        &self,
        primitive: u32,
        b: Vec2,
        corners: impl FnOnce() -> [Vec3; 3],
    ) -> Option<LocalInteraction> {
        ask!(self, shape => shape.triangle(primitive, b, corners))
    }

    /// What `take` makes of the surface of a triangle, which the shape has. Taken where it is made: what any shape returns
    /// is copied on the way.
    #[inline(always)]
    pub(crate) fn at_triangle<R>(
        &self,
        primitive: u32,
        b: Vec2,
        corners: impl FnOnce() -> [Vec3; 3],
        take: impl FnOnce(LocalInteraction) -> R,
    ) -> R {
        ask!(self, shape => take(shape.triangle(primitive, b, corners).expect("it has triangles")))
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        match self.mesh() {
            Some(mesh) => mesh.bounds(),
            None => (0..self.primitives())
                .map(|piece| self.piece_bounds(piece))
                .fold(Bounds::EMPTY, Bounds::union),
        }
    }

    /// The smallest box around a piece.
    pub(crate) fn piece_bounds(&self, piece: u32) -> Bounds {
        let [min, max] = ask!(self, shape => shape.piece_bounds(piece));
        // A box of rounded corners must still hold the shape.
        let slack = 1e-6 * min.abs().max(max.abs());
        Bounds {
            min: (min - slack).as_vec3(),
            max: (max + slack).as_vec3(),
        }
    }

    /// A cone that holds its normals, outside.
    pub(crate) fn normals(&self) -> DirectionCone {
        ask!(self, shape => shape.normals())
    }

    /// Builds the tables for sampling now instead of at first use.
    pub(crate) fn prepare_sampling(&self) {
        ask!(self, shape => shape.prepare_sampling());
    }

    /// Surface area (m²); 0 where points cannot be sampled.
    pub fn area(&self) -> f64 {
        ask!(self, shape => ShapeModel::area(shape)).unwrap_or(0.0)
    }

    /// Whether it may be a light: whether points of it can be sampled.
    pub fn can_emit(&self) -> bool {
        ask!(self, shape => ShapeModel::can_emit(shape))
    }

    /// A point chosen uniformly by area, with its density per unit area. A mesh without area
    /// gives the origin, with density 0. Whose point it is, the caller knows.
    pub(crate) fn sample_area(&self, u: Vec2) -> SampledPoint {
        match ask!(self, shape => ShapeModel::sample_area(shape, u)) {
            Some(point) => SampledPoint {
                point,
                density: (1.0 / self.area()) as f32,
            },
            None => SampledPoint {
                point: LocalInteraction::exact(
                    DVec3::ZERO,
                    DVec3::Z,
                    Vec2::ZERO,
                    DVec3::X,
                    DVec3::Y,
                )
                .point(0, Vec2::ZERO),
                density: 0.0,
            },
        }
    }

    /// A point chosen for a receiver, with its density per unit solid angle there. `None` if the
    /// chosen point is seen edge-on or the shape has no area.
    #[inline(always)] // Large, and asked at every vertex.
    pub(crate) fn sample_toward(&self, from: &LightSampleContext, u: Vec2) -> Option<SampledPoint> {
        let mut sampled = ask!(self, shape => ShapeModel::sample_toward(shape, from, u));
        // In place: it is not copied.
        if !sampled.is_some_and(|at| at.density > 0.0 && at.density < f32::INFINITY) {
            sampled = None;
        }
        sampled
    }

    /// The density per unit solid angle with which [`Shape::sample_toward`] from `from` chooses
    /// `at`, a point of this shape.
    pub(crate) fn density_toward(&self, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        let density = ask!(self, shape => ShapeModel::density_toward(shape, from, at));
        if density.is_finite() { density } else { 0.0 }
    }
}
