//! Straight travel past what lets light pass.

use crate::scene::Scene;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, Medium, Ray, Transmission, World};
use glam::Vec4;

impl Scene {
    /// A segment through surfaces that let light pass: each is met in turn and asked how much.
    pub(crate) fn passage_through(
        &self,
        mut ray: Ray,
        wavelengths: &Wavelengths,
        mut crossings: u32,
    ) -> Option<Transmission> {
        let end = ray.t_max;
        let origin = ray.origin;
        let mut passage = Transmission::FREE;
        loop {
            let hit = self.intersect(&ray);
            if ray.medium.is_some()
                && let Some(medium) = self.medium(ray.medium, wavelengths)
            {
                let t = hit.map_or(ray.t_max, |hit| hit.t);
                passage.then(&medium.transmittance(&ray, t, &mut ray.stream(0.0)));
                if passage.transmittance == Vec4::ZERO {
                    return None;
                }
            }
            let Some(hit) = hit else { break };
            if crossings == 0 {
                return None;
            }
            crossings -= 1;
            let vertex = self.vertex(&ray, &hit);
            if !self.material(&vertex).has_null() && self.media().bodies().is_none() {
                return None;
            }
            let bsdf = self.bsdf(&vertex, -ray.direction, wavelengths);
            passage.then(&Transmission {
                transmittance: bsdf.null_transmittance(),
                probability: bsdf.null_probability(),
            });
            if passage.transmittance == Vec4::ZERO {
                return None;
            }
            ray = Ray {
                t_max: f32::INFINITY,
                ..vertex.spawn(ray.direction)
            };
            if end.is_finite() {
                // What is left of the segment, measured from where the ray goes on.
                ray.t_max = end - (ray.origin - origin).dot(ray.direction);
                if !(ray.t_max > 0.0) {
                    break;
                }
            }
        }
        Some(passage)
    }
}
