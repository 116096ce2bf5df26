//! Rays that leave points of surfaces, alone or in lanes.

use crate::ray::segments;
use crate::{Departure, MediumInterface, Ray, ShapeId};
use etalon_math::lane::{Lane, Select, Vector};
use etalon_math::offset::offset_origins;
use glam::Vec3;

/// Points of surfaces that rays leave, as [`SurfaceInteraction`](crate::SurfaceInteraction) describes them.
#[derive(Clone, Copy, Debug)]
pub struct Leaving<F: Lane> {
    /// Positions (m, world).
    pub position: F::Vector,
    /// Bounds on the absolute error of each coordinate.
    pub error: F::Vector,
    /// How far along `normal` from `position` the surface is (m); NaN if that is not known.
    pub depth: F,
    /// Unit geometric normals, outside.
    pub normal: F::Vector,
}

/// Rays from points of surfaces.
#[derive(Clone, Copy, Debug)]
pub struct LeavingRays<F: Lane> {
    /// Origins (m), a little off the surface.
    pub origin: F::Vector,
    /// Unit directions.
    pub direction: F::Vector,
    /// Lengths (m).
    pub t_max: F,
    /// Where the ray crosses the surface that it leaves, not above 0, as [`Departure`] has it; NaN if that is not known.
    pub departure: F,
    /// Cosines with the normals.
    pub cos: F,
}

/// What a ray takes along from the surface that it leaves.
#[derive(Clone, Copy, Debug)]
pub struct LeftSurface {
    /// The shape.
    pub shape: ShapeId,
    /// The primitive within the shape.
    pub primitive: u32,
    /// The moment.
    pub time: f32,
    /// The media on both sides.
    pub media: MediumInterface,
}

impl<F: Lane> Leaving<F> {
    /// Half-lines.
    #[inline(always)]
    pub fn spawn(&self, direction: F::Vector) -> LeavingRays<F> {
        let origin = offset_origins::<F>(self.position, self.error, self.normal, direction);
        self.rays(origin, direction, F::splat(f32::INFINITY))
    }

    /// Segments to points that are off any surface; they end a few roundings short of them. The lanes where the two ends do not
    /// coincide.
    #[inline(always)]
    pub fn toward(&self, target: F::Vector) -> (LeavingRays<F>, F::Mask) {
        let outward = target - self.position;
        let origin = offset_origins::<F>(self.position, self.error, self.normal, outward);
        let (direction, t_max, exists) = segments::<F>(origin, target);
        (self.rays(origin, direction, t_max), exists)
    }

    #[inline(always)]
    fn rays(&self, origin: F::Vector, direction: F::Vector, t_max: F) -> LeavingRays<F> {
        // Neighbouring numbers: their difference is exact.
        let height = (origin - self.position).dot_product(self.normal) - self.depth;
        let cos = direction.dot_product(self.normal);
        let t = -height / cos;
        let is_known = t.le(F::ZERO) & t.gt(F::splat(f32::NEG_INFINITY));
        LeavingRays {
            origin,
            direction,
            t_max,
            departure: is_known.select(t, F::splat(f32::NAN)),
            cos,
        }
    }
}

