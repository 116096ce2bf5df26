//! Caustics: what lamps throw onto a surface by way of mirrors and glass, from a photon map in two passes.
//!
//! Of light that comes straight from a lamp shadow rays know; of light that a mirror or glass has turned they do not. So photons are
//! sent from the lamps, in sharp directions only, and kept where they meet a surface that is not one. With M photons of flux Φᵢ
//!
//! ```text
//! L_caustic(x, ω) = Σᵢ K(|xᵢ − x|) f(ωᵢ, ω) Φᵢ / M,   K = 1/(π r²) within r
//! ```
//!
//! is added to what a surface shows (Jensen 1996); of a classic Phong material f is (1 − α) k_d, so that the sum is k_d times the flux
//! that arrives per area. The kernel's integral is one: the flux of a caustic is that which arrives. r is `radius`, or the
//! distance of the k-th nearest photon, which itself is not counted then, as in [`crate::photons::photonmap`].
//!
//! Photons share the wavelengths of the integrator, so that each packet of four has a part of them for itself. A photon goes every way that
//! the recursion would go with the probability that it has as a share of the light there, and is absorbed with the rest.

use super::Continuation;
use super::onward::onward;
use super::packet::{Packet, SETS};
use super::surface::{Surface, SurfaceBySet};
use crate::photons::kdtree::Neighbour;
use crate::photons::kernel::{Kernel, KernelLookup};
use crate::photons::radius::{ANYWHERE, from_pixels, held};
use crate::photons::sets::WavelengthChoice;
use crate::photons::shoot::{FACING, Kind, Photon, PlacedPhotons, in_order, moment, numbers};
use crate::steps::arrival::next_surface;
use crate::steps::light_path::LightPath;
use etalon_sampling::Sampler;
use etalon_transport::{
    LightKind, MediumId, Pass, Placing, SurfaceInteraction, TransportMode, World,
};
use glam::{Vec3, Vec4};

/// The settings of caustics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CausticSettings {
    /// Number of photons; 0 for no caustics.
    pub photons: u32,
    /// Within what distance they count (m); `None` for the width of two pixels, or all that is needed for the nearest.
    pub radius: Option<f32>,
    /// Number of nearest photons; 0 for all within the radius.
    pub nearest: usize,
}

/// The photons of a replicate.
pub(super) struct Caustics {
    placed: PlacedPhotons,
    lookup: KernelLookup,
    /// Photons that each packet was given.
    share: u32,
}

/// More ways than any surface has.
const MOST_WAYS: u32 = 16;

impl Caustics {
    /// Sends the photons of a pass; `None` if there are to be none.
    pub(super) fn shoot<W: World>(
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        packets: &[Packet],
        (settings, max_depth): (CausticSettings, u32),
    ) -> Option<Self> {
        if settings.photons == 0 {
            return None;
        }
        // Each lane of each packet leads the same number of them.
        let lanes = 4 * packets.len() as u32;
        let each = settings.photons.div_ceil(lanes);
        let count = each * lanes;
        let photons = in_order(count, placing, |index, found| {
            let lane = (index / each) as usize;
            let lanes = WavelengthChoice {
                set: lane / 4,
                first: lane % 4,
            };
            let mut sampler = numbers(pass, index, count);
            trace(
                world,
                max_depth,
                (packets, lanes, moment(pass)),
                &mut sampler,
                found,
            );
        });
        let placed = PlacedPhotons::new(&photons);
        let radius = match (settings.radius, settings.nearest) {
            (Some(radius), _) => radius,
            (None, 0) => held(world, pass, &placed.tree, from_pixels(world, pass)),
            (None, _) => ANYWHERE,
        };
        Some(Self {
            placed,
            lookup: KernelLookup {
                radius,
                nearest: settings.nearest.min(photons.len()),
                kernel: Kernel::Box,
            },
            share: 4 * each,
        })
    }

