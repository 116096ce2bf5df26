//! The steps that every path takes, written once: to the next surface, emission there, next-event estimation,
//! Russian roulette ([`PathThroughput::survives`]).
//!
//! Estimators differ in what they do between these steps. What travels along a ray, as light in a medium does, enters
//! here and in [`World::transmittance`].

use crate::candidates::Aim;
use crate::light_mis::LightMis;
use crate::path_throughput::PathThroughput;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, Hit, Ray, SurfaceInteraction, World};
use glam::{Vec3, Vec4};

/// The closest hit of `ray`; emitters are looked through if they are `hidden`, and `ray` then starts on the last of
/// them. `None` if it leaves the scene.
#[inline]
pub(crate) fn next_hit<W: World>(world: &W, ray: &mut Ray, hidden: bool) -> Option<Hit> {
    loop {
        let hit = world.intersect(ray)?;
        if !(hidden && world.is_emitter(&hit)) {
            return Some(hit);
        }
        *ray = world.vertex(ray, &hit).spawn(ray.direction);
    }
}

/// The same with the surface there.
#[inline]
pub(crate) fn next_surface<W: World>(
    world: &W,
    ray: &mut Ray,
    hidden: bool,
) -> Option<(Hit, SurfaceInteraction)> {
    let hit = next_hit(world, ray, hidden)?;
    Some((hit, world.vertex(ray, &hit)))
}

/// The contribution of a path that leaves the scene along `direction`.
#[inline]
pub(crate) fn background<W: World>(
    world: &W,
    direction: Vec3,
    wavelengths: &Wavelengths,
    throughput: &PathThroughput,
    light_mis: &LightMis,
) -> Vec4 {
    let radiance = world.background(direction, wavelengths);
    throughput.contribution(radiance, light_mis.pdf_at_background(world, direction))
}

/// The contribution of a path that arrives at the emitter `at` along `direction`.
#[inline]
pub(crate) fn emission<W: World>(
    world: &W,
    at: &SurfaceInteraction,
    direction: Vec3,
    wavelengths: &Wavelengths,
    throughput: &PathThroughput,
    light_mis: &LightMis,
) -> Vec4 {
    let radiance = world.emitted(at, -direction, wavelengths);
    if radiance == Vec4::ZERO {
        return Vec4::ZERO;
    }
    throughput.contribution(radiance, light_mis.pdf_at_surface(world, at, direction))
}

/// Next-event estimation: the contribution of a light sample, after its shadow ray from `vertex` past at most
/// `max_null` null interactions; `None` if nothing arrives.
#[inline]
pub(crate) fn shadowed<W: World>(
    world: &W,
    vertex: &SurfaceInteraction,
    wavelengths: &Wavelengths,
    aim: Option<Aim>,
    max_null: u32,
) -> Option<Vec4> {
    let aim = aim?;
    let ray = vertex.shadow_ray(aim.direction, aim.target)?;
    let passage = world.transmittance(&ray, wavelengths, max_null)?;
    Some(aim.estimate(&passage))
}

/// The opacity of the surface at which a path ends because of its length: no direction is sampled there.
#[inline]
pub(crate) fn opacity(bsdf: &impl Bsdf) -> f32 {
    1.0 - 0.25 * bsdf.null_probability().element_sum()
}
