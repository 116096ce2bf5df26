//! The techniques: their contributions and their MIS weights.

use super::from_light::FromLight;
use super::merge::Merging;
use super::path_vertex::Corner;
use super::pdf_ratios::{CameraEnd, EndPdfs, LightEnd, fewer, more};
use super::subpath::SubpathEnd;
use super::technique::Technique;
use crate::steps::dimensions::BounceSamples;
use crate::steps::settings::PathSettings;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Camera, EmissionPdf, LightKind, Lights, MediumId, PixelSample, SamplePdf,
    SurfaceInteraction, TransportMode, World,
};
use glam::{Vec2, Vec3, Vec4};

/// The density of the directions in which particles leave a medium (sr⁻¹).
const EVENLY: f32 = 0.25 * core::f32::consts::FRAC_1_PI;

/// Densities of the last vertex, for a path that hit a light, if generated from the light.
struct AlternativePdfs {
    /// Density of light sampling, in the measure of the arrival.
    sampled: Vec4,
    /// The same of emission.
    emitted: f32,
    /// Density of the emitted ray arriving at the corner before, per lane.
    ray: Vec4,
}

/// Connects the corners of one sample's walks.
pub(super) struct Connector<'a, 'w, W: World> {
    pub(super) world: &'w W,
    pub(super) wavelengths: &'a Wavelengths,
    pub(super) settings: &'a PathSettings,
    /// The only technique to evaluate, if not all.
    pub(super) only: Option<Technique>,
    pub(super) site: &'a PixelSample,
    /// The aperture position of the camera's walk.
    pub(super) lens: Vec2,
    /// The light's walk, if anything was emitted.
    pub(super) start: Option<&'a FromLight>,
    pub(super) light: &'a [Corner<'w, W>],
    /// Whether the camera walk's first corner can be connected to the camera.
    pub(super) camera_connects: bool,
    /// The photons to merge with, if any.
    pub(super) merging: Option<&'a Merging>,
    /// Radiance at the pixel, per lane.
    pub(super) radiance: Vec4,
}

