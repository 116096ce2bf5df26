//! The steps that every path takes, written once: to the next surface, emission there, next-event estimation,
//! Russian roulette ([`PathThroughput::survives`]).
//!
//! Estimators differ in what they do between these steps. What travels along a ray, as light in a medium does, enters
//! here and in [`World::transmittance`].

use crate::candidates::Aim;
use crate::light_mis::LightMis;
use crate::path_throughput::PathThroughput;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, FreeFlight, Hit, Lights, Media, Medium, PhaseOf, Ray, SurfaceInteraction, Surfaces,
    Transmission, World,
};
use glam::{Vec3, Vec4};

/// The closest hit of `ray`; emitters are looked through if they are `hidden`, and `ray` then starts on the last of
/// them, or where it did if a medium is all around. `None` if it leaves the scene.
#[inline]
pub(crate) fn next_hit<W: World>(world: &W, ray: &mut Ray, hidden: bool) -> Option<Hit> {
    let start = *ray;
    let mut hit = world.surfaces().intersect(ray);
    while let Some(found) = hit
        && hidden
        && world.lights().is_emitter(&found)
    {
        *ray = world.surfaces().vertex(ray, &found).spawn(ray.direction);
        hit = world.surfaces().intersect(ray);
    }
    if start.medium.is_some() && start.medium == ray.medium {
        // The medium on this side of what is looked through is not.
        let moved = (ray.origin - start.origin).dot(start.direction);
        hit = hit.map(|hit| Hit {
            t: hit.t + moved,
            ..hit
        });
        *ray = start;
    }
    hit
}

/// The same with the surface there.
#[inline]
pub(crate) fn next_surface<W: World>(
    world: &W,
    ray: &mut Ray,
    hidden: bool,
) -> Option<(Hit, SurfaceInteraction)> {
    let hit = next_hit(world, ray, hidden)?;
    Some((hit, world.surfaces().vertex(ray, &hit)))
}

/// A flight through the medium that `ray` is in, to its `hit`, or to where light is scattered before it; `u` in [0, 1)
/// decides. `None` in empty space.
#[inline]
pub(crate) fn free_flight<'w, W: World>(
    world: &'w W,
    ray: &Ray,
    hit: Option<&Hit>,
    wavelengths: &Wavelengths,
    u: f32,
) -> Option<FreeFlight<PhaseOf<'w, W>>> {
    if !ray.medium.is_some() {
        return None;
    }
    let medium = world.media().medium(ray.medium, wavelengths)?;
    Some(flight_in(&medium, ray, hit, u))
}

/// The same in a medium at hand.
#[inline]
pub(crate) fn flight_in<M: Medium>(
    medium: &M,
    ray: &Ray,
    hit: Option<&Hit>,
    u: f32,
) -> FreeFlight<M::Phase> {
    let t_max = hit.map_or(ray.t_max, |hit| hit.t);
    // The number of tentative collisions has no bound, so they have a stream of their own.
    medium.free_flight(ray, t_max, u, &mut ray.stream(u))
}

/// The contribution of a path that arrives where `flight` along `ray` ends, by what the medium emits there; `light_mis`
/// has come there.
#[inline]
pub(crate) fn emitted_on_the_way<W: World, P>(
    world: &W,
    flight: &FreeFlight<P>,
    ray: &Ray,
    throughput: &PathThroughput,
    light_mis: &LightMis,
) -> Vec4 {
    let Some(collision) = (flight.scattering.as_ref()).filter(|_| flight.emitted != Vec4::ZERO)
    else {
        return Vec4::ZERO;
    };
    let mut emitted = *throughput;
    emitted.scatter(flight.emitted, flight.density());
    let other = light_mis.pdf_in_medium(world, ray.medium, ray.at(collision.t));
    emitted.contribution(Vec4::ONE, other)
}

/// What lets light pass on the way of `ray` to its `hit`, by an estimate; `None` in empty space.
#[inline]
pub(crate) fn transmittance<W: World>(
    world: &W,
    ray: &Ray,
    hit: Option<&Hit>,
    wavelengths: &Wavelengths,
) -> Option<Transmission> {
    if !ray.medium.is_some() {
        return None;
    }
    let medium = world.media().medium(ray.medium, wavelengths)?;
    let t_max = hit.map_or(ray.t_max, |hit| hit.t);
    Some(medium.transmittance(ray, t_max, &mut ray.stream(0.0)))
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
    let radiance = world.lights().background(direction, wavelengths);
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
    let radiance = world.lights().emitted(at, -direction, wavelengths);
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
