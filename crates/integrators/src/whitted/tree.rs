//! The tree of rays that starts with one through a point of the film.
//!
//! A ray carries all wavelengths, in packets of four, until a dispersive interface separates them;
//! then every wavelength continues alone.

use super::caustics::Caustics;
use super::onward::onward;
use super::packet::{Packet, SETS};
use super::{Whitted, surface};
use crate::photons::kdtree::Neighbour;
use crate::steps::arrival::next_surface;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Camera, Lights, Ray, SurfaceInteraction, Surfaces, TransportMode, World,
};
use glam::{Vec2, Vec3, Vec4};
use std::cell::RefCell;

/// The environment of a tree of rays.
pub(super) struct Tree<'a, W> {
    pub(super) world: &'a W,
    pub(super) caustics: Option<&'a Caustics>,
    /// Room for the photons that a look-up finds.
    pub(super) neighbours: &'a RefCell<Vec<Neighbour>>,
}

impl Whitted {
    /// Colour and alpha seen through a point of the film.
    pub(super) fn through<W: World>(
        &self,
        tree: &Tree<'_, W>,
        packets: &[Packet],
        raster: Vec2,
        sampler: &mut impl Sampler,
    ) -> Vec4 {
        if self.max_depth == 0 {
            return Vec4::ZERO;
        }
        let world = tree.world;
        let mut sum = Vec4::ZERO;
        for point in 0..self.lens_points.count() {
            let lens = self.lens_points.point(point, sampler);
            // The shutter only opens.
            let start = world.camera().ray(raster, lens, world.moment(raster, 0.0));
            let rgb = self.follow(tree, start.ray, packets, 1, sampler);
            let alpha = self.alpha(world, start.ray, &packets[0].wavelengths);
            sum += (rgb * start.weight).extend(alpha);
        }
        sum / self.lens_points.count() as f32
    }

    /// The radiance along a ray, the last of `depth` segments.
    fn follow<W: World>(
        &self,
        tree: &Tree<'_, W>,
        mut ray: Ray,
        packets: &[Packet],
        depth: u32,
        sampler: &mut impl Sampler,
    ) -> Vec3 {
        let world = tree.world;
        let hidden = self.hide_emitters && depth == 1;
        let Some((hit, vertex)) = next_surface(world, &mut ray, hidden) else {
            return Vec3::ZERO;
        };
        let wo = -ray.direction;
        let mut sum = Vec3::ZERO;
        for packet in packets {
            let mut radiance = Vec4::ZERO;
            if world.lights().is_emitter(&hit) {
                radiance += world.lights().emitted(&vertex, wo, &packet.wavelengths);
            }
            if let Some(material) = world
                .surfaces()
                .legacy_phong(&vertex, wo, &packet.wavelengths)
            {
                let own = (1.0 - material.transparency) * material.opacity;
                radiance += material.ambient * (self.ambient * own);
            }
            sum += packet.response.rgb(radiance * packet.weight);
        }
        if depth == self.max_depth {
            return sum;
        }
        sum += self.lit(tree, &vertex, wo, packets, depth, sampler);
        sum + self.branch(tree, &vertex, wo, packets, depth + 1, sampler)
    }

    /// Direct light and caustics at a surface `depth` segments from the camera.
    #[inline(never)] // Its tables need not stay on the stack while rays go on.
    fn lit<W: World>(
        &self,
        tree: &Tree<'_, W>,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        packets: &[Packet],
        depth: u32,
        sampler: &mut impl Sampler,
    ) -> Vec3 {
        let surfaces = surface::at(tree.world, vertex, wo, packets);
        let lies = (packets, &surfaces);
        let crossings = self.max_depth - depth - 1;
        let straight = self.direct(tree.world, vertex, wo, lies, crossings, sampler);
        let depths = [depth, self.max_depth];
        let caustics = tree.caustics.map(|caustics| {
            let found = &mut tree.neighbours.borrow_mut();
            caustics.seen::<W>(vertex, wo, lies, depths, found)
        });
        straight + caustics.unwrap_or(Vec3::ZERO)
    }

    /// The radiance from the discrete directions of a smooth surface.
    fn branch<W: World>(
        &self,
        tree: &Tree<'_, W>,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        packets: &[Packet],
        depth: u32,
        sampler: &mut impl Sampler,
    ) -> Vec3 {
        let world = tree.world;
        let mut sum = Vec3::ZERO;
        let mut group = [packets[0]; SETS];
        for index in 0.. {
            let mut found = false;
            let (mut count, mut way) = (0, Vec3::ZERO);
            for packet in packets {
                let at = |packet: &Packet| {
                    let lanes = (&packet.wavelengths, TransportMode::Radiance);
                    onward(world, vertex, wo, lanes, index)
                };
                let Some(whole) = at(packet) else {
                    continue;
                };
                found = true;
                let weight = packet.weight * whole.value;
                if weight != Vec4::ZERO {
                    if count > 0 && way != whole.wi {
                        sum +=
                            self.follow(tree, vertex.spawn(way), &group[..count], depth, sampler);
                        count = 0;
                    }
                    way = whole.wi;
                    group[count] = Packet { weight, ..*packet };
                    count += 1;
                }
                // Lane 0 chose; lanes with another direction are evaluated one by one.
                for lane in (1..4).filter(|&k| packet.weight[k] != 0.0 && whole.together[k] == 0.0)
                {
                    let alone = packet.alone(lane);
                    let Some(own) = at(&alone).filter(|own| own.value.x != 0.0) else {
                        continue;
                    };
                    let weight = alone.weight * own.value.x;
                    let alone = Packet { weight, ..alone };
                    sum += self.follow(tree, vertex.spawn(own.wi), &[alone], depth, sampler);
                }
            }
            if !found {
                break;
            }
            if count > 0 {
                sum += self.follow(tree, vertex.spawn(way), &group[..count], depth, sampler);
            }
        }
        sum
    }

    /// Opacity along a ray, through null interactions.
    fn alpha<W: World>(&self, world: &W, mut ray: Ray, wavelengths: &Wavelengths) -> f32 {
        let mut open = 1.0;
        let mut segment = 1;
        while segment <= self.max_depth {
            let hidden = self.hide_emitters && segment == 1;
            let Some((_, vertex)) = next_surface(world, &mut ray, hidden) else {
                return 1.0 - open;
            };
            let wo = -ray.direction;
            open *= match world.surfaces().legacy_phong(&vertex, wo, wavelengths) {
                Some(material) => 1.0 - material.opacity,
                None => {
                    let bsdf = world.surfaces().bsdf(&vertex, wo, wavelengths);
                    0.25 * bsdf.null_probability().element_sum()
                }
            };
            segment += 1;
            if open == 0.0 {
                break;
            }
            ray = vertex.spawn(ray.direction);
        }
        1.0 - open
    }
}
