//! The tree of rays that starts with one through a point of the film.
//!
//! A ray carries all wavelengths at once, four to a packet, as long as they go the same way. Where
//! a dispersive interface parts them, every wavelength goes on alone.

use super::{Whitted, phong};
use crate::steps::next_surface;
use etalon_spectrum::{QuadratureNode, SensorWeights, Wavelengths};
use etalon_transport::{Bsdf, Camera, Ray, SurfaceInteraction, TransportMode, World};
use glam::{Vec2, Vec3, Vec4};

/// The most packets.
pub(super) const SETS: usize = super::MOST_WAVELENGTHS as usize / 4;

/// Four wavelengths on their way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packet {
    pub(super) wavelengths: Wavelengths,
    pub(super) response: SensorWeights,
    /// What radiance counts, per lane.
    pub(super) weight: Vec4,
}

impl Packet {
    /// The packet in which lane `k` chooses, and is alone.
    fn alone(&self, k: usize) -> Self {
        let lane = |channel: Vec4| Vec4::X * channel[k];
        let SensorWeights { r, g, b } = self.response;
        Self {
            response: SensorWeights {
                r: lane(r),
                g: lane(g),
                b: lane(b),
            },
            weight: Vec4::X * self.weight[k],
            wavelengths: self.wavelengths.rotated(k),
        }
    }
}

/// The packets of `count` nodes, at most [`SETS`].
pub(super) fn packets<W: World>(world: &W, count: u32) -> Vec<Packet> {
    let nodes = QuadratureNode::all(count, |u| world.wavelengths(u), |w| world.sensor(w));
    let weight = Vec4::splat(1.0 / (4 * count) as f32);
    nodes
        .map(|node| Packet {
            wavelengths: node.wavelengths,
            response: node.response,
            weight,
        })
        .collect()
}

/// A ray that leaves a surface in a direction of its own.
#[derive(Clone, Copy, Debug)]
pub struct Continuation {
    /// Its direction.
    pub wi: Vec3,
    /// What the radiance along it counts, per lane; zero for lanes that go elsewhere than lane 0.
    pub value: Vec4,
    /// Zero for lanes that go elsewhere, or nowhere.
    pub together: Vec4,
}

impl Whitted {
    /// Colour and alpha seen through a point of the film.
    pub(super) fn through<W: World>(&self, world: &W, packets: &[Packet], raster: Vec2) -> Vec4 {
        if self.max_depth == 0 {
            return Vec4::ZERO;
        }
        // A lens is looked through in its middle, and its shutter only opens.
        let start = world.camera().ray(raster, Vec2::splat(0.5), 0.0);
        let rgb = self.follow(world, start.ray, packets, 1);
        let alpha = self.alpha(world, start.ray, &packets[0].wavelengths);
        (rgb * start.weight).extend(alpha)
    }

    /// What arrives along a ray, the last of `depth` segments.
    fn follow<W: World>(&self, world: &W, mut ray: Ray, packets: &[Packet], depth: u32) -> Vec3 {
        let hidden = self.hide_emitters && depth == 1;
        let Some((hit, vertex)) = next_surface(world, &mut ray, hidden) else {
            return Vec3::ZERO;
        };
        let wo = -ray.direction;
        let mut sum = Vec3::ZERO;
        for packet in packets {
            let mut radiance = Vec4::ZERO;
            if world.is_emitter(&hit) {
                radiance += world.emitted(&vertex, wo, &packet.wavelengths);
            }
            if let Some(material) = world.legacy_phong(&vertex, &packet.wavelengths) {
                radiance += material.ambient * (self.ambient * (1.0 - material.transparency));
            }
            sum += packet.response.rgb(radiance * packet.weight);
        }
        if depth == self.max_depth {
            return sum;
        }
        sum += self.direct(world, &vertex, wo, packets, self.max_depth - depth - 1);
        sum + self.branch(world, &vertex, wo, packets, depth + 1)
    }

    /// What arrives from the directions that a smooth surface singles out.
    fn branch<W: World>(
        &self,
        world: &W,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        packets: &[Packet],
        depth: u32,
    ) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut group = [packets[0]; SETS];
        for index in 0.. {
            let mut found = false;
            let (mut count, mut way) = (0, Vec3::ZERO);
            for packet in packets {
                let at = |packet: &Packet| onward(world, vertex, wo, &packet.wavelengths, index);
                let Some(whole) = at(packet) else {
                    continue;
                };
                found = true;
                let weight = packet.weight * whole.value;
                if weight != Vec4::ZERO {
                    if count > 0 && way != whole.wi {
                        sum += self.follow(world, vertex.spawn(way), &group[..count], depth);
                        count = 0;
                    }
                    way = whole.wi;
                    group[count] = Packet { weight, ..*packet };
                    count += 1;
                }
                // Lane 0 chose; others that go elsewhere are asked one by one.
                for lane in (1..4).filter(|&k| packet.weight[k] != 0.0 && whole.together[k] == 0.0)
                {
                    let alone = packet.alone(lane);
                    let Some(own) = at(&alone).filter(|own| own.value.x != 0.0) else {
                        continue;
                    };
                    let weight = alone.weight * own.value.x;
                    let alone = Packet { weight, ..alone };
                    sum += self.follow(world, vertex.spawn(own.wi), &[alone], depth);
                }
            }
            if !found {
                break;
            }
            if count > 0 {
                sum += self.follow(world, vertex.spawn(way), &group[..count], depth);
            }
        }
        sum
    }

    /// The share of what a ray meets that it does not pass straight on.
    fn alpha<W: World>(&self, world: &W, mut ray: Ray, wavelengths: &Wavelengths) -> f32 {
        let mut open = 1.0;
        let mut segment = 1;
        while segment <= self.max_depth {
            let hidden = self.hide_emitters && segment == 1;
            let Some((_, vertex)) = next_surface(world, &mut ray, hidden) else {
                return 1.0 - open;
            };
            let bsdf = world.bsdf(&vertex, -ray.direction, wavelengths);
            open *= 0.25 * bsdf.null_probability().element_sum();
            segment += 1;
            if open == 0.0 {
                break;
            }
            ray = vertex.spawn(ray.direction);
        }
        1.0 - open
    }
}

/// The ray number `index` that leaves a surface, whatever it is made of; `None` beyond the last.
pub fn onward<W: World>(
    world: &W,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    wavelengths: &Wavelengths,
    index: u32,
) -> Option<Continuation> {
    if let Some(material) = world.legacy_phong(vertex, wavelengths) {
        return phong::onward(&material, vertex, wo, index);
    }
    let sample =
        (world.bsdf(vertex, wo, wavelengths)).discrete(wo, index, TransportMode::Radiance)?;
    Some(Continuation {
        wi: sample.wi,
        value: sample.value,
        together: sample.chance.lanes(),
    })
}
