//! Where a path arrives: the next surface along a ray, or a point of a medium before it, and the light that is emitted there.
//!
//! Every estimator that follows rays from the camera begins a segment so; what a medium does to light on the way enters here and
//! in [`World::transmittance`].

use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, FreeFlight, Hit, Lights, Media, Medium, PhaseOf, Ray, SurfaceInteraction, Surfaces,
    Transmission, World,
};
use glam::{Vec3, Vec4};

/// What there is where a ray of a path ends.
pub(crate) enum Arrival {
    /// A surface, and what its emission contributes.
    Surface(SurfaceInteraction, Vec4),
    /// Lights at infinity, and what they contribute.
    Background(Vec4),
    /// Nothing.
    Nothing,
}

/// A path as it arrives: what light that it finds is weighted with.
#[derive(Clone, Copy)]
pub(crate) struct Arriving<'a> {
    pub(crate) wavelengths: &'a Wavelengths,
    pub(crate) throughput: &'a PathThroughput,
    pub(crate) light_mis: &'a LightMis,
}

impl Arriving<'_> {
    /// Where the path arrives along `ray`, whose nearest surface is `hit`. Lights at infinity are nothing if it does not see them.
    #[inline(always)] // So that the surface is made where it stays.
    pub(crate) fn at<W: World>(
        &self,
        world: &W,
        ray: &Ray,
        hit: Option<&Hit>,
        sees_background: bool,
    ) -> Arrival {
        let Some(hit) = hit else {
            return match sees_background && world.lights().has_background() {
                true => Arrival::Background(self.background(world, ray)),
                false => Arrival::Nothing,
            };
        };
        let vertex = world.surfaces().vertex(ray, hit);
        let emission = match vertex.light.is_some() {
            true => self.emission(world, &vertex, ray.direction),
            false => Vec4::ZERO,
        };
        Arrival::Surface(vertex, emission)
    }

    /// The contribution of a path that leaves the scene along `ray`.
    #[inline]
    fn background<W: World>(&self, world: &W, ray: &Ray) -> Vec4 {
        let lights = world.lights();
        let radiance = lights.background(ray.direction, ray.time, self.wavelengths);
        let by_light_sampling = self.light_mis.pdf_at_background(world, ray.direction);
        self.throughput.contribution(radiance, by_light_sampling)
    }

    /// The contribution of a path that arrives at the emitter `at` along `direction`.
    #[inline]
    fn emission<W: World>(&self, world: &W, at: &SurfaceInteraction, direction: Vec3) -> Vec4 {
        let radiance = world.lights().emitted(at, -direction, self.wavelengths);
        if radiance == Vec4::ZERO {
            return Vec4::ZERO;
        }
        let by_light_sampling = self.light_mis.pdf_at_surface(world, at, direction);
        self.throughput.contribution(radiance, by_light_sampling)
    }

    /// The contribution of a path that ends where `flight` along `ray` does, by what the medium emits there.
    #[inline]
    pub(crate) fn emitted_by_medium<W: World, P>(
        &self,
        world: &W,
        flight: &FreeFlight<P>,
        ray: &Ray,
    ) -> Vec4 {
        let Some(collision) = (flight.scattering.as_ref()).filter(|_| flight.emitted != Vec4::ZERO)
        else {
            return Vec4::ZERO;
        };
        let mut emitted = *self.throughput;
        emitted.scatter(flight.emitted, flight.density());
        let at = ray.at(collision.t);
        let by_light_sampling = self.light_mis.pdf_in_medium(world, ray.medium, at);
        emitted.contribution(Vec4::ONE, by_light_sampling)
    }
}

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
    let medium = world.media().enter(ray.medium, None, wavelengths)?;
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

/// An estimate of the transmittance along `ray` to its `hit`; `None` in empty space.
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
    let medium = world.media().enter(ray.medium, None, wavelengths)?;
    let t_max = hit.map_or(ray.t_max, |hit| hit.t);
    Some(medium.transmittance(ray, t_max, &mut ray.stream(0.0)))
}

/// The opacity of the surface at which a path ends because of its length: no direction is sampled there.
#[inline]
pub(crate) fn opacity(bsdf: &impl Bsdf) -> f32 {
    1.0 - 0.25 * bsdf.null_probability().element_sum()
}
