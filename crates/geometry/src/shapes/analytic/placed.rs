//! Shapes that are described in a space of their own, and placed in the world by any invertible affine map.
//!
//! Lines are taken into the shape's space and surface points out of it in double precision; normals by the inverse
//! transpose.

use crate::local_interaction::LocalInteraction;
use crate::placement::{Placement, perpendicular};
use crate::shapes::analytic::chart::Chart;
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::shape_model::ShapeModel;
use etalon_math::Frame;
use etalon_params::Params;
use etalon_transport::SurfacePoint;
use glam::{DVec2, DVec3, Vec2};
use std::sync::OnceLock;

/// A point of a surface in the shape's own space.
#[derive(Clone, Copy, Debug)]
pub struct OwnPoint {
    /// Position.
    pub position: DVec3,
    /// A normal of any length, outside.
    pub normal: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
    /// ∂p/∂u.
    pub dp_du: DVec3,
    /// ∂p/∂v.
    pub dp_dv: DVec3,
}

/// A shape in a space of its own.
pub trait OwnShape {
    /// See [`ShapeModel::next_crossing`].
    fn next_crossing(&self, line: &Line, after: f64, before: f64) -> Option<Crossing>;

    /// The surface at a crossing, which is at `p` up to rounding: `p` is projected first.
    fn surface_at(&self, p: DVec3, crossing: &Crossing) -> OwnPoint;

    /// The normal that shading pretends, of any length, at a point of the surface; `None` for the surface's own.
    fn shading_normal(&self, _p: DVec3) -> Option<DVec3> {
        None
    }

    /// See [`ShapeModel::parametric`].
    fn parametric(&self, _uv: DVec2) -> Option<OwnPoint> {
        None
    }

    /// A box that holds it.
    fn bounds(&self) -> [DVec3; 2];

    /// See [`ShapeModel::is_closed`].
    fn is_closed(&self) -> bool {
        true
    }

    /// See [`ShapeModel::faces`].
    fn faces(&self) -> u32 {
        1
    }

    /// See [`ShapeModel::is_convex`].
    fn is_convex(&self) -> bool {
        false
    }

    /// Number of smooth charts that cover the surface once; 0 if it has none.
    fn charts(&self) -> usize {
        0
    }

    /// A point of a chart, (u, v) in [0, 1)², and ∂p/∂u and ∂p/∂v of that chart.
    fn charted(&self, _chart: usize, _uv: DVec2) -> Option<(OwnPoint, [DVec3; 2])> {
        None
    }

    /// Surface area; `None` if points of it cannot be sampled.
    fn area(&self) -> Option<f64> {
        None
    }

    /// A point chosen uniformly by area.
    fn sample_area(&self, _u: Vec2) -> Option<OwnPoint> {
        None
    }
}

/// A shape where it stands.
#[derive(Clone, Debug)]
pub struct Placed<S> {
    placement: Placement,
    shape: S,
    inward: bool,
    /// The uniform scale of the map, if it has one.
    scale: Option<f64>,
    /// Error of a crossing in double precision (m), where a coordinate is near 0.
    rounding: f32,
    /// Charts for sampling in world space if the shape's own sampling does not apply; built at first use.
    charts: OnceLock<Box<[Chart]>>,
}

