//! The point that light is sampled for.

use crate::{Bsdf, LaneReceiver, SurfaceInteraction};
use etalon_math::lane::{Lane, Mask, Vector};
use glam::Vec3;

/// The receiver for which a light and a direction toward it are chosen. Densities of light sampling depend
/// on it: the MIS weight of a direction found otherwise must use the same receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSampleContext {
    /// Position (m, world).
    pub position: Vec3,
    /// Unit shading normal of the surface there, so that light from grazing directions is chosen
    /// less often; zero where there is no surface.
    pub normal: Vec3,
    /// Whether only light from the side to which `normal` points counts.
    pub one_sided: bool,
    /// The moment within the shutter interval.
    pub time: f32,
    /// Whether light sampling is combined with BSDF sampling by MIS, so that it may leave out some
    /// directions. If not, every direction from which light may come must have a density.
    pub combined: bool,
}

impl LightSampleContext {
    /// A point on no surface.
    pub const fn in_space(position: Vec3) -> Self {
        Self::on_surface(position, Vec3::ZERO)
    }

    /// A point of a surface with the unit normal `normal` that receives light on both sides.
    pub const fn on_surface(position: Vec3, normal: Vec3) -> Self {
        Self {
            position,
            normal,
            one_sided: false,
            time: 0.0,
            combined: false,
        }
    }

    /// The point `vertex` as `bsdf`, the model there for `wo`, receives light.
    #[inline]
    pub fn new(vertex: &SurfaceInteraction, wo: Vec3, bsdf: &impl Bsdf) -> Self {
        let (normal, one_sided) = match bsdf.hemisphere() {
            Some(frame) if frame.n.dot(wo) < 0.0 => (-frame.n, true),
            Some(frame) => (frame.n, true),
            None => (vertex.shading.n, false),
        };
        Self {
            one_sided,
            ..Self::on_surface(vertex.position, normal)
        }
        .at(vertex.time)
    }

    /// The same at the moment `time`.
    #[must_use]
    #[inline]
    pub const fn at(self, time: f32) -> Self {
        Self { time, ..self }
    }

    /// The same in every lane; there, light sampling is always combined with BSDF sampling.
    #[inline(always)]
    pub fn broadcast<F: Lane>(&self) -> LaneReceiver<F> {
        LaneReceiver {
            position: F::Vector::broadcast(self.position),
            normal: F::Vector::broadcast(self.normal),
            one_sided: F::Mask::splat(self.one_sided),
            time: F::splat(self.time),
        }
    }

    /// The same for an estimator that combines light sampling with scattering.
    #[must_use]
    #[inline]
    pub const fn combined(self) -> Self {
        Self {
            combined: true,
            ..self
        }
    }
}
