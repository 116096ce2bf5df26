//! The material at a surface: classic Phong, or a BSDF.

use super::packet::{Packet, SETS};
use super::phong;
use etalon_transport::{
    Bsdf, BsdfOf, LegacyPhong, SurfaceInteraction, Surfaces, TransportMode, World,
};
use glam::{Vec3, Vec4};

/// The material at a surface, for one packet.
pub(super) enum Surface<B> {
    Classic(LegacyPhong),
    Scattering(B),
}

/// The same for each packet.
pub(super) type SurfaceBySet<'w, W> = [Option<Surface<BsdfOf<'w, W>>>; SETS];

/// The material at `vertex`, seen from `wo`, for each packet.
pub(super) fn at<'w, W: World>(
    world: &'w W,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    packets: &[Packet],
) -> SurfaceBySet<'w, W> {
    core::array::from_fn(|i| {
        let wavelengths = &packets.get(i)?.wavelengths;
        Some(
            match world.surfaces().legacy_phong(vertex, wo, wavelengths) {
                Some(material) => Surface::Classic(material),
                None => Surface::Scattering(world.surfaces().bsdf(vertex, wo, wavelengths)),
            },
        )
    })
}

impl<B: Bsdf> Surface<B> {
    /// The radiance toward the viewer per unit of a lamp's irradiance.
    pub(super) fn shade(&self, vertex: &SurfaceInteraction, wo: Vec3, wi: Vec3) -> Vec4 {
        match self {
            Self::Classic(material) => phong::shade(material, vertex, wo, wi),
            Self::Scattering(bsdf) => bsdf.eval(wo, wi, TransportMode::Radiance),
        }
    }

    /// The same of light that photons bring: of a classic material its diffuse part alone.
    pub(super) fn spread(&self, vertex: &SurfaceInteraction, wo: Vec3, wi: Vec3) -> Vec4 {
        match self {
            Self::Classic(material) => phong::spread(material, vertex, wo, wi),
            Self::Scattering(bsdf) => bsdf.eval(wo, wi, TransportMode::Radiance),
        }
    }

    /// Whether it shows photons.
    pub(super) fn spreads(&self) -> bool {
        match self {
            Self::Classic(material) => {
                material.diffuse != Vec4::ZERO && material.transparency < 1.0
            }
            Self::Scattering(bsdf) => bsdf.has_continuous(),
        }
    }
}