impl<S: OwnShape> Placed<S> {
    /// The image of a shape under `placement`, its normals turned with `flip`.
    pub(crate) fn new(placement: Placement, shape: S, flip: bool) -> Self {
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| placement.vector(axis));
        let similar =
            perpendicular(x, y, true) && perpendicular(y, z, true) && perpendicular(z, x, true);
        let scale = (x.length() + y.length() + z.length()) / 3.0;
        let [low, high] = placement.bounds(shape.bounds());
        let extent = low.abs().max(high.abs()).max_element();
        // A plane's error is relative to the coordinates alone.
        let extent = if extent.is_finite() { extent } else { 0.0 };
        Self {
            placement,
            shape,
            inward: flip,
            scale: similar.then_some(scale),
            // Eight roundings.
            rounding: (8.0 * f64::EPSILON * extent) as f32,
            charts: OnceLock::new(),
        }
    }

    /// Reads `to_world` and `flip_normals` of a shape that is read already.
    pub(crate) fn from_params(params: &Params<'_>, shape: Option<S>) -> Option<Self> {
        let placement = Placement::from_params(params);
        let flip = crate::shapes::shape_model::read_flip(params);
        Some(Self::new(placement?, shape?, flip))
    }

    /// The area in the world by the shape's own formula, where the map keeps angles.
    fn own_area(&self) -> Option<f64> {
        let scale = self.scale?;
        Some(self.shape.area()? * scale * scale)
    }

    /// The area element of a chart in the world.
    fn element(&self, chart: usize, uv: DVec2) -> f64 {
        let charted = self.shape.charted(chart, uv);
        charted.map_or(0.0, |(_, tangents)| {
            let [along_u, along_v] = tangents.map(|tangent| self.placement.vector(tangent));
            along_u.cross(along_v).length()
        })
    }

    fn charts(&self) -> &[Chart] {
        self.charts.get_or_init(|| {
            let chart = |index| Chart::new(|uv| self.element(index, uv));
            (0..self.shape.charts()).map(chart).collect()
        })
    }

    /// A point chosen uniformly by area over all charts.
    fn sample_charts(&self, u: Vec2) -> Option<OwnPoint> {
        let charts = self.charts();
        let total: f64 = charts.iter().map(Chart::area).sum();
        let mut rest = f64::from(u.x) * total;
        for (index, chart) in charts.iter().enumerate() {
            if rest < chart.area() || index + 1 == charts.len() {
                let x = (rest / chart.area()).min(1.0);
                let uv = chart.sample(DVec2::new(x, u.y.into()));
                return Some(self.shape.charted(index, uv)?.0);
            }
            rest -= chart.area();
        }
        None
    }

    fn surface(&self, own: &OwnPoint) -> LocalInteraction {
        let placement = &self.placement;
        let mut surface = LocalInteraction::exact(
            placement.point(own.position),
            placement.normal(own.normal).normalize(),
            own.uv.as_vec2(),
            placement.vector(own.dp_du),
            placement.vector(own.dp_dv),
        );
        surface.error += self.rounding;
        if let Some(shading) = self.shape.shading_normal(own.position) {
            let shading = placement.normal(shading).normalize().as_vec3();
            if shading.is_finite() {
                surface.shading = Frame::from_normal_and_tangent(shading, surface.dp_du);
            }
        }
        surface.flipped_if(self.inward)
    }
}

impl<S: OwnShape> ShapeModel for Placed<S> {
    #[inline]
    fn next_crossing(&self, _: u32, line: &Line, after: f64, before: f64) -> Option<Crossing> {
        let own = Line {
            origin: self.placement.local_point(line.origin),
            direction: self.placement.local_vector(line.direction),
        };
        self.shape.next_crossing(&own, after, before)
    }

    fn surface_at(&self, _: u32, p: DVec3, crossing: &Crossing) -> Option<LocalInteraction> {
        let own = self.placement.local_point(p);
        Some(self.surface(&self.shape.surface_at(own, crossing)))
    }

    fn parametric(&self, uv: DVec2) -> Option<LocalInteraction> {
        Some(self.surface(&self.shape.parametric(uv)?))
    }

    fn piece_bounds(&self, _: u32) -> [DVec3; 2] {
        self.placement.bounds(self.shape.bounds())
    }

    fn is_closed(&self) -> bool {
        self.shape.is_closed()
    }

    fn faces(&self) -> u32 {
        self.shape.faces()
    }

    fn is_convex(&self) -> bool {
        self.shape.is_convex()
    }

    fn can_emit(&self) -> bool {
        self.own_area().is_some() || self.shape.charts() > 0
    }

    fn prepare_sampling(&self) {
        self.area();
    }

    fn area(&self) -> Option<f64> {
        let charts = || self.charts().iter().map(Chart::area).sum();
        (self.own_area()).or_else(|| (self.shape.charts() > 0).then(charts))
    }

    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint> {
        let point = match self.own_area() {
            Some(_) => self.shape.sample_area(u),
            None => self.sample_charts(u),
        };
        Some(self.surface(&point?).whole())
    }
}
