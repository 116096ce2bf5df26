//! `signature`: a flat colour of its own for every object, to check geometry by.
//!
//! The object is the shape that a camera ray meets first, or the instance through which it meets
//! it. Shapes count from 0 in the order of the scene file, those of a `shapegroup` included, instances
//! from 2³¹. Object number n has the linear colour
//!
//! ```text
//! cᵢ = 0.1 + 0.8 · frac(½ + (n + 1)·g⁻ⁱ),      i = 1, 2, 3,      g⁴ = g + 1
//! ```
//!
//! the n-th point of a low-discrepancy sequence in the cube of colours (Roberts 2018, "The
//! Unreasonable Effectiveness of Quasirandom Sequences"), so that colours of few objects are far
//! apart and no two of the first 100,000 are closer than 10⁻⁴. Nothing hit is black with alpha 0.
//! Two renderers that are given the same colours must agree pixel by pixel wherever neighbouring
//! pixels do.

use crate::steps::camera_ray::camera_ray;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Hit, Incompatibility, Integrator, Pass, PixelSample, Placing, SceneCapabilities, Sink,
    Surfaces, World, one_by_one,
};

/// The signature integrator.
#[derive(Clone, Copy, Debug, Default)]
pub struct Signature;

/// The linear Rec.709 colour of object number `object`.
///
/// ```
/// use etalon_integrators::signature::colour;
///
/// assert_ne!(colour(0), colour(1));
/// assert!(colour(7).iter().all(|c| (0.1..0.9).contains(c)));
/// ```
pub fn colour(object: u32) -> [f32; 3] {
    /// The real root of g⁴ = g + 1.
    const G: f64 = 1.220_744_084_605_759_5;
    let n = f64::from(object) + 1.0;
    [1.0 / G, 1.0 / (G * G), 1.0 / (G * G * G)].map(|step| {
        let place = (0.5 + n * step).fract();
        (0.1 + 0.8 * place) as f32
    })
}

/// The number of the object that was hit: shapes count from 0; instances from 2³¹, so that each
/// has a colour of its own however many shapes its group has.
fn object(hit: &Hit) -> u32 {
    if hit.instance.is_some() {
        (1 << 31) | hit.instance.0
    } else {
        hit.shape.0
    }
}

impl Integrator for Signature {
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
        match world.surfaces().intersect(&ray) {
            Some(hit) => sink.radiance(colour(object(&hit)), 1.0),
            None => sink.radiance([0.0; 3], 0.0),
        }
    }

    one_by_one!();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sorted by red, only neighbours within 10⁻⁴ need comparing.
    #[test]
    fn colours_are_apart() {
        let instances = (0..2000).map(|i| (1 << 31) | i);
        let mut colours: Vec<[f32; 3]> = (0..100_000).chain(instances).map(colour).collect();
        colours.sort_by(|a, b| a[0].total_cmp(&b[0]));
        for (i, a) in colours.iter().enumerate() {
            let near = colours[i + 1..].iter().take_while(|b| b[0] - a[0] < 1e-4);
            for b in near {
                let apart = (b[1] - a[1]).abs().max((b[2] - a[2]).abs());
                assert!(apart >= 1e-4, "{a:?} {b:?}");
            }
        }
    }
}