impl<F: Lane> LeavingRays<F> {
    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    pub fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        Self {
            origin: F::Vector::choose(mask, yes.origin, no.origin),
            direction: F::Vector::choose(mask, yes.direction, no.direction),
            t_max: mask.select(yes.t_max, no.t_max),
            departure: mask.select(yes.departure, no.departure),
            cos: mask.select(yes.cos, no.cos),
        }
    }

    /// The ray in any lane, which leaves this surface.
    #[inline(always)]
    pub fn lanes(self) -> impl Fn(usize, LeftSurface) -> Ray {
        let ([ox, oy, oz], [dx, dy, dz]) = (self.origin.xyz(), self.direction.xyz());
        let rows = F::rows([ox, oy, oz, dx, dy, dz, self.t_max, self.departure]);
        let cos = self.cos;
        move |i, left| {
            let [ox, oy, oz, dx, dy, dz, t_max, t] = rows.as_ref()[i];
            Ray {
                origin: Vec3::new(ox, oy, oz),
                direction: Vec3::new(dx, dy, dz),
                t_max,
                time: left.time,
                departure: match t.is_nan() {
                    true => Departure::NONE,
                    false => Departure {
                        shape: left.shape,
                        primitive: left.primitive,
                        t,
                    },
                },
                medium: left.media.toward(cos.lane(i)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{InstanceId, LaneSurface, LightId, MaterialId, MediumId, SurfaceInteraction};
    use etalon_math::Frame;
    use etalon_math::lane::{F32x8, Mask};
    use etalon_sampling::{Independent, Sampler};
    use glam::{Vec2, Vec4};

    fn vertex(random: &mut Independent) -> SurfaceInteraction {
        let [mut u, mut v] = [(); 2].map(|()| {
            let mut number = || 2.0 * random.next_1d() - 1.0;
            Vec4::new(number(), number(), number(), number())
        });
        if random.next_1d() < 0.3 {
            (u, v) = (u * 1e3, v * 1e-3);
        }
        let normal = v.truncate().normalize_or(Vec3::Z);
        SurfaceInteraction {
            position: u.truncate(),
            error: u.truncate().abs() * 1e-7,
            depth: match random.next_1d() {
                ..0.3 => 1e-9 * u.w,
                ..0.6 => 1e-2 * u.w,
                _ => f32::NAN,
            },
            normal,
            shading: Frame::from_normal(normal),
            uv: Vec2::ZERO,
            dp_du: Vec3::X,
            dp_dv: Vec3::Y,
            t: 1.0,
            time: random.next_1d(),
            parameters: Vec2::ZERO,
            shape: ShapeId(3),
            primitive: 4,
            instance: InstanceId::NONE,
            material: MaterialId(1),
            light: LightId::NONE,
            media: MediumInterface {
                inside: MediumId(7),
                outside: MediumId::NONE,
            },
        }
    }

    /// Mutants rejected: rays from another lane's vertex, a departure ahead of the ray, the medium of another vertex, the end of
    /// another lane's segment.
    #[test]
    fn rays_in_lanes_are_those_of_each_vertex() {
        let mut random = Independent::from_key(1);
        let (mut known, mut inside) = (0, 0);
        for _ in 0..200 {
            let vertices = [(); 8].map(|()| vertex(&mut random));
            let mut aim = || {
                let [x, y, z] = [(); 3].map(|()| 4.0 * random.next_1d() - 2.0);
                Vec3::new(x, y, z)
            };
            let mut targets = [(); 8].map(|()| aim());
            // Where rounding leaves nothing between them.
            targets[5] = vertices[5].origin_toward(vertices[5].position);
            let directions = targets.map(|target| target.normalize_or(Vec3::X));
            let leaving = LaneSurface::<F32x8>::of_lanes(|i| (&vertices[i]).into()).leaving;
            let direction = <F32x8 as Lane>::Vector::of_lanes(|i| directions[i]);
            let target = <F32x8 as Lane>::Vector::of_lanes(|i| targets[i]);
            let spawned = leaving.spawn(direction).lanes();
            let (segments, exist) = leaving.toward(target);
            let segments = segments.lanes();
            for (i, vertex) in vertices.iter().enumerate() {
                let spawned = spawned(i, vertex.left());
                assert_eq!(spawned, vertex.spawn(directions[i]));
                assert!(spawned.departure.t <= 0.0);
                let alone = vertex.shadow_ray(directions[i], Some(targets[i]));
                assert_eq!(exist.lane(i).then(|| segments(i, vertex.left())), alone);
                known += u32::from(spawned.departure != Departure::NONE);
                inside += u32::from(spawned.medium == MediumId(7));
            }
        }
        assert!((200..1400).contains(&known) && (200..1400).contains(&inside));
    }
}
