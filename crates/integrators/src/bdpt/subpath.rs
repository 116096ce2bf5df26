//! The common part of subpaths from camera and light: the state between vertices, and the next vertex.

use super::path_vertex::{Corner, PathVertex};
use crate::steps::arrival;
use crate::steps::path_throughput::PathThroughput;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Hit, Ray, Scatterer, ScattererOf, SurfaceInteraction, Surfaces, World,
};
use glam::{Vec3, Vec4};

/// The numbers of the camera walk's events, of the emission, and of the light walk's events lie
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
    pub(super) prefix: PathThroughput,
    /// Density of `ray`'s direction at the last corner, of the lane that chose.
    pub(super) density: f32,
    /// Probability of passing surfaces since the last corner, per lane.
    pub(super) passed: Vec4,
    /// Segments behind, that of `ray` included.
    pub(super) segments: u32,
}

/// The next vertex of a subpath.
pub(super) struct Met<'w, W: World + 'w> {
    pub(super) vertex: SurfaceInteraction,
    pub(super) bsdf: ScattererOf<'w, W>,
    /// σt for light along the walk, of a medium (m⁻¹), per lane; 1 of a surface.
    pub(super) extinction: Vec4,
    /// The walk up to what a medium emits there, if it does.
    pub(super) shining: Option<PathThroughput>,
}

impl<'w, W: World> Met<'w, W> {
    /// A surface.
    pub(super) fn surface(
        world: &'w W,
        vertex: SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self {
        Self {
            vertex,
            bsdf: Scatterer::Surface(world.surfaces().bsdf(&vertex, wo, wavelengths)),
            extinction: Vec4::ONE,
            shining: None,
        }
    }
}

/// A subpath from the camera where it runs into a light.
pub(super) struct SubpathEnd {
    pub(super) prefix: PathThroughput,
    /// Density of the arrival, of the lane that chose: per unit area, or per unit solid angle of
    /// the sky, times the probability of passing what lies in between.
    pub(super) density: f32,
    /// That probability, per lane.
    pub(super) passed: Vec4,
}

impl SubpathState {
    /// Goes straight on through a surface.
    pub(super) fn pass(&mut self, vertex: &SurfaceInteraction, value: Vec4, chance: Vec4) {
        self.prefix.scatter(value, chance);
        self.passed *= chance;
        self.ray = vertex.spawn(self.ray.direction);
        self.segments += 1;
    }

    /// The arrival at a light.
    pub(super) fn arrival(&self, density: f32) -> SubpathEnd {
        SubpathEnd {
            prefix: self.prefix,
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
    ) -> Option<Met<'w, W>> {
        let flight = arrival::free_flight(world, &self.ray, hit, wavelengths, u)?;
        let density = flight.density();
        let before = self.prefix;
        self.prefix.scatter(flight.factor, density);
        self.passed *= flight.passed;
        let collision = flight.scattering?;
        let shining = (flight.emitted != Vec4::ZERO).then(|| {
            let mut emitted = before;
            emitted.scatter(flight.emitted, density);
            emitted
        });
        Some(Met {
            vertex: SurfaceInteraction::in_space(&self.ray, collision.t),
            bsdf: Scatterer::Space(collision.phase),
            extinction: collision.extinction,
            shining,
        })
    }

    /// The corner at what was met, arrived at with this density per solid angle at the last one.
    pub(super) fn corner<'w, W: World>(&self, met: Met<'w, W>, arrival: f32) -> Corner<'w, W> {
        let Met {
            vertex,
            bsdf,
            extinction,
            ..
        } = met;
        PathVertex {
            vertex,
            bsdf,
            extinction: extinction / bsdf.projected_area(self.ray.direction),
            wo: -self.ray.direction,
            prefix: self.prefix,
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
