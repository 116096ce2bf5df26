//! t = 1: the corners of a light's walk, as the camera sees them.

use super::connect::Connector;
use super::from_light::FromLight;
use super::pdf_ratios::EndPdfs;
use crate::steps::visibility::camera_visibility;
use etalon_transport::{Bsdf, Camera, TransportMode, World};
use glam::{Vec2, Vec4};

impl<W: World> Connector<'_, '_, W> {
    /// Every corner of the light's walk, seen by the camera.
    pub(super) fn see_all(&self, mut splat: impl FnMut(Vec2, Vec4)) {
        let Some(start) = self.start.filter(|_| self.site.pixels > 0) else {
            return;
        };
        for (index, light) in self.light.iter().enumerate() {
            if !light.bsdf.has_continuous() || light.segments >= self.settings.max_depth {
                continue;
            }
            if let Some((raster, value)) = self.see(start, index, self.lens) {
                splat(raster, value);
            }
        }
    }

    /// A corner of the light's walk as the camera sees it.
    fn see(&self, start: &FromLight, index: usize, lens: Vec2) -> Option<(Vec2, Vec4)> {
        let light = &self.light[index];
        let mixed = self.wanted(self.vertices(index), 1)?;
        let vertex = &light.vertex;
        let (camera, margin) = (self.world.camera(), self.site.margin);
        let connection = camera.connect(vertex.position, lens, vertex.time, margin)?;
        let direction = connection.direction;
        let value = light
            .bsdf
            .eval(light.wo, direction, TransportMode::Importance);
        if value == Vec4::ZERO {
            return None;
        }
        let ray = vertex.shadow_ray(direction, Some(connection.target))?;
        let crossings = self.settings.max_depth - light.segments - 1;
        let passage = if self.settings.hide_emitters {
            let on_light = light.vertex.light.is_some();
            let way = camera_visibility(self.world, self.wavelengths, ray, on_light, crossings)?;
            // Past a light that it looks through, the camera's walk finds the corner alone.
            Some(way.passage).filter(|_| !way.through_emitter)?
        } else {
            self.world
                .transmittance(&ray, self.wavelengths, crossings)?
        };
        // The camera's weight is per area across the ray, at any distance.
        let ends = EndPdfs {
            here: passage.probability * connection.weight * light.per_area(direction, 1.0),
            before: self.behind(start, light, direction),
        };
        let samples = self.site.pixels as f32;
        let mut total = samples * light.prefix.r_u.element_sum();
        if mixed {
            total += self.fewer(start, index, Vec4::ONE, ends);
        }
        let value = light.prefix.beta * value * passage.transmittance * connection.weight;
        Some((connection.raster, value / total))
    }
}
