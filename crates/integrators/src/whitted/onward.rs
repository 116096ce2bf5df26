//! The secondary rays of a surface of any material.

use super::{Continuation, phong};
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, SurfaceInteraction, Surfaces, TransportMode, World};
use glam::Vec3;

/// The secondary ray number `index` of a surface of any material; `None` beyond the last. `mode` is the transported quantity:
/// radiance along view rays, importance along photons.
pub fn onward<W: World>(
    world: &W,
    vertex: &SurfaceInteraction,
    wo: Vec3,
    (wavelengths, mode): (&Wavelengths, TransportMode),
    index: u32,
) -> Option<Continuation> {
    if let Some(material) = world.surfaces().legacy_phong(vertex, wo, wavelengths) {
        return phong::onward(&material, vertex, wo, index);
    }
    let sample = (world.surfaces().bsdf(vertex, wo, wavelengths)).discrete(wo, index, mode)?;
    Some(Continuation {
        wi: sample.wi,
        value: sample.value,
        together: sample.chance.lanes(),
        is_straight: sample.is_null,
    })
}