impl<'w, W: World> Connector<'_, 'w, W> {
    /// Density of camera rays at `point` per area across the ray; zero if a light path there cannot be
    /// connected to the camera.
    pub(super) fn camera_density(&self, point: &SurfaceInteraction) -> f32 {
        let camera = self.world.camera();
        let seen = camera.connect(point.position, self.lens, point.time, self.site.margin);
        seen.map_or(0.0, |connection| connection.weight)
    }

    /// Whether a technique has an MIS weight; `None` if it is not evaluated.
    pub(super) fn wanted(&self, light: usize, camera: usize) -> Option<bool> {
        match self.only {
            None => Some(true),
            Some(only) => (only.light == light && only.camera == camera).then_some(only.weighted),
        }
    }

    /// Number of vertices of the light subpath up to this one, including the light.
    pub(super) fn vertices(&self, index: usize) -> usize {
        let parents = |corner: &usize| self.light[*corner].parent;
        1 + core::iter::successors(Some(index), parents).count()
    }

    pub(super) fn camera_end(&self) -> CameraEnd {
        CameraEnd {
            connects: self.camera_connects,
            samples: self.site.pixels as f32,
            merging: self.area(),
            connections: self.connections(),
        }
    }

    fn light_end(&self, start: &FromLight, first: &Corner<'w, W>) -> LightEnd {
        LightEnd {
            can_be_hit: start.emission.origin.can_be_hit(),
            emitted: start.emission.density.origin,
            sampled: first.direct,
            merging: self.area(),
            connections: self.connections(),
        }
    }

    /// s = 0: the camera's walk ran into an emitting surface.
    pub(super) fn meet_light(
        &mut self,
        arrival: &SubpathEnd,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        eye: &[Corner<'w, W>],
    ) {
        let world = self.world;
        let radiance = world.lights().emitted(vertex, wo, self.wavelengths);
        self.find(arrival, radiance, eye, |first| {
            let cos = vertex.normal.dot(wo).abs();
            let distance_squared = vertex.position.distance_squared(first.vertex.position);
            let from = first.receiver();
            let sampled = world.light_density(&from, vertex, -wo).lanes();
            let emission = world.emission_density(vertex.light, wo, cos, vertex.time);
            AlternativePdfs {
                sampled: sampled * (cos / distance_squared),
                emitted: emission.origin,
                ray: emission.ray * first.per_area(wo, distance_squared),
            }
        });
    }

    /// s = 0: the camera's walk ended in a medium that emits, which its prefix has.
    pub(super) fn meet_medium(
        &mut self,
        arrival: &SubpathEnd,
        vertex: &SurfaceInteraction,
        medium: MediumId,
        eye: &[Corner<'w, W>],
    ) {
        let world = self.world;
        self.find(arrival, Vec4::ONE, eye, |first| {
            let way = vertex.position - first.vertex.position;
            let distance_squared = way.length_squared();
            let chosen = world.medium_light_density(medium, vertex.position);
            let direction = way / distance_squared.sqrt();
            AlternativePdfs {
                sampled: Vec4::splat(chosen),
                emitted: chosen,
                ray: first.per_area(direction, distance_squared) * EVENLY,
            }
        });
    }

    /// s = 0: the camera's walk left the scene.
    pub(super) fn meet_background(
        &mut self,
        arrival: &SubpathEnd,
        direction: Vec3,
        eye: &[Corner<'w, W>],
    ) {
        let world = self.world;
        let radiance = world.lights().background(direction, self.wavelengths);
        self.find(arrival, radiance, eye, |first| {
            let emission = world.background_emission_density(direction);
            let from = first.receiver();
            AlternativePdfs {
                sampled: world.background_density(&from, direction).lanes(),
                emitted: emission.origin,
                ray: emission.ray * first.per_area(direction, 1.0),
            }
        });
    }

    /// Adds the radiance that the camera's walk arrived at, weighed against the techniques that would have made the
    /// same path from the light.
    fn find(
        &mut self,
        arrival: &SubpathEnd,
        radiance: Vec4,
        eye: &[Corner<'w, W>],
        rivals: impl FnOnce(&Corner<'w, W>) -> AlternativePdfs,
    ) {
        if radiance == Vec4::ZERO {
            return;
        }
        let Some(mixed) = self.wanted(0, eye.len() + 2) else {
            return;
        };
        if self.connections() == 0.0 && eye.iter().any(|corner| !corner.is_delta) {
            // Left to merging there.
            return;
        }
        let mut total = arrival.prefix.r_u.element_sum();
        if let [before @ .., first] = eye
            && mixed
        {
            let rivals = rivals(first);
            let connects = !first.is_delta;
            if connects {
                total += (first.prefix.r_u * rivals.sampled).element_sum() / arrival.density;
            }
            let ends = EndPdfs {
                here: arrival.passed * rivals.ray,
                before: before.last().map_or(Vec4::ZERO, |corner| corner.pdf_rev),
            };
            let product = Vec4::splat(rivals.emitted / arrival.density);
            total += more(None, eye, product, ends, connects, self.camera_end());
        }
        self.radiance += arrival.prefix.beta * radiance / total;
    }

    /// All techniques that end at this corner of the camera's walk: light sampling, merging with photons, and
    /// connections with the corners of the light's walk.
    pub(super) fn connect(
        &mut self,
        corner: &Corner<'w, W>,
        eye: &[Corner<'w, W>],
        event: &BounceSamples,
    ) {
        if (self.only).is_some_and(|only| only.camera != eye.len() + 2) {
            return;
        }
        if self.connections() > 0.0 {
            self.sample_light(corner, eye, event);
        }
        self.merge(corner, eye);
        let Some(start) = self.start else {
            return;
        };
        for (index, light) in self.light.iter().enumerate() {
            let segments = corner.segments.saturating_add(light.segments);
            if segments < self.settings.max_depth && light.bsdf.has_continuous() {
                self.join(start, index, corner, eye);
            }
        }
    }

    /// Density per area of a walk from the light arriving at the vertex before `corner` on the camera's, having come
    /// to `corner` along `from`.
    pub(super) fn beyond(&self, corner: &Corner<'w, W>, eye: &[Corner<'w, W>], from: Vec3) -> Vec4 {
        // The camera itself is never arrived at.
        let Some(before) = eye.last() else {
            return Vec4::ZERO;
        };
        let density = corner.bsdf.density(from, corner.wo).lanes();
        let distance_squared = before
            .vertex
            .position
            .distance_squared(corner.vertex.position);
        density * corner.passed * before.per_area(corner.wo, distance_squared)
    }

    /// s = 1.
    fn sample_light(
        &mut self,
        corner: &Corner<'w, W>,
        eye: &[Corner<'w, W>],
        event: &BounceSamples,
    ) {
        let Some(mixed) = self.wanted(1, eye.len() + 2) else {
            return;
        };
        let (vertex, world) = (&corner.vertex, self.world);
        let mut from = corner.receiver();
        from.combined = mixed;
        let (choice, u) = (event.light_choice, event.light);
        let Some(light) = world.sample_light(&from, self.wavelengths, choice, u) else {
            return;
        };
        let direction = light.direction;
        let (value, scattered) =
            corner
                .bsdf
                .eval_and_density(corner.wo, direction, TransportMode::Radiance);
        let contribution = value * light.radiance;
        if contribution == Vec4::ZERO {
            return;
        }
        let Some(ray) = vertex.shadow_ray(direction, light.target) else {
            return;
        };
        let crossings = self.settings.max_depth - corner.segments - 1;
        let Some(passage) = world.transmittance(&ray, self.wavelengths, crossings) else {
            return;
        };
        let chance = light.chance.lanes();
        let inverse = 1.0 / chance.x;
        let rest = corner.prefix.r_u;
        let mut total = (rest * chance).element_sum() * inverse;
        let value = corner.prefix.beta * contribution * passage.transmittance * inverse;
        if !mixed {
            self.radiance += value / total;
            return;
        }
        if let SamplePdf::Continuous(_) = light.chance {
            let hits = scattered.lanes() * light.extinction * passage.probability;
            total += (rest * hits).element_sum() * inverse;
        }
        // From the density of light sampling to that of emission, in the same measure.
        let distance_squared = light
            .target
            .map_or(1.0, |target| target.distance_squared(vertex.position));
        let emission = match light.origin {
            // Points are chosen alike for either.
            LightKind::Medium => EmissionPdf {
                origin: chance.x / distance_squared,
                ray: EVENLY,
            },
            _ => world.emission_density(light.light, -direction, light.cos, vertex.time),
        };
        let origin = match light.origin {
            LightKind::Surface => emission.origin * distance_squared / light.cos,
            LightKind::Medium => emission.origin * distance_squared,
            _ => emission.origin,
        };
        // That of a light at infinity is 1, see above.
        let arrival = emission.ray * corner.per_area(direction, distance_squared);
        let ends = EndPdfs {
            here: passage.probability * arrival,
            before: self.beyond(corner, eye, direction),
        };
        let product = Vec4::splat(origin * inverse);
        total += more(Some(corner), eye, product, ends, true, self.camera_end());
        self.radiance += value / total;
    }

    /// s ≥ 2, t ≥ 2: the light walk's corner with this index, and the camera walk's.
    fn join(
        &mut self,
        start: &FromLight,
        index: usize,
        corner: &Corner<'w, W>,
        eye: &[Corner<'w, W>],
    ) {
        let light = &self.light[index];
        let Some(mixed) = self.wanted(self.vertices(index), eye.len() + 2) else {
            return;
        };
        let between = corner.vertex.position - light.vertex.position;
        let distance_squared = between.length_squared();
        if !(distance_squared > 0.0) {
            return;
        }
        let direction = between / distance_squared.sqrt();
        let (here, to_eye) =
            light
                .bsdf
                .eval_and_density(light.wo, direction, TransportMode::Importance);
        if here == Vec4::ZERO {
            return;
        }
        let (there, to_light) =
            corner
                .bsdf
                .eval_and_density(corner.wo, -direction, TransportMode::Radiance);
        let value = light.prefix.beta * here * there * corner.prefix.beta / distance_squared;
        if value == Vec4::ZERO {
            return;
        }
        let target = corner.vertex.origin_toward(light.vertex.position);
        let Some(ray) = light.vertex.shadow_ray(direction, Some(target)) else {
            return;
        };
        let crossings = self.settings.max_depth - corner.segments - light.segments - 1;
        let Some(passage) = self.world.transmittance(&ray, self.wavelengths, crossings) else {
            return;
        };
        let ends = EndPdfs {
            here: to_light.lanes()
                * passage.probability
                * light.per_area(direction, distance_squared),
            before: self.behind(start, light, direction),
        };
        let [mine, theirs] = [light.prefix.r_u, corner.prefix.r_u];
        let mut total = (mine * theirs).element_sum();
        if !mixed {
            self.radiance += value * passage.transmittance / total;
            return;
        }
        total += self.fewer(start, index, theirs, ends);
        let ends = EndPdfs {
            here: to_eye.lanes()
                * passage.probability
                * corner.per_area(direction, distance_squared),
            before: self.beyond(corner, eye, -direction),
        };
        total += more(Some(corner), eye, mine, ends, true, self.camera_end());
        self.radiance += value * passage.transmittance / total;
    }

    /// Density of a walk from the camera, come to `light` along `from`, arriving at the vertex before it on the
    /// light's walk.
    pub(super) fn behind(&self, start: &FromLight, light: &Corner<'w, W>, from: Vec3) -> Vec4 {
        let position = light.vertex.position;
        let per_area = match light.parent {
            None => start.per_area(start.distance_squared(position)),
            Some(parent) => {
                let before = &self.light[parent];
                let distance_squared = before.vertex.position.distance_squared(position);
                before.per_area(light.wo, distance_squared)
            }
        };
        light.bsdf.density(from, light.wo).lanes() * light.passed * per_area
    }

    pub(super) fn fewer(&self, start: &FromLight, last: usize, rest: Vec4, ends: EndPdfs) -> f32 {
        let mut first = last;
        while let Some(parent) = self.light[first].parent {
            first = parent;
        }
        let end = self.light_end(start, &self.light[first]);
        fewer(self.light, last, rest, ends, end, start.pdf_rev, true)
    }
}
