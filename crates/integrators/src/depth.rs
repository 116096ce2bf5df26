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
use etalon_spectrum::sensor::response;
use etalon_transport::{
    Incompatibility, Integrator, Pass, PixelSample, Placing, SceneCapabilities, Sink, World,
};
use glam::Vec4;

/// The distance integrator.
#[derive(Clone, Debug)]
pub struct Depth {
    /// Linear Rec.709 of the spectrum that is 1 everywhere.
    unit: [f32; 3],
}

impl Default for Depth {
    fn default() -> Self {
        // The response is linear between whole nanometres and zero outside of the observer's
        // range, so the sum over whole nanometres is its integral up to half of the (tiny) ends.
        let mut unit = [0.0_f64; 3];
        for nm in 300..900 {
            let [r, g, b, _] = response(Vec4::splat(nm as f32));
            for (sum, value) in unit.iter_mut().zip([r, g, b]) {
                *sum += f64::from(value.x);
            }
        }
        Self {
            unit: unit.map(|c| c as f32),
        }
    }
}

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
        sink.radiance(self.unit.map(|c| c * t), alpha);
    }
}
