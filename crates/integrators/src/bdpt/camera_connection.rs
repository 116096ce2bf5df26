//! t = 1: the vertices of a light subpath, as the camera sees them.

use super::connect::Connector;
use super::from_light::FromLight;
use super::pdf_ratios::EndPdfs;
use crate::steps::visibility::camera_visibility;
use etalon_transport::{Bsdf, Camera, TransportMode, World};
use glam::{Vec2, Vec4};

impl<W: World> Connector<'_, '_, W> {
    /// Every vertex of the light subpath, seen by the camera.
    pub(super) fn connect_to_camera(&self, mut splat: impl FnMut(Vec2, Vec4)) {
        let Some(start) = self.start.filter(|_| self.site.pixels > 0) else {
            return;
        };
        for (index, light) in self.light_subpath.iter().enumerate() {
            if !light.bsdf.has_continuous() || light.segments >= self.settings.max_depth {
                continue;
            }
            if let Some((raster, value)) = self.connect_vertex_to_camera(start, index, self.lens) {
                splat(raster, value);
            }
        }
    }

    /// A vertex of the light subpath as the camera sees it.
    fn connect_vertex_to_camera(
        &self,
        start: &FromLight,
        index: usize,
        lens: Vec2,
    ) -> Option<(Vec2, Vec4)> {
        let light = &self.light_subpath[index];
        let weighted = self.wanted(self.vertex_count(index), 1)?;
        let point = &light.point;
        let (camera, margin) = (self.world.camera(), self.site.margin);
        let connection = camera.connect(point.position, lens, point.time, margin)?;
        let direction = connection.direction;
        let value = light
            .bsdf
            .eval(light.wo, direction, TransportMode::Importance);
        if value == Vec4::ZERO {
            return None;
        }
        let ray = point.shadow_ray(direction, Some(connection.target))?;
        let crossings = self.settings.max_depth - light.segments - 1;
        let transmission = if self.settings.hide_emitters {
            let on_light = light.point.light.is_some();
            let way = camera_visibility(self.world, self.wavelengths, ray, on_light, crossings)?;
            // Past a light that it looks through, the camera subpath finds the vertex alone.
            Some(way.transmission).filter(|_| !way.through_emitter)?
        } else {
            self.world
                .transmittance(&ray, self.wavelengths, crossings)?
        };
        // The camera's weight is per area across the ray, at any distance.
        let ends = EndPdfs {
            here: transmission.probability * connection.weight * light.per_area(direction, 1.0),
            before: self.light_reverse_pdf(start, light, direction),
        };
        let samples = self.site.pixels as f32;
        let mut total = samples * light.throughput.r_u.element_sum();
        if weighted {
            total += self.pdf_ratios_fewer(start, index, Vec4::ONE, ends);
        }
        let value = light.throughput.beta * value * transmission.transmittance * connection.weight;
        Some((connection.raster, value / total))
    }
}
