//! A mesh as a shape of the list: points on it are chosen by area, and toward a receiver within the
//! solid angle of a triangle that is chosen by area.

use crate::shapes::mesh::Mesh;
use crate::shapes::shape_model::ShapeModel;
use etalon_math::DirectionCone;
use etalon_sampling::warps::{SphericalTriangle, square_to_triangle};
use etalon_transport::{LightSampleContext, SampledPoint, SurfacePoint};
use glam::{Vec2, Vec3};

impl Mesh {
    /// A point of a triangle.
    fn point(&self, primitive: u32, b: Vec2) -> SurfacePoint {
        self.surface(primitive, b).point(primitive, b)
    }

    /// A triangle as a point sees it; `None` if it has no solid angle.
    fn seen(&self, primitive: u32, from: Vec3) -> Option<SphericalTriangle> {
        // Single precision would round the edges of a triangle that is small and far.
        let seen = |p: Vec3| p.as_dvec3() - from.as_dvec3();
        SphericalTriangle::new(self.corners(primitive).map(seen))
    }
}

impl ShapeModel for Mesh {
    #[inline]
    fn mesh(&self) -> Option<&Mesh> {
        Some(self)
    }

    fn mesh_mut(&mut self) -> Option<&mut Mesh> {
        Some(self)
    }

    fn normals(&self) -> DirectionCone {
        self.cone_of_normals()
    }

    fn prepare_sampling(&self) {
        self.by_area();
    }

    fn area(&self) -> Option<f64> {
        Some(Self::area(self))
    }

    fn sample_area(&self, u: Vec2) -> Option<SurfacePoint> {
        let choice = self.by_area()?.sample_fine(u);
        let parameters = square_to_triangle(Vec2::new(choice.rest, u.y));
        Some(self.point(choice.index as u32, parameters))
    }

    #[inline]
    fn sample_toward(&self, from: &LightSampleContext, u: Vec2) -> Option<SampledPoint> {
        let choice = self.by_area()?.sample_fine(u);
        let primitive = choice.index as u32;
        let u = Vec2::new(choice.rest, u.y);
        Some(match self.seen(primitive, from.position) {
            Some(seen) => SampledPoint {
                point: self.point(primitive, seen.barycentric(seen.sample(u))),
                density: choice.probability * seen.density(),
            },
            None => {
                let point = self.point(primitive, square_to_triangle(u));
                let density = self.area_density_toward(from.position, &point);
                SampledPoint { point, density }
            }
        })
    }

    fn density_toward(&self, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        let primitive = at.texture.primitive;
        match (self.by_area(), self.seen(primitive, from.position)) {
            (Some(by_area), Some(seen)) => by_area.probability(primitive as usize) * seen.density(),
            _ => self.area_density_toward(from.position, at),
        }
    }
}
