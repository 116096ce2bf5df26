//! `depth`: the distance to the first surface.
//!
//! ```text
//! C = ∫ s(λ) dλ · 1/n Σᵢ wᵢ tᵢ
//! ```
//!
//! with tᵢ the distance along the ray of the pixel's i-th sample (a depth buffer, Catmull 1974, with
//! antialiasing and along the ray), wᵢ the sample's weight in the pixel's filter (1 without negative
//! lobes) and s the sensor's response.
//!
//! As in Mitsuba the distance is a spectrum that is constant over wavelength, so the sensor
//! turns it into a colour; the expected colour of a constant spectrum 1 is known exactly, so no
//! wavelength is drawn for it. Nothing hit counts as distance 0. The plain number is the `depth`
//! channel of `aov`.

use crate::path::camera_ray;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Incompatibility, Integrator, Pass, PixelSample, Placing, SceneCapabilities, Sink, World,
};

/// The distance integrator.
#[derive(Clone, Copy, Debug, Default)]
pub struct Depth;

impl Integrator for Depth {
    type State = ();

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Blocks
    }

    /// It asks for no light.
    fn incompatibilities(&self, _: &SceneCapabilities) -> Vec<Incompatibility> {
        Vec::new()
    }

    fn prepare<W: World>(&self, _: &W, _: &impl Placing, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let (_, ray, _) = camera_ray(world, site, sampler);
        let (t, alpha) = world.intersect(&ray).map_or((0.0, 0.0), |hit| (hit.t, 1.0));
        sink.radiance((world.sensor_unit() * t).to_array(), alpha);
    }
}
