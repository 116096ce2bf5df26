//! The wavelengths of a ray, in packets of four.

use crate::photons::sets::WavelengthChoice;
use etalon_spectrum::{QuadratureNode, SensorWeights, Wavelengths};
use etalon_transport::{Sensor, World};
use glam::Vec4;

/// The most packets.
pub(super) const SETS: usize = super::MOST_WAVELENGTHS as usize / 4;

/// Four wavelengths on their way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packet {
    pub(super) wavelengths: Wavelengths,
    pub(super) response: SensorWeights,
    /// The weight of radiance, per lane.
    pub(super) weight: Vec4,
    /// Index of the packet, and its first lane.
    pub(super) lanes: WavelengthChoice,
}

impl Packet {
    /// The packet in which lane `k` chooses, and is alone.
    pub(super) fn alone(&self, k: usize) -> Self {
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
            lanes: WavelengthChoice {
                first: (self.lanes.first + k) % 4,
                ..self.lanes
            },
        }
    }
}

/// The packets of `count` nodes, at most [`SETS`].
pub(super) fn packets<W: World>(world: &W, count: u32) -> Vec<Packet> {
    let nodes = QuadratureNode::all(
        count,
        |u| world.sensor().wavelengths(u),
        |w| world.sensor().weights(w),
    );
    let weight = Vec4::splat(1.0 / (4 * count) as f32);
    (nodes.zip(0..))
        .map(|(node, set)| Packet {
            wavelengths: node.wavelengths,
            response: node.response,
            weight,
            lanes: WavelengthChoice { set, first: 0 },
        })
        .collect()
}
