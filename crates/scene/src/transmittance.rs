//! Transmittance through null surfaces and media.

use crate::rays;
use crate::scene::Scene;
use etalon_geometry::Obstruction;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Hit, Media, Medium, Ray, ShadowQuery, ShapeId, Surfaces, Transmission, World,
};
use glam::Vec4;

impl Scene {
    /// Whether no light goes straight on through a shape; `false` also where that depends on its face.
    #[inline]
    fn is_opaque(&self, shape: ShapeId) -> bool {
        let material = self.parts.space.lookup.geometry.material_of(shape);
        material.is_some_and(|id| !self.parts.are_null[id.0 as usize])
    }

    /// Whether no light goes straight on at any surface.
    #[inline]
    pub(crate) fn any_surface_is_opaque(&self) -> bool {
        !self.parts.has_null && self.parts.space.media.bodies().is_none()
    }

    /// A segment through what fills the space, past nothing: any surface is opaque.
    #[inline]
    pub(crate) fn unoccluded_transmission(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
    ) -> Option<Transmission> {
        rays::count();
        if self.parts.space.lookup.geometry.occluded(ray) {
            return None;
        }
        self.free_transmission(ray, wavelengths)
    }

    /// The same of many segments: as many `transmissions` as `queries`.
    pub(crate) fn unoccluded_transmissions(
        &self,
        queries: &[ShadowQuery],
        transmissions: &mut [Option<Transmission>],
    ) {
        const AT_ONCE: usize = 128;
        rays::count_many(queries.len());
        let chunks = queries
            .chunks(AT_ONCE)
            .zip(transmissions.chunks_mut(AT_ONCE));
        for (queries, transmissions) in chunks {
            let occluded = &mut [false; AT_ONCE][..queries.len()];
            let geometry = &self.parts.space.lookup.geometry;
            geometry.occluded_batch(queries, |query| &query.ray, occluded);
            for ((query, transmission), occluded) in queries.iter().zip(transmissions).zip(occluded)
            {
                *transmission = match occluded {
                    true => None,
                    false => self.free_transmission(&query.ray, &query.wavelengths),
                };
            }
        }
    }

    /// A segment through what fills the space, with nothing in the way.
    #[inline]
    fn free_transmission(&self, ray: &Ray, wavelengths: &Wavelengths) -> Option<Transmission> {
        let mut transmission = Transmission::FREE;
        self.fill(&mut transmission, ray, ray.t_max, wavelengths);
        (transmission.transmittance != Vec4::ZERO).then_some(transmission)
    }

    /// Multiplies by the transmittance of the ray's medium up to `t_max`.
    #[inline]
    fn fill(
        &self,
        transmission: &mut Transmission,
        ray: &Ray,
        t_max: f32,
        wavelengths: &Wavelengths,
    ) {
        if ray.medium.is_some()
            && let Some(medium) = self.media().enter(ray.medium, None, wavelengths)
        {
            transmission.then(&medium.transmittance(ray, t_max, &mut ray.stream(0.0)));
        }
    }

    /// A segment past surfaces of which some let light go straight on: most segments meet none of these, or end at another.
    pub(crate) fn transmission_past_null_surfaces(
        &self,
        ray: &Ray,
        wavelengths: &Wavelengths,
        crossings: u32,
    ) -> Option<Transmission> {
        if self.parts.space.media.bodies().is_none() {
            rays::count();
            let geometry = &self.parts.space.lookup.geometry;
            match geometry.obstruction(ray, |shape| self.is_opaque(shape)) {
                Obstruction::Nothing => return self.free_transmission(ray, wavelengths),
                Obstruction::Opaque => return None,
                Obstruction::Passable => (),
            }
        }
        self.transmission_from_surface_to_surface(*ray, wavelengths, crossings)
    }

    /// A segment through null surfaces, intersected one after the other.
    fn transmission_from_surface_to_surface(
        &self,
        segment: Ray,
        wavelengths: &Wavelengths,
        mut crossings: u32,
    ) -> Option<Transmission> {
        let opaque =
            |hit: Hit| self.is_opaque(hit.shape) && self.parts.space.media.bodies().is_none();
        let mut ray = segment;
        let mut transmission = Transmission::FREE;
        loop {
            let hit = self.surfaces().intersect(&ray);
            if hit.is_some_and(|hit| crossings == 0 || opaque(hit)) {
                return None;
            }
            let t = hit.map_or(ray.t_max, |hit| hit.t);
            self.fill(&mut transmission, &ray, t, wavelengths);
            if transmission.transmittance == Vec4::ZERO {
                return None;
            }
            let Some(hit) = hit else { break };
            crossings -= 1;
            let vertex = self.surfaces().vertex(&ray, &hit);
            let bsdf = self.surfaces().bsdf(&vertex, -ray.direction, wavelengths);
            transmission.then(&Transmission {
                transmittance: bsdf.null_transmittance(),
                probability: bsdf.null_probability(),
            });
            if transmission.transmittance == Vec4::ZERO {
                return None;
            }
            let Some(rest) = vertex.rest_of(&segment) else {
                break;
            };
            ray = rest;
        }
        Some(transmission)
    }
}
