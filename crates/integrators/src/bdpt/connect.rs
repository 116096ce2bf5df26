//! The techniques: their contributions and their MIS weights.

use super::from_light::FromLight;
use super::merging::Merging;
use super::path_vertex::SubpathVertex;
use super::pdf_ratios::{CameraEnd, EndPdfs, LightEnd, pdf_ratios_fewer, pdf_ratios_more};
use super::technique::Technique;
use crate::steps::dimensions::BounceSamples;
use crate::steps::settings::PathSettings;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Camera, EmissionPdf, LightKind, PixelSample, SamplePdf, SurfaceInteraction,
    TransportMode, World,
};
use glam::{Vec2, Vec3, Vec4};

/// The density of the directions in which particles leave a medium (sr⁻¹).
pub(super) const EVENLY: f32 = 0.25 * core::f32::consts::FRAC_1_PI;

/// Connects the vertices of one sample's subpaths.
pub(super) struct Connector<'a, 'w, W: World> {
    pub(super) world: &'w W,
    pub(super) wavelengths: &'a Wavelengths,
    pub(super) settings: &'a PathSettings,
    /// The only technique to evaluate, if not all.
    pub(super) only: Option<Technique>,
    pub(super) site: &'a PixelSample,
    /// The aperture position of the camera subpath.
    pub(super) lens: Vec2,
    /// The light subpath, if anything was emitted.
    pub(super) start: Option<&'a FromLight>,
    pub(super) light_subpath: &'a [SubpathVertex<'w, W>],
    /// Whether the camera subpath's first vertex can be connected to the camera.
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
    pub(super) fn vertex_count(&self, index: usize) -> usize {
        let parents = |vertex: &usize| self.light_subpath[*vertex].parent;
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

    fn light_end(&self, start: &FromLight, first: &SubpathVertex<'w, W>) -> LightEnd {
        LightEnd {
            can_be_hit: start.emission.origin.can_be_hit(),
            emitted: start.emission.density.origin,
            sampled: first.direct,
            merging: self.area(),
            connections: self.connections(),
        }
    }

    /// All techniques that end at this vertex of the camera subpath: light sampling, merging with photons, and
    /// connections with the vertices of the light subpath.
    pub(super) fn connect(
        &mut self,
        vertex: &SubpathVertex<'w, W>,
        camera: &[SubpathVertex<'w, W>],
        event: &BounceSamples,
    ) {
        if (self.only).is_some_and(|only| only.camera != camera.len() + 2) {
            return;
        }
        if self.connections() > 0.0 {
            self.sample_light(vertex, camera, event);
        }
        self.merge(vertex, camera);
        let Some(start) = self.start else {
            return;
        };
        for (index, light) in self.light_subpath.iter().enumerate() {
            let segments = vertex.segments.saturating_add(light.segments);
            if segments < self.settings.max_depth && light.bsdf.has_continuous() {
                self.connect_vertices(start, index, vertex, camera);
            }
        }
    }

    /// Density per area of a subpath from the light arriving at the vertex before `vertex` on the camera's, having come
    /// to `vertex` along `from`.
    pub(super) fn camera_reverse_pdf(
        &self,
        vertex: &SubpathVertex<'w, W>,
        camera: &[SubpathVertex<'w, W>],
        from: Vec3,
    ) -> Vec4 {
        // The camera itself is never arrived at.
        let Some(before) = camera.last() else {
            return Vec4::ZERO;
        };
        let density = vertex.bsdf.density(from, vertex.wo).lanes();
        let distance_squared = before
            .point
            .position
            .distance_squared(vertex.point.position);
        density * vertex.passed * before.per_area(vertex.wo, distance_squared)
    }

    /// s = 1.
    fn sample_light(
        &mut self,
        vertex: &SubpathVertex<'w, W>,
        camera: &[SubpathVertex<'w, W>],
        event: &BounceSamples,
    ) {
        let Some(weighted) = self.wanted(1, camera.len() + 2) else {
            return;
        };
        let (point, world) = (&vertex.point, self.world);
        let mut from = vertex.receiver();
        from.combined = weighted;
        let (choice, u) = (event.light_choice, event.light);
        let Some(light) = world.sample_light(&from, self.wavelengths, choice, u) else {
            return;
        };
        let direction = light.direction;
        let (value, scattered) =
            vertex
                .bsdf
                .eval_and_density(vertex.wo, direction, TransportMode::Radiance);
        let contribution = value * light.radiance;
        if contribution == Vec4::ZERO {
            return;
        }
        let Some(ray) = point.shadow_ray(direction, light.target) else {
            return;
        };
        let crossings = self.settings.max_depth - vertex.segments - 1;
        let Some(transmission) = world.transmittance(&ray, self.wavelengths, crossings) else {
            return;
        };
        let chance = light.chance.lanes();
        let inverse = 1.0 / chance.x;
        let rest = vertex.throughput.r_u;
        let mut total = (rest * chance).element_sum() * inverse;
        let value = vertex.throughput.beta * contribution * transmission.transmittance * inverse;
        if !weighted {
            self.radiance += value / total;
            return;
        }
        if let SamplePdf::Continuous(_) = light.chance {
            let hits = scattered.lanes() * light.extinction * transmission.probability;
            total += (rest * hits).element_sum() * inverse;
        }
        // From the density of light sampling to that of emission, in the same measure.
        let distance_squared = light
            .target
            .map_or(1.0, |target| target.distance_squared(point.position));
        let emission = match light.origin {
            // Points are chosen alike for either.
            LightKind::Medium => EmissionPdf {
                origin: chance.x / distance_squared,
                ray: EVENLY,
            },
            _ => world.emission_density(light.light, -direction, light.cos, point.time),
        };
        let origin = match light.origin {
            LightKind::Surface => emission.origin * distance_squared / light.cos,
            LightKind::Medium => emission.origin * distance_squared,
            _ => emission.origin,
        };
        // That of a light at infinity is 1, see above.
        let arrival = emission.ray * vertex.per_area(direction, distance_squared);
        let ends = EndPdfs {
            here: transmission.probability * arrival,
            before: self.camera_reverse_pdf(vertex, camera, direction),
        };
        let product = Vec4::splat(origin * inverse);
        total += pdf_ratios_more(Some(vertex), camera, product, ends, true, self.camera_end());
        self.radiance += value / total;
    }

    /// s ≥ 2, t ≥ 2: the light subpath's vertex with this index, and the camera subpath's.
    fn connect_vertices(
        &mut self,
        start: &FromLight,
        index: usize,
        vertex: &SubpathVertex<'w, W>,
        camera: &[SubpathVertex<'w, W>],
    ) {
        let light = &self.light_subpath[index];
        let Some(weighted) = self.wanted(self.vertex_count(index), camera.len() + 2) else {
            return;
        };
        let between = vertex.point.position - light.point.position;
        let distance_squared = between.length_squared();
        if !(distance_squared > 0.0) {
            return;
        }
        let direction = between / distance_squared.sqrt();
        let (here, to_camera) =
            light
                .bsdf
                .eval_and_density(light.wo, direction, TransportMode::Importance);
        if here == Vec4::ZERO {
            return;
        }
        let (there, to_light) =
            vertex
                .bsdf
                .eval_and_density(vertex.wo, -direction, TransportMode::Radiance);
        let value =
            light.throughput.beta * here * there * vertex.throughput.beta / distance_squared;
        if value == Vec4::ZERO {
            return;
        }
        let target = vertex.point.origin_toward(light.point.position);
        let Some(ray) = light.point.shadow_ray(direction, Some(target)) else {
            return;
        };
        let crossings = self.settings.max_depth - vertex.segments - light.segments - 1;
        let Some(transmission) = self.world.transmittance(&ray, self.wavelengths, crossings) else {
            return;
        };
        let ends = EndPdfs {
            here: to_light.lanes()
                * transmission.probability
                * light.per_area(direction, distance_squared),
            before: self.light_reverse_pdf(start, light, direction),
        };
        let [mine, theirs] = [light.throughput.r_u, vertex.throughput.r_u];
        let mut total = (mine * theirs).element_sum();
        if !weighted {
            self.radiance += value * transmission.transmittance / total;
            return;
        }
        total += self.pdf_ratios_fewer(start, index, theirs, ends);
        let ends = EndPdfs {
            here: to_camera.lanes()
                * transmission.probability
                * vertex.per_area(direction, distance_squared),
            before: self.camera_reverse_pdf(vertex, camera, -direction),
        };
        total += pdf_ratios_more(Some(vertex), camera, mine, ends, true, self.camera_end());
        self.radiance += value * transmission.transmittance / total;
    }

    /// Density of a subpath from the camera, come to `light` along `from`, arriving at the vertex before it on the
    /// light subpath.
    pub(super) fn light_reverse_pdf(
        &self,
        start: &FromLight,
        light: &SubpathVertex<'w, W>,
        from: Vec3,
    ) -> Vec4 {
        let position = light.point.position;
        let per_area = match light.parent {
            None => start.per_area(start.distance_squared(position)),
            Some(parent) => {
                let before = &self.light_subpath[parent];
                let distance_squared = before.point.position.distance_squared(position);
                before.per_area(light.wo, distance_squared)
            }
        };
        light.bsdf.density(from, light.wo).lanes() * light.passed * per_area
    }

    pub(super) fn pdf_ratios_fewer(
        &self,
        start: &FromLight,
        last: usize,
        rest: Vec4,
        ends: EndPdfs,
    ) -> f32 {
        let mut first = last;
        while let Some(parent) = self.light_subpath[first].parent {
            first = parent;
        }
        let end = self.light_end(start, &self.light_subpath[first]);
        pdf_ratios_fewer(
            self.light_subpath,
            last,
            rest,
            ends,
            end,
            start.pdf_rev,
            true,
        )
    }
}
