//! `ao`: ambient occlusion, how much of its surroundings a point sees.
//!
//! ```text
//! AO(x) = 1/π ∫ V(x, ω)·cos θ dω  over the hemisphere that faces the camera
//! ```
//!
//! where V is 1 if nothing is within `distance` of x along ω, else 0 (Zhukov, Iones, Kronin 1998, with
//! a step for the fall-off): the radiance of a white surface under a white sky of radiance 1, occluded
//! by near objects only. The picture is grey and independent of materials and lights, except that light
//! passes `mask` and `null`. `sampling` selects the density of directions: `cosine`, proportional to
//! cos θ, needs no weight; `uniform`, weighted by 2 cos θ, is for comparison. The hemisphere is that
//! about the shading normal; its directions below the geometric surface are occluded.

use crate::steps::camera_ray::camera_ray;
use crate::steps::dimensions::BounceSamples;
use etalon_params::Params;
use etalon_sampling::warps::{square_to_cosine_hemisphere, square_to_uniform_hemisphere};
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Channel, Incompatibility, Integrator, Pass, PixelSample, Placing, Ray, SceneCapabilities,
    Sink, SurfaceInteraction, Surfaces, World, one_by_one,
};
use glam::Vec3;

/// The ambient occlusion integrator.
#[derive(Clone, Debug)]
pub struct AmbientOcclusion {
    /// The distance beyond which nothing occludes (m).
    pub distance: f32,
    /// Whether directions are drawn in proportion to the cosine.
    pub cosine: bool,
    /// Directions per sample.
    pub shading_samples: u32,
}

impl Default for AmbientOcclusion {
    fn default() -> Self {
        Self {
            distance: f32::INFINITY,
            cosine: true,
            shading_samples: 1,
        }
    }
}

impl AmbientOcclusion {
    /// Reads the integrator from its description: `distance` (default: unlimited), `sampling`
    /// (`cosine` or `uniform`) and `shading_samples` (1).
    pub fn from_params(params: &Params<'_>) -> Self {
        let distance = params.float("distance").unwrap_or(f64::INFINITY) as f32;
        if !(distance > 0.0) {
            params.refuse("distance", distance, "a number above 0");
        }
        let samples = params.integer_or("shading_samples", 1);
        let shading_samples = u32::try_from(samples)
            .ok()
            .filter(|n| (1..=1 << 16).contains(n))
            .unwrap_or_else(|| {
                params.refuse("shading_samples", samples, "1, 2, … 65536");
                1
            });
        let cosine = params.choice("sampling", "cosine", &["cosine", "uniform"]) == "cosine";
        Self {
            distance,
            cosine,
            shading_samples,
        }
    }

    /// The first surface that the ray does not pass straight.
    fn first<W: World, S: Sampler>(
        world: &W,
        mut ray: Ray,
        wavelengths: &Wavelengths,
        sampler: &mut S,
    ) -> Option<(SurfaceInteraction, Vec3, u32)> {
        for depth in 0.. {
            let hit = world.surfaces().intersect(&ray)?;
            let vertex = world.surfaces().vertex(&ray, &hit);
            let wo = -ray.direction;
            let bsdf = world.surfaces().bsdf(&vertex, wo, wavelengths);
            let event = BounceSamples::draw(sampler, depth);
            if !(event.lobe < 0.25 * bsdf.null_probability().element_sum()) {
                return Some((vertex, wo, depth));
            }
            ray = vertex.spawn(ray.direction);
        }
        None
    }

    /// The fraction of the hemisphere, by projected solid angle, that is open.
    fn openness<W: World, S: Sampler>(
        &self,
        world: &W,
        (vertex, wo, depth): (&SurfaceInteraction, Vec3, u32),
        wavelengths: &Wavelengths,
        sampler: &mut S,
    ) -> f32 {
        let side = 1.0_f32.copysign(vertex.shading.n.dot(wo));
        let mut sum = 0.0;
        for sample in 0..self.shading_samples {
            let u = BounceSamples::draw(sampler, depth + 1 + sample).direction;
            let (local, weight) = if self.cosine {
                (square_to_cosine_hemisphere(u), 1.0)
            } else {
                let local = square_to_uniform_hemisphere(u);
                (local, 2.0 * local.z)
            };
            let direction = vertex.shading.to_world(local * Vec3::new(1.0, 1.0, side));
            if !(direction.dot(vertex.normal) * wo.dot(vertex.normal) > 0.0) {
                continue;
            }
            let ray = Ray {
                t_max: self.distance,
                ..vertex.spawn(direction)
            };
            if let Some(transmission) = world.transmittance(&ray, wavelengths, u32::MAX) {
                sum += weight * 0.25 * transmission.transmittance.element_sum();
            }
        }
        sum / self.shading_samples as f32
    }
}

impl Integrator for AmbientOcclusion {
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
        let (wavelengths, ray, weight) = camera_ray(world, site, sampler);
        match Self::first(world, ray, &wavelengths, sampler) {
            Some((vertex, wo, depth)) => {
                let seen = (&vertex, wo, depth);
                let open = self.openness(world, seen, &wavelengths, sampler);
                sink.radiance([open * weight; 3], 1.0);
            }
            None => sink.radiance([0.0; 3], 0.0),
        }
    }

    one_by_one!();
}
