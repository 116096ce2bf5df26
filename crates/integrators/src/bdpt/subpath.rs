//! The common part of subpaths from camera and light: the state between vertices, and the next vertex.

use super::path_vertex::{PathVertex, SubpathVertex};
use crate::steps::arrival;
use crate::steps::path_throughput::PathThroughput;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Hit, Ray, Scatterer, ScattererOf, SurfaceInteraction, Surfaces, World,
};
use glam::{Vec3, Vec4};

/// The numbers of the camera subpath's events, of the emission, and of the light subpath's events lie
/// side by side, the camera's first.
pub(super) fn camera_event(index: u32) -> u32 {
    2 * index
}

pub(super) fn light_event(index: u32) -> u32 {
    2 * index + 1
}

/// The state of a subpath from one vertex to the next.
pub(super) struct SubpathState {
    pub(super) ray: Ray,
    pub(super) throughput: PathThroughput,
    /// Density of `ray`'s direction at the last vertex, of the lane that chose.
    pub(super) density: f32,
    /// Probability of passing surfaces since the last vertex, per lane.
    pub(super) passed: Vec4,
    /// Segments so far, that of `ray` included.
    pub(super) segments: u32,
}

/// What a subpath interacts with at its next vertex.
pub(super) struct Interaction<'w, W: World + 'w> {
    pub(super) point: SurfaceInteraction,
    pub(super) bsdf: ScattererOf<'w, W>,
    /// σt for light along the subpath, of a medium (m⁻¹), per lane; 1 of a surface.
    pub(super) extinction: Vec4,
    /// The throughput of the subpath up to the light that a medium emits there, if it does.
    pub(super) emission: Option<PathThroughput>,
}

impl<'w, W: World> Interaction<'w, W> {
    /// A surface.
    pub(super) fn surface(
        world: &'w W,
        point: SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self {
        Self {
            point,
            bsdf: Scatterer::Surface(world.surfaces().bsdf(&point, wo, wavelengths)),
            extinction: Vec4::ONE,
            emission: None,
        }
    }
}

/// A subpath from the camera where it runs into a light.
pub(super) struct SubpathEnd {
    pub(super) throughput: PathThroughput,
    /// Density of the arrival, of the lane that chose: per unit area, or per unit solid angle of
    /// the sky, times the probability of passing what lies in between.
    pub(super) density: f32,
    /// That probability, per lane.
    pub(super) passed: Vec4,
}

impl SubpathState {
    /// Goes straight on through a surface.
    pub(super) fn pass(&mut self, point: &SurfaceInteraction, value: Vec4, chance: Vec4) {
        self.throughput.scatter(value, chance);
        self.passed *= chance;
        self.ray = point.spawn(self.ray.direction);
        self.segments += 1;
    }

    /// The arrival at a light.
    pub(super) fn arrival(&self, density: f32) -> SubpathEnd {
        SubpathEnd {
            throughput: self.throughput,
            density,
            passed: self.passed,
        }
    }

    /// Flies through the medium, to where light is scattered before its `hit`, if it is.
    #[cold]
    #[inline(never)]
    pub(super) fn fly<'w, W: World>(
        &mut self,
        world: &'w W,
        hit: Option<&Hit>,
        wavelengths: &Wavelengths,
        u: f32,
    ) -> Option<Interaction<'w, W>> {
        let flight = arrival::free_flight(world, &self.ray, hit, wavelengths, u)?;
        let density = flight.density();
        let before = self.throughput;
        self.throughput.scatter(flight.factor, density);
        self.passed *= flight.passed;
        let collision = flight.scattering?;
        let emission = (flight.emitted != Vec4::ZERO).then(|| {
            let mut emitted = before;
            emitted.scatter(flight.emitted, density);
            emitted
        });
        Some(Interaction {
            point: SurfaceInteraction::in_space(&self.ray, collision.t),
            bsdf: Scatterer::Space(collision.phase),
            extinction: collision.extinction,
            emission,
        })
    }

    /// The vertex of this interaction, arrived at with this density per solid angle at the last one.
    pub(super) fn vertex<'w, W: World>(
        &self,
        interaction: Interaction<'w, W>,
        arrival: f32,
    ) -> SubpathVertex<'w, W> {
        let Interaction {
            point,
            bsdf,
            extinction,
            ..
        } = interaction;
        PathVertex {
            point,
            bsdf,
            extinction: extinction / bsdf.projected_area(self.ray.direction),
            wo: -self.ray.direction,
            throughput: self.throughput,
            arrival: arrival * self.passed.x,
            pdf_rev: Vec4::ZERO,
            passed: self.passed,
            is_delta: false,
            segments: self.segments,
            parent: None,
            direct: 0.0,
        }
    }
}
