//! What lights ask of shapes, which may move while they shine.
//!
//! A shape that moves is the only member of a group that an instance carries, perhaps carried itself. If it emits, all
//! that keeps angles and scales by k(t): a density per solid angle is the same in both spaces, one per area is k² times that in the world.

use crate::accelerator::Bounds;
use crate::builder::placed_bounds;
use crate::geometry::Geometry;
use crate::instance::Group;
use crate::placement::Placement;
use crate::shapes::Shape;
use etalon_math::lane::Lane;
use etalon_math::{DirectionCone, float64};
use etalon_transport::{
    LanePoint, LaneReceiver, LightSampleContext, SampledPoint, ShapeId, Shapes, SurfacePoint,
    TexturePoint,
};
use glam::{DVec3, Vec2, Vec3};

impl Geometry {
    /// Answers with what `ask` says of the shape and of where it is at `time`, if it moves.
    #[inline]
    fn at<R>(
        &self,
        shape: ShapeId,
        time: f32,
        ask: impl FnOnce(&Shape, Option<&Placement>) -> R,
    ) -> R {
        let model = self.shape(shape);
        let carrier = self.attachments[shape.0 as usize].carrier;
        if !carrier.is_some() {
            return ask(model, None);
        }
        let (instance, rest) = self.enter(&self.world, carrier.0);
        instance.placement.at(time, |outermost| {
            if rest == 0 {
                return ask(model, Some(outermost));
            }
            let (mut whole, mut group, mut path) = (*outermost, instance.group, rest);
            while path > 0 {
                let (inner, rest) = self.enter(&self.groups[group.0 as usize], path);
                whole = inner.placement.at(time, |placement| whole.after(placement));
                (group, path) = (inner.group, rest);
            }
            ask(model, Some(&whole))
        })
    }

    /// [`Shapes::sample_toward`] of a shape that moves; apart, so that the sampling of what stands is part of its caller.
    #[cold]
    #[inline(never)]
    fn sample_moving_toward(
        &self,
        shape: ShapeId,
        from: &LightSampleContext,
        u: Vec2,
    ) -> Option<SampledPoint> {
        let placement = self.at(shape, from.time, |_, placement| placement.copied())?;
        let local = placement.local_receiver(from);
        let sampled = self.shape(shape).sample_toward(&local, u)?;
        Some(SampledPoint {
            point: placement.surface_point(&sampled.point),
            ..sampled
        })
    }

    /// The box around what a placement of a group carries, whenever.
    fn carried_bounds(&self, group: &Group, path: u32, bounds: Bounds) -> Bounds {
        let (instance, rest) = self.enter(group, path);
        let inner = match rest {
            0 => bounds,
            _ => self.carried_bounds(&self.groups[instance.group.0 as usize], rest, bounds),
        };
        placed_bounds(inner, &instance.placement)
    }
}

impl Placement {
    /// A map that keeps angles makes areas so many times as large.
    fn area_factor(&self) -> f32 {
        float64::pow(self.linear().determinant().abs(), 2.0 / 3.0) as f32
    }

    /// A point of the shape in the world.
    fn surface_point(&self, point: &SurfacePoint) -> SurfacePoint {
        let (position, error) = self.rounded_point(point.position, point.error);
        SurfacePoint {
            position,
            error,
            normal: self.unit_normal(point.normal),
            texture: TexturePoint {
                position,
                ..point.texture
            },
        }
    }

    /// A point of the world in the shape's space.
    fn local_receiver(&self, from: &LightSampleContext) -> LightSampleContext {
        LightSampleContext {
            position: self.local_point(from.position.as_dvec3()).as_vec3(),
            normal: self.local_normal(from.normal),
            ..*from
        }
    }

    /// The direction of a normal of the world in the shape's space, of a map that keeps angles.
    fn local_normal(&self, normal: Vec3) -> Vec3 {
        let local: DVec3 = self.local_vector(normal.as_dvec3());
        local.normalize_or_zero().as_vec3()
    }
}

impl Shapes for Geometry {
    fn area(&self, shape: ShapeId, time: f32) -> f32 {
        self.at(shape, time, |model, placement| {
            model.area() as f32 * placement.map_or(1.0, Placement::area_factor)
        })
    }

    fn bounds(&self, shape: ShapeId) -> [Vec3; 2] {
        let mut bounds = self.shape(shape).bounds();
        let carrier = self.attachments[shape.0 as usize].carrier;
        if carrier.is_some() {
            bounds = self.carried_bounds(&self.world, carrier.0, bounds);
        }
        [bounds.min, bounds.max]
    }

    fn normals(&self, shape: ShapeId) -> DirectionCone {
        match self.attachments[shape.0 as usize].carrier.is_some() {
            true => DirectionCone::ALL,
            false => self.shape(shape).normals(),
        }
    }

    fn sample_area(&self, shape: ShapeId, u: Vec2, time: f32) -> SampledPoint {
        let mut sampled = self.at(shape, time, |model, placement| {
            let sampled = model.sample_area(u);
            match placement {
                None => sampled,
                Some(placement) => SampledPoint {
                    point: placement.surface_point(&sampled.point),
                    density: sampled.density / placement.area_factor(),
                },
            }
        });
        sampled.point.texture.shape = shape;
        sampled
    }

    #[inline]
    fn sample_toward(
        &self,
        shape: ShapeId,
        from: &LightSampleContext,
        u: Vec2,
    ) -> Option<SampledPoint> {
        let moves = self.attachments[shape.0 as usize].carrier.is_some();
        let mut sampled = match moves {
            false => self.shape(shape).sample_toward(from, u),
            true => self.sample_moving_toward(shape, from, u),
        };
        if let Some(sampled) = &mut sampled {
            sampled.point.texture.shape = shape;
        }
        sampled
    }

    #[inline]
    fn are_alike(&self, shapes: [ShapeId; 2]) -> bool {
        let moves = |shape: ShapeId| self.attachments[shape.0 as usize].carrier.is_some();
        let [a, b] = shapes.map(|shape| self.shape(shape));
        !shapes.into_iter().any(moves) && a.is_alike(b)
    }

    #[inline]
    fn points_toward<F: Lane>(
        &self,
        shape: impl Fn(usize) -> ShapeId,
        from: &LaneReceiver<F>,
        u: [F; 2],
    ) -> LanePoint<F> {
        Shape::points_toward(|i| self.shape(shape(i)), from, u)
    }

    fn density_toward(&self, shape: ShapeId, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        self.at(shape, from.time, |model, placement| match placement {
            None => model.density_toward(from, at),
            Some(placement) => {
                let at = SurfacePoint {
                    position: placement.local_point(at.position.as_dvec3()).as_vec3(),
                    normal: placement.local_normal(at.normal),
                    ..*at
                };
                model.density_toward(&placement.local_receiver(from), &at)
            }
        })
    }

    fn attribute(
        &self,
        shape: ShapeId,
        name: &str,
        primitive: u32,
        parameters: Vec2,
        range: [f32; 2],
    ) -> Option<Vec3> {
        self.shape(shape)
            .attribute(name, primitive, parameters, range)
    }
}
