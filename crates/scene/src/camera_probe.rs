//! The first surfaces that the camera sees: whether light can be connected to the camera.
//!
//! A lattice of rays through the film, each with its own lens position, continues through null
//! surfaces. Small objects may be missed; everything found exists.

use etalon_transport::{
    Bsdf, Camera, CameraProbe, LightSampleContext, Lights, Media, Ray, SamplePdf, Sensor,
    SurfaceInteraction, Surfaces, TransportMode, World,
};
use glam::{UVec2, Vec2, Vec3, Vec4};

/// Rays along each side of the film.
const LATTICE: u32 = 48;

/// The most null surfaces that a ray crosses.
const PASSED: u32 = 64;

/// Number of scattering directions that are tried.
const TRIED: u32 = 16;

/// Multiples of this spread evenly over a square, modulo one: powers of the inverse of the plastic
/// number (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
const SPREAD: Vec2 = Vec2::new(0.754_877_7, 0.569_840_3);

/// The same for three dimensions.
const SPREAD_3: [f32; 3] = [0.819_172_5, 0.671_043_6, 0.549_700_5];

/// Looks through the film's window of `size` pixels from `origin`.
pub(crate) fn look<W: World>(world: &W, origin: UVec2, size: UVec2) -> CameraProbe {
    let mut view = CameraProbe::default();
    for index in 0..LATTICE * LATTICE {
        let cell = UVec2::new(index % LATTICE, index / LATTICE).as_vec2() + 0.5;
        let raster = origin.as_vec2() + size.as_vec2() * cell / LATTICE as f32;
        let lens = (SPREAD * index as f32).fract();
        let ray = Ray {
            medium: world.media().around_camera(),
            ..world.camera().ray(raster, lens, 0.5).ray
        };
        match reach(world, ray, index) {
            Some(Reached::LightOrMedium) => view.reached += 1,
            Some(Reached::Surface(vertex, wo)) => {
                view.reached += 1;
                view.veiled += u32::from(veiled(world, &vertex, wo, index));
            }
            None => {}
        }
        follow(world, ray, &mut view);
    }
    view
}

/// Where a ray ends that mirrors and glass send on.
enum Reached {
    /// At a light, or in a medium, which scatters light.
    LightOrMedium,
    /// At a surface that scatters light in a continuum of directions, seen from this direction.
    Surface(SurfaceInteraction, Vec3),
}

/// Follows a ray by way of mirrors and glass to a light, or to a surface that scatters light.
/// Among several discrete directions the ray's number chooses.
fn reach<W: World>(world: &W, mut ray: Ray, number: u32) -> Option<Reached> {
    let wavelengths = world.sensor().wavelengths(0.5);
    for bounce in 0..PASSED {
        if ray.medium.is_some() {
            return Some(Reached::LightOrMedium);
        }
        let Some(hit) = world.surfaces().intersect(&ray) else {
            return world
                .lights()
                .has_background()
                .then_some(Reached::LightOrMedium);
        };
        let vertex = world.surfaces().vertex(&ray, &hit);
        let wo = -ray.direction;
        let bsdf = world.surfaces().bsdf(&vertex, wo, &wavelengths);
        if scatters(&bsdf, wo) {
            return Some(Reached::Surface(vertex, wo));
        }
        if world.lights().is_emitter(&hit) {
            return Some(Reached::LightOrMedium);
        }
        let onward: Vec<Vec3> = (0..)
            .map_while(|index| bsdf.discrete(wo, index, TransportMode::Radiance))
            .filter(|sample| sample.value != Vec4::ZERO)
            .map(|sample| sample.wi)
            .collect();
        let choice = number.rotate_right(bounce) as usize % onward.len().max(1);
        ray = vertex.spawn(*onward.get(choice)?);
    }
    None
}

/// Whether a surface seen from a direction scatters any light in a continuum of directions, on either side.
fn scatters<B: Bsdf>(bsdf: &B, wo: Vec3) -> bool {
    let tried = |index: u32| {
        let [u_lobe, u, v] = SPREAD_3.map(|s| (s * index as f32).fract());
        bsdf.sample(wo, u_lobe, Vec2::new(u, v), TransportMode::Radiance)
    };
    bsdf.has_continuous()
        && (1..=TRIED).filter_map(tried).any(|sample| {
            matches!(sample.chance, SamplePdf::Continuous(_)) && sample.value != Vec4::ZERO
        })
}

/// Whether a light that is but a point or a direction would light a surface, were it not for smooth glass
/// in the way: the light bends there, so that no straight connection finds it. The ray's number chooses
/// the light.
fn veiled<W: World>(world: &W, vertex: &SurfaceInteraction, wo: Vec3, number: u32) -> bool {
    let wavelengths = world.sensor().wavelengths(0.5);
    let [u_light, u, v] = SPREAD_3.map(|s| (s * number as f32).fract());
    let Some(light) = world.sample_light(
        &LightSampleContext::on_surface(vertex.position, vertex.shading.n),
        &wavelengths,
        u_light,
        Vec2::new(u, v),
    ) else {
        return false;
    };
    let shows = world.surfaces().bsdf(vertex, wo, &wavelengths).eval(
        wo,
        light.direction,
        TransportMode::Radiance,
    );
    if light.origin.can_be_hit() || shows * light.radiance == Vec4::ZERO {
        return false;
    }
    let mut next = vertex.shadow_ray(light.direction, light.target);
    let mut bent = false;
    for _ in 0..PASSED {
        let Some(ray) = next else { return bent };
        let Some(hit) = world.surfaces().intersect(&ray) else {
            return bent;
        };
        let at = world.surfaces().vertex(&ray, &hit);
        let wo = -ray.direction;
        let bsdf = world.surfaces().bsdf(&at, wo, &wavelengths);
        let bends = (0..)
            .map_while(|index| bsdf.discrete(wo, index, TransportMode::Radiance))
            .any(|sample| {
                let through = sample.wi.dot(at.normal) * wo.dot(at.normal) < 0.0;
                through && !sample.is_null && sample.value != Vec4::ZERO
            });
        if !bends && bsdf.null_transmittance() == Vec4::ZERO {
            return false;
        }
        bent |= bends;
        next = at.shadow_ray(light.direction, light.target);
    }
    false
}

/// Adds what one ray sees.
fn follow<W: World>(world: &W, mut ray: Ray, view: &mut CameraProbe) {
    let wavelengths = world.sensor().wavelengths(0.5);
    let [mut scattering, mut smooth, mut light] = [false; 3];
    for _ in 0..PASSED {
        scattering |= ray.medium.is_some();
        let Some(hit) = world.surfaces().intersect(&ray) else {
            light |= world.lights().has_background();
            break;
        };
        let vertex = world.surfaces().vertex(&ray, &hit);
        let wo = -ray.direction;
        let emits = world.lights().is_emitter(&hit);
        light |= emits;
        let bsdf = world.surfaces().bsdf(&vertex, wo, &wavelengths);
        // A lamp without a material is a black surface.
        scattering |= bsdf.has_continuous() && (!emits || scatters(&bsdf, wo));
        smooth |= (0..)
            .map_while(|index| bsdf.discrete(wo, index, TransportMode::Radiance))
            .any(|sample| !sample.is_null && sample.value != Vec4::ZERO);
        if bsdf.null_transmittance() == Vec4::ZERO {
            break;
        }
        ray = vertex.spawn(ray.direction);
    }
    view.rays += 1;
    view.scattering += u32::from(scattering);
    view.smooth += u32::from(smooth);
    view.lights += u32::from(light);
}
