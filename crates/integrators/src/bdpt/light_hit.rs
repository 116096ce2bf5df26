//! s = 0: the camera subpath runs into light: a surface, a medium, the background.

use super::connect::{Connector, EVENLY};
use super::path_vertex::SubpathVertex;
use super::pdf_ratios::{EndPdfs, pdf_ratios_more};
use super::subpath::SubpathEnd;
use etalon_transport::{Lights, MediumId, Ray, SurfaceInteraction, World};
use glam::{Vec3, Vec4};

/// Densities of the last vertex, for a path that hit a light, if generated from the light.
struct LightHitPdfs {
    /// Density of light sampling, in the measure of the arrival.
    sampled: Vec4,
    /// The same of emission.
    emitted: f32,
    /// Density of the emitted ray arriving at the vertex before, per lane.
    ray: Vec4,
}

impl<'w, W: World> Connector<'_, 'w, W> {
    /// s = 0: the camera subpath ran into an emitting surface.
    pub(super) fn hit_light(
        &mut self,
        arrival: &SubpathEnd,
        point: &SurfaceInteraction,
        wo: Vec3,
        camera: &[SubpathVertex<'w, W>],
    ) {
        let world = self.world;
        let radiance = world.lights().emitted(point, wo, self.wavelengths);
        self.add_emitted(arrival, radiance, camera, |first| {
            let cos = point.normal.dot(wo).abs();
            let distance_squared = point.position.distance_squared(first.point.position);
            let from = first.receiver();
            let sampled = world.light_density(&from, point, -wo).lanes();
            let emission = world.emission_density(point.light, wo, cos, point.time);
            LightHitPdfs {
                sampled: sampled * (cos / distance_squared),
                emitted: emission.origin,
                ray: emission.ray * first.per_area(wo, distance_squared),
            }
        });
    }

    /// s = 0: the camera subpath ended in a medium that emits, whose emission its throughput contains.
    pub(super) fn hit_medium(
        &mut self,
        arrival: &SubpathEnd,
        point: &SurfaceInteraction,
        medium: MediumId,
        camera: &[SubpathVertex<'w, W>],
    ) {
        let world = self.world;
        self.add_emitted(arrival, Vec4::ONE, camera, |first| {
            let way = point.position - first.point.position;
            let distance_squared = way.length_squared();
            let chosen = world.medium_light_density(medium, point.position);
            let direction = way / distance_squared.sqrt();
            LightHitPdfs {
                sampled: Vec4::splat(chosen),
                emitted: chosen,
                ray: first.per_area(direction, distance_squared) * EVENLY,
            }
        });
    }

    /// s = 0: the camera subpath left the scene along `ray`.
    pub(super) fn hit_background(
        &mut self,
        arrival: &SubpathEnd,
        ray: &Ray,
        camera: &[SubpathVertex<'w, W>],
    ) {
        let world = self.world;
        let (direction, time) = (ray.direction, ray.time);
        let radiance = (world.lights()).background(direction, time, self.wavelengths);
        self.add_emitted(arrival, radiance, camera, |first| {
            let emission = world.background_emission_density(direction, time);
            let from = first.receiver();
            LightHitPdfs {
                sampled: world.background_density(&from, direction).lanes(),
                emitted: emission.origin,
                ray: emission.ray * first.per_area(direction, 1.0),
            }
        });
    }

    /// Adds the radiance that the camera subpath arrived at, weighed against the techniques that would have made the
    /// same path from the light.
    fn add_emitted(
        &mut self,
        arrival: &SubpathEnd,
        radiance: Vec4,
        camera: &[SubpathVertex<'w, W>],
        alternatives: impl FnOnce(&SubpathVertex<'w, W>) -> LightHitPdfs,
    ) {
        if radiance == Vec4::ZERO {
            return;
        }
        let Some(weighted) = self.wanted(0, camera.len() + 2) else {
            return;
        };
        if self.connections() == 0.0 && camera.iter().any(|vertex| !vertex.is_delta) {
            // Left to merging there.
            return;
        }
        let mut total = arrival.throughput.r_u.element_sum();
        if let [before @ .., first] = camera
            && weighted
        {
            let alternatives = alternatives(first);
            let connects = !first.is_delta;
            if connects {
                total +=
                    (first.throughput.r_u * alternatives.sampled).element_sum() / arrival.density;
            }
            let ends = EndPdfs {
                here: arrival.passed * alternatives.ray,
                before: before.last().map_or(Vec4::ZERO, |vertex| vertex.pdf_rev),
            };
            let product = Vec4::splat(alternatives.emitted / arrival.density);
            total += pdf_ratios_more(None, camera, product, ends, connects, self.camera_end());
        }
        self.radiance += arrival.throughput.beta * radiance / total;
    }
}
