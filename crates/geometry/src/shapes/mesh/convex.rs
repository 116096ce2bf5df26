//! Small convex meshes (boxes, panes) in double precision, for media that touch.
//!
//! The surfaces of two dielectrics may be closer than the accelerator's single precision resolves: water
//! in a box of glass, cemented panes. Such meshes are intersected triangle by triangle with
//! the same watertight test (Woop, Benthin & Wald 2013), in double precision. A line crosses a
//! convex mesh twice at most.

use crate::local_interaction::LocalInteraction;
use crate::shapes::analytic::crossing::Line;
use crate::shapes::mesh::Mesh;
use glam::{DVec3, Vec2, Vec3};

/// The most triangles for which this is worth while.
const MOST: usize = 64;

/// The intersection of a line with a triangle.
fn meet(corners: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let [a, b, c] = corners.map(|p| p - origin);
    // A neighbour has exactly the opposite number at a common edge.
    let edges = [c.cross(b), a.cross(c), b.cross(a)].map(|edge| direction.dot(edge));
    let outside = edges.iter().any(|&e| e < 0.0) && edges.iter().any(|&e| e > 0.0);
    let normal = (b - a).cross(c - a);
    let t = a.dot(normal) / direction.dot(normal);
    (!outside && t.is_finite()).then_some(t)
}

impl Mesh {
    /// Whether a line crosses it twice at most, and it is small.
    pub(crate) fn is_small_and_convex(&self) -> bool {
        let count = self.triangle_count();
        let triangles = || (0..count as u32).map(|i| self.exact_corners(i));
        let extent = f64::from(self.bounds().extent());
        let convex = |[a, b, c]: [DVec3; 3]| {
            let Some(normal) = (b - a).cross(c - a).try_normalize() else {
                return true;
            };
            let (mut low, mut high) = (0.0_f64, 0.0_f64);
            for corner in triangles().flatten() {
                let height = normal.dot(corner - a);
                (low, high) = (low.min(height), high.max(height));
            }
            low.abs().min(high) <= 1e-6 * extent
        };
        (1..=MOST).contains(&count) && triangles().all(convex)
    }

    /// Whether every edge of a triangle is another's the other way round, wherever its vertices are kept.
    pub(crate) fn has_no_border(&self) -> bool {
        let key = |p: Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
        let mut edges: Vec<_> = (0..self.triangle_count() as u32)
            .flat_map(|i| {
                let [a, b, c] = self.corners(i).map(key);
                [(a, b), (b, c), (c, a)]
            })
            .collect();
        edges.sort_unstable();
        let turned = |(a, b): ([u32; 3], [u32; 3])| edges.binary_search(&(b, a)).is_ok();
        edges.iter().all(|edge| turned(*edge))
    }

    fn exact_corners(&self, primitive: u32) -> [DVec3; 3] {
        self.corners(primitive).map(|p| p.as_dvec3())
    }

    /// The triangle that `p` lies on, up to rounding, and where.
    pub(crate) fn place_near(&self, p: DVec3) -> (u32, Vec2) {
        let mut best = (f64::INFINITY, 0, Vec2::ZERO);
        for primitive in 0..self.triangle_count() as u32 {
            let [a, b, c] = self.exact_corners(primitive);
            let (e1, e2, to) = (b - a, c - a, p - a);
            let normal = e1.cross(e2);
            let area = normal.length_squared();
            let b1 = to.cross(e2).dot(normal) / area;
            let b2 = e1.cross(to).dot(normal) / area;
            let outside = (-b1).max(-b2).max(b1 + b2 - 1.0).max(0.0);
            let off = normal.dot(to).abs() / area.sqrt() + outside * area.sqrt().sqrt();
            if off < best.0 {
                let inside = DVec3::new(b1, b2, 0.0).max(DVec3::ZERO);
                let sum = (inside.x + inside.y).max(1.0);
                best = (off, primitive, (inside / sum).truncate().as_vec2());
            }
        }
        (best.1, best.2)
    }

    /// The point of a triangle, with the depth of its plane.
    pub(crate) fn with_depth(&self, primitive: u32, surface: LocalInteraction) -> LocalInteraction {
        let [a, b, c] = self.exact_corners(primitive);
        let normal = (b - a).cross(c - a).normalize();
        let outward = normal * normal.dot(surface.normal.as_dvec3()).signum();
        LocalInteraction {
            depth: outward.dot(a - surface.position.as_dvec3()) as f32,
            ..surface
        }
    }
}

impl Mesh {
    /// The parameters of up to two crossings of a convex mesh with a line, in ascending order; NaN where there is
    /// none.
    pub(crate) fn crossings(&self, line: &Line) -> [f64; 2] {
        let Line { origin, direction } = *line;
        let met = (0..self.triangle_count() as u32)
            .filter_map(|i| meet(self.exact_corners(i), origin, direction));
        let (first, last) = met.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| {
            (low.min(t), high.max(t))
        });
        // An edge between two triangles is one crossing.
        let same = (origin.abs().max_element() + last.abs()) * 1e-13;
        match last - first {
            apart if apart > same => [first, last],
            _ if first.is_finite() => [first, f64::NAN],
            _ => [f64::NAN; 2],
        }
    }

    /// The surface at `p`, which is on it up to rounding.
    pub(crate) fn surface_near(&self, p: DVec3) -> LocalInteraction {
        let (primitive, b) = self.place_near(p);
        self.with_depth(primitive, self.surface(primitive, b))
    }

    /// The smallest box around it (m).
    pub(crate) fn exact_bounds(&self) -> [DVec3; 2] {
        let bounds = Mesh::bounds(self);
        [bounds.min.as_dvec3(), bounds.max.as_dvec3()]
    }
}
