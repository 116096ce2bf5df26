//! Direct light.

use super::packet::{Packet, SETS};
use super::surface::{Surface, SurfaceBySet};
use super::{Falloff, Whitted};
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, LegacyPhong, LightId, LightSample, LightSampleContext, Lights, Ray, SurfaceInteraction,
    Surfaces, World,
};
use glam::{Vec3, Vec4};

impl Whitted {
    /// The light of all lamps that the surface shows toward `wo`. Shadow rays may pass as many
    /// surfaces straight as `crossings`.
    #[inline(never)] // Its tables need not stay on the stack while rays go on.
    pub(super) fn direct<W: World>(
        &self,
        world: &W,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        (packets, surfaces): (&[Packet], &SurfaceBySet<'_, W>),
        crossings: u32,
        sampler: &mut impl Sampler,
    ) -> Vec3 {
        let from = match &surfaces[0] {
            Some(Surface::Scattering(bsdf)) => LightSampleContext::new(vertex, wo, bsdf),
            _ => LightSampleContext::on_surface(vertex.position, vertex.shading.n).at(vertex.time),
        };
        let mut sum = Vec3::ZERO;
        for light in (0..world.lights().count()).map(LightId) {
            for point in 0..self.light_points.count() {
                let place = self.light_points.point(point, sampler);
                let sample = |wavelengths: &Wavelengths| {
                    world.lights().sample_one(light, &from, wavelengths, place)
                };
                let Some(first) = sample(&packets[0].wavelengths) else {
                    continue;
                };
                let share = if first.chance.is_delta() {
                    1.0
                } else {
                    1.0 / self.light_points.count() as f32
                };
                let mut shown = [Vec4::ZERO; SETS];
                for ((shown, packet), surface) in shown.iter_mut().zip(packets).zip(surfaces) {
                    let (Some(surface), Some(lamp)) = (surface, sample(&packet.wavelengths)) else {
                        continue;
                    };
                    let scattered = surface.shade(vertex, wo, lamp.direction);
                    if scattered != Vec4::ZERO {
                        *shown =
                            scattered * self.irradiance(&from, &lamp) * (packet.weight * share);
                    }
                }
                if shown.iter().all(|&shown| shown == Vec4::ZERO) {
                    continue;
                }
                let ray = vertex.shadow_ray(first.direction, first.target);
                if let Some(arrives) =
                    ray.and_then(|ray| self.reach(world, ray, packets, crossings))
                {
                    for ((packet, shown), arrives) in packets.iter().zip(shown).zip(arrives) {
                        sum += packet.response.rgb(shown * arrives);
                    }
                }
                if first.chance.is_delta() {
                    break;
                }
            }
        }
        sum
    }

    /// The irradiance on a surface that faces the lamp.
    fn irradiance(&self, from: &LightSampleContext, lamp: &LightSample) -> Vec4 {
        let irradiance = lamp.radiance / lamp.chance.lanes().x;
        match (self.falloff, lamp.target) {
            (Falloff::None, Some(target)) if lamp.chance.is_delta() => {
                irradiance * target.distance_squared(from.position)
            }
            _ => irradiance,
        }
    }

    /// The fraction of light that travels a segment, for each packet; `None` if none does.
    fn reach<W: World>(
        &self,
        world: &W,
        segment: Ray,
        packets: &[Packet],
        mut crossings: u32,
    ) -> Option<[Vec4; SETS]> {
        let mut ray = segment;
        let mut fractions = [Vec4::ONE; SETS];
        // With photons, refracted light is accounted for where it really arrives.
        let passes = |material: &LegacyPhong| match self.caustics.photons {
            0 => material.transparency,
            _ => 0.0,
        };
        while let Some(hit) = world.surfaces().intersect(&ray) {
            crossings = crossings.checked_sub(1)?;
            let vertex = world.surfaces().vertex(&ray, &hit);
            let wo = -ray.direction;
            let mut any = false;
            for (fraction, packet) in fractions.iter_mut().zip(packets) {
                *fraction *= match world
                    .surfaces()
                    .legacy_phong(&vertex, wo, &packet.wavelengths)
                {
                    Some(material) => {
                        Vec4::splat(1.0 - material.opacity * (1.0 - passes(&material)))
                    }
                    None => world
                        .surfaces()
                        .bsdf(&vertex, wo, &packet.wavelengths)
                        .null_transmittance(),
                };
                any |= *fraction != Vec4::ZERO;
            }
            if !any {
                return None;
            }
            let Some(rest) = vertex.rest_of(&segment) else {
                break;
            };
            ray = rest;
        }
        Some(fractions)
    }
}