    /// Their radiance at a surface `depth` segments from the camera.
    pub(super) fn seen<W: World>(
        &self,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        (packets, surfaces): (&[Packet], &SurfaceBySet<'_, W>),
        [depth, max_depth]: [u32; 2],
        found: &mut Vec<Neighbour>,
    ) -> Vec3 {
        if !surfaces.iter().flatten().any(Surface::spreads) {
            return Vec3::ZERO;
        }
        let mut place = [None; SETS];
        for (index, packet) in packets.iter().enumerate() {
            place[packet.lanes.set] = Some(index);
        }
        let mut sums = [Vec4::ZERO; SETS];
        let side = vertex.normal.dot(wo);
        let (placed, centre) = (&self.placed, vertex.position);
        self.lookup
            .visit(placed, centre, false, found, |photon, kernel| {
                let Some(index) = place[photon.set as usize] else {
                    return;
                };
                let is_here = photon.normal.dot(vertex.normal) >= FACING
                    && vertex.normal.dot(photon.from) * side > 0.0
                    && depth + photon.segments <= max_depth;
                if let Some(surface) = surfaces[index].as_ref().filter(|_| is_here) {
                    let value = packets[index].lanes.of_set(photon.value);
                    sums[index] += surface.spread(vertex, wo, photon.from) * value * kernel;
                }
            });
        let scale = 1.0 / self.share as f32;
        let shown = packets.iter().zip(sums);
        shown
            .map(|(packet, sum)| packet.response.rgb(packet.weight * sum * scale))
            .sum()
    }
}

/// One photon's way.
fn trace<W: World>(
    world: &W,
    max_depth: u32,
    (packets, lanes, time): (&[Packet], WavelengthChoice, f32),
    sampler: &mut impl Sampler,
    found: &mut Vec<Photon>,
) {
    let wavelengths = packets[lanes.set].wavelengths.rotated(lanes.first);
    let Some((start, particle)) = LightPath::emit(world, &wavelengths, sampler, time) else {
        return;
    };
    let (mut throughput, mut ray) = (particle.throughput, particle.ray);
    // A beam is found by no shadow ray.
    let mut is_caustic = matches!(start.origin, LightKind::Beam);
    let mut segments = 1;
    while segments < max_depth && throughput.beta != Vec4::ZERO {
        let Some((_, vertex)) = next_surface(world, &mut ray, false) else {
            return;
        };
        let wo = -ray.direction;
        let cos = vertex.area_cos(wo);
        let lead = Packet {
            wavelengths,
            ..packets[lanes.set]
        };
        let surfaces = super::surface::at(world, &vertex, wo, &[lead]);
        let spreads = surfaces[0].as_ref().is_some_and(Surface::spreads);
        if is_caustic && spreads && cos > 0.0 {
            let value = throughput.beta * (4.0 / (throughput.r_u.element_sum() * cos));
            found.push(Photon {
                position: vertex.position,
                normal: vertex.normal,
                from: wo,
                value: lanes.to_set(value),
                set: lanes.set as u32,
                segments,
                kind: Kind::Caustic,
                medium: MediumId::NONE,
            });
        }
        let way = |index| {
            onward(
                world,
                &vertex,
                wo,
                (&wavelengths, TransportMode::Importance),
                index,
            )
        };
        let ways: [Option<Continuation>; MOST_WAYS as usize] = {
            let mut ways = (0..MOST_WAYS).map_while(way);
            core::array::from_fn(|_| ways.next())
        };
        let ways = || ways.iter().flatten();
        // More than all there is may only be given by a material that gives more than it gets.
        let whole = ways().map(|way| way.value).sum::<Vec4>().max(Vec4::ONE);
        let mut left = sampler.next_1d();
        let chosen = ways().find(|way| {
            left -= way.value.x / whole.x;
            left < 0.0
        });
        let Some(chosen) = chosen else { return };
        let chance = chosen.value / whole;
        throughput.scatter(chosen.value, chance);
        is_caustic |= !chosen.is_straight;
        ray = vertex.spawn(chosen.wi);
        segments += 1;
    }
}
