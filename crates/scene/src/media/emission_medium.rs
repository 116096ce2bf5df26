//! The medium that a particle travels in when it leaves a light.
//!
//! It is given by the media of the light's shape, or named by the light. Otherwise it is the medium on this side
//! of the first boundary along the particle's ray.

use crate::space::Space;
use etalon_transport::{Camera, Emission, MediumId, Ray};
use glam::Vec2;

/// The most surfaces that are looked through.
const PASSED: u32 = 1 << 10;

impl Space {
    /// The medium of a particle; `None` if it comes from infinity through a medium without end.
    pub(crate) fn medium_of_emission(
        &self,
        emission: &Emission,
        outermost: MediumId,
    ) -> Option<MediumId> {
        let media = &self.media;
        if emission.origin.is_infinite() {
            return (!media.is_endless(outermost)).then_some(outermost);
        }
        let direction = emission.ray.direction;
        if let Some(own) = media.of_light(emission.light) {
            let named = own.toward(direction.dot(emission.point.normal));
            let body = self.body_filled_with(named, emission.ray, outermost);
            return Some(body.unwrap_or(named));
        }
        Some(self.medium_along(emission.ray, outermost))
    }

    /// The bodies at the origin of a ray, if the one that fills it is filled with a medium that a camera or a light there names.
    fn body_filled_with(&self, named: MediumId, ray: Ray, beyond: MediumId) -> Option<MediumId> {
        let bodies = self.media.bodies()?;
        let set = self.medium_along(ray, beyond);
        let filling = bodies.filling(set);
        (filling.body.is_some() && filling.medium == named).then_some(set)
    }

    /// The medium on this side of the first boundary on a ray's way, with the bodies that the ray leaves without having entered
    /// them. Without a boundary it is the one `beyond` everything.
    pub(crate) fn medium_along(&self, mut ray: Ray, beyond: MediumId) -> MediumId {
        let bodies = self.media.bodies();
        let (mut around, mut entered, mut left) = (MediumId::NONE, Vec::new(), Vec::new());
        for _ in 0..PASSED {
            let Some(hit) = self.intersect(&ray) else {
                around = beyond;
                break;
            };
            let vertex = self.vertex(&ray, &hit);
            let outward = ray.direction.dot(vertex.normal);
            if let Some(boundary) = self.media.of_shape(hit.shape) {
                around = boundary.toward(-outward);
                break;
            }
            if let Some(kind) = bodies.and_then(|bodies| bodies.of_shape(hit.shape)) {
                let before = entered.iter().position(|other| *other == kind);
                match before {
                    _ if outward < 0.0 => entered.push(kind),
                    Some(before) => drop(entered.swap_remove(before)),
                    None => left.push(kind),
                }
            }
            ray = vertex.spawn(ray.direction);
        }
        let into = |set, kind| bodies.map_or(set, |bodies| bodies.after(set, kind, true));
        left.into_iter().fold(around, into)
    }

    /// The medium that the camera is in, with the bodies that it is in.
    pub(crate) fn camera_medium(&self, camera: &impl Camera) -> MediumId {
        let named = self.media.camera;
        if self.media.bodies().is_none() {
            return named;
        }
        let start = camera.ray(Vec2::splat(0.5), Vec2::splat(0.5), 0.0);
        // A medium that fills the camera's body is not the medium around all bodies.
        let body = self.body_filled_with(named, start.ray, MediumId::NONE);
        body.unwrap_or_else(|| self.medium_along(start.ray, named))
    }

    /// The medium beyond everything: where a ray from the camera ends that goes straight on.
    pub(crate) fn outermost(&self, camera: &impl Camera, camera_medium: MediumId) -> MediumId {
        let start = camera.ray(Vec2::splat(0.5), Vec2::splat(0.5), 0.0);
        let mut ray = Ray {
            medium: camera_medium,
            ..start.ray
        };
        for _ in 0..PASSED {
            let Some(hit) = self.intersect(&ray) else {
                break;
            };
            ray = self.vertex(&ray, &hit).spawn(ray.direction);
        }
        ray.medium
    }
}
