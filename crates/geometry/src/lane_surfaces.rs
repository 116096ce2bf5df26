//! The surfaces at several hits, in lanes.
//!
//! Each is computed by itself, as far as it is needed, and brought into its lane. To compute triangles and rectangles in lanes as
//! well took longer: what they are computed from must be fetched one by one, and they are mixed.

use crate::geometry::Geometry;
use crate::local_interaction::LocalInteraction;
use crate::shapes::Shape;
use crate::shapes::analytic::crossing::Line;
use etalon_math::lane::Lane;
use etalon_transport::{Hit, LaneSurface, Ray, ShadedPoint, TexturePoint};

impl Geometry {
    /// The surface where `ray(i)` has its hit `hit(i)`, in lane i, with the bits of [`Geometry::vertex`].
    #[inline(always)] // Vectors would go through memory.
    pub fn surfaces<'h, F: Lane>(
        &self,
        ray: impl Fn(usize) -> &'h Ray,
        hit: impl Fn(usize) -> &'h Hit,
    ) -> LaneSurface<F> {
        LaneSurface::of_lanes(|i| self.shaded_point(ray(i), hit(i)))
    }

    /// The point of a hit, for textures, with the bits of [`Geometry::vertex`].
    #[inline]
    pub fn texture_point(&self, ray: &Ray, hit: &Hit) -> TexturePoint {
        let point = self.on_triangle(hit, |surface| TexturePoint {
            position: surface.position,
            uv: surface.uv,
            shape: hit.shape,
            primitive: hit.primitive,
            parameters: hit.parameters,
        });
        point.unwrap_or_else(|| TexturePoint::from(&self.vertex(ray, hit)))
    }

    /// What lanes need of [`Geometry::vertex`].
    #[inline(always)] // So that it is made where it stays, and nothing else is.
    fn shaded_point(&self, ray: &Ray, hit: &Hit) -> ShadedPoint {
        self.on_triangle(hit, |surface| surface.shaded(hit.primitive))
            .unwrap_or_else(|| self.shaded_elsewhere(ray, hit))
    }

    /// What `take` makes of the surface of a hit on a triangle that no instance places.
    #[inline(always)] // As above.
    fn on_triangle<R>(&self, hit: &Hit, take: impl Fn(LocalInteraction) -> R) -> Option<R> {
        let shape = &self.shapes[hit.shape.0 as usize];
        if hit.instance.is_some() || shape.is_analytic() {
            return None;
        }
        // Tracing the ray has brought the accelerator's copy of the corners close.
        let corners = || self.world.accelerator.corners(hit.slot);
        Some(shape.at_triangle(hit.primitive, hit.parameters, corners, take))
    }

    /// The same on an instance or a shape that is intersected by a formula.
    #[inline(never)]
    fn shaded_elsewhere(&self, ray: &Ray, hit: &Hit) -> ShadedPoint {
        match &self.shapes[hit.shape.0 as usize] {
            Shape::Sphere(sphere) if !hit.instance.is_some() => {
                let line = Line::of_ray(ray.origin, ray.direction);
                let surface = sphere.surface_near(&line, hit.t.into());
                surface.shaded(hit.primitive)
            }
            _ => ShadedPoint::from(&self.vertex(ray, hit)),
        }
    }
}
