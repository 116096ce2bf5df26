//! `depth`: the distance to the first surface.
//!
//! ```text
//! C = 1/n Σᵢ wᵢ tᵢ
//! ```
//!
//! with tᵢ the distance along the ray of the pixel's i-th sample (a depth buffer, Catmull 1974, with
//! antialiasing and along the ray) and wᵢ the sample's weight in the pixel's filter (1 without negative
//! lobes): a number and no light, so all channels have it, as the `depth` channel of `aov` does. Nothing hit counts as
//! distance 0.

use crate::steps::camera_ray::camera_ray;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Incompatibility, Integrator, Pass, PixelSample, Placing, SceneCapabilities, Sink,
    Surfaces, World, one_by_one,
};

/// The distance integrator.
#[derive(Clone, Copy, Debug, Default)]
pub struct Depth;

impl Integrator for Depth {
    const UNBIASED: bool = false;
    const MEDIA: bool = false;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = false;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    /// It needs no light.
    fn incompatibilities(&self, _: &SceneCapabilities) -> Vec<Incompatibility> {
        Vec::new()
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Blocks
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
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
        let (t, alpha) = world
            .surfaces()
            .intersect(&ray)
            .map_or((0.0, 0.0), |hit| (hit.t, 1.0));
        sink.radiance([t; 3], alpha);
    }

    one_by_one!();
}
