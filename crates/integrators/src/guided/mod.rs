//! `guided`: path tracing guided by a learned distribution of incident radiance.
//!
//! ```text
//! C = Σₙ ∫ Le(xₙ→xₙ₋₁) · Π_{0<i<n} fᵢ·|cos θᵢ| dω₁…dωₙ₋₁,      ωᵢ ~ α·p_f(ω) + (1 − α)·p_g(ω | xᵢ)
//! ```
//!
//! The integral, light sampling and MIS over techniques and wavelengths are those of [`crate::path`]. But directions
//! are sampled from a mixture of the BSDF's density p_f and a learned one p_g, piecewise constant in space and
//! direction, that is proportional to the expected incident radiance (Müller, Gross & Novák 2017, "Practical Path
//! Guiding for Efficient Light-Transport Simulation"; Müller 2019, its chapter in "Path Guiding in Production"). The
//! mixture is one technique with one density (one-sample MIS); p_g is the same for all four wavelengths. The mixing
//! probability α is learned as well, region by region (`fraction.rs`).
//!
//! **Training** happens once per image, before its first sample: one sample per pixel for the size and brightness of
//! the scene, then rounds of 1, 2, 4, … samples per pixel from their own random stream, in total at most `training`
//! times the image's samples, but at least one. Then the field is frozen. The paths of all rounds but the last are
//! discarded. Those of the last, half of all or more, are distributed over the replicates and join their pictures
//! (`pictures.rs`), if there is one per pixel for every replicate.
//!
//! **Why the standard error is right.** Let F be the field, T_r the last round's mean for replicate r, and X_r that of
//! its own samples. Given the field that guides them, the T_r are independent estimates of the picture I: p_f alone
//! finds all light, under any guiding. Given F, which depends on nothing drawn later, so are the X_r. So for different
//! replicates r ≠ s
//!
//! ```text
//! Cov(T_r, T_s) = 0,      Cov(X_r, X_s) = E[Cov(X_r, X_s | F)] + Cov(I, I) = 0,      Cov(T_r, X_s) = Cov(T_r, E[X_s | training]) = Cov(T_r, I) = 0
//! ```
//!
//! and the replicates (1 − w)·X_r + w·T_r are uncorrelated. As they are identically distributed, their s²/R has the
//! expectation Var(C̄), though all share the training. The field depends on the scene, the seed, the film and the
//! number of samples of the whole image, so that every part of a split render learns the same.

mod fraction;
mod guided_bsdf;
mod guided_hooks;
mod lane_guided_bsdf;
mod sd_tree;
#[cfg(test)]
mod tests;
mod trainer;
mod training_images;
mod training_path;

use crate::path::{follow_alone, follow_jobs};
use crate::steps::settings::{PathConfig, PathSettings};
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing, Preparation,
    SampleJob, SceneCapabilities, Sink, TileSink, World,
};
use guided_hooks::GuidedHooks;
use sd_tree::SdTree;
use std::vec::Drain;
use trainer::Trainer;
use training_images::{TrainingImages, TrainingSink};

/// The guided path tracer.
#[derive(Clone, Debug)]
pub struct Guided {
    /// Limits of the path.
    pub settings: PathSettings,
    /// Samples per pixel spent on learning, as a multiple of the image's own.
    pub training: f64,
    /// The least α, the probability of following the scattering model's own choice of direction, and all that
    /// there is to it where nothing was learned of it; above 0, as it alone finds all light.
    pub bsdf_sampling_fraction: f64,
    /// Records after which a region of space is halved (in the round of one sample per pixel; in a round
    /// of n samples √n times as many).
    pub spatial_threshold: f64,
    /// The share of a region's light above which a square of directions is divided.
    pub directional_threshold: f64,
}

impl Default for Guided {
    fn default() -> Self {
        Self {
            settings: PathSettings::default(),
            training: 0.15,
            bsdf_sampling_fraction: 0.3,
            spatial_threshold: 2000.0,
            directional_threshold: 0.02,
        }
    }
}

impl Guided {
    /// Reads the integrator from its description.
    pub fn from_params(params: &Params<'_>) -> Self {
        let default = Self::default();
        let number = |name: &str, default: f64, from: f64, to: f64| {
            let value = params.float_or(name, default);
            if !(value >= from && value <= to) {
                params.refuse(name, value, &format!("a number from {from} to {to}"));
                return default;
            }
            value
        };
        Self {
            settings: PathSettings::from_params(params),
            training: number("training", default.training, 0.0, 10.0),
            bsdf_sampling_fraction: number(
                "bsdf_sampling_fraction",
                default.bsdf_sampling_fraction,
                0.01,
                1.0,
            ),
            spatial_threshold: number("spatial_threshold", default.spatial_threshold, 10.0, 1e9),
            directional_threshold: number(
                "directional_threshold",
                default.directional_threshold,
                1e-4,
                1.0,
            ),
        }
    }

    fn trainer(&self, pass: &Pass) -> Trainer {
        Trainer {
            settings: self.settings,
            own: self.bsdf_sampling_fraction as f32,
            samples: (self.training * f64::from(pass.image_samples)) as u32,
            records: self.spatial_threshold,
            share: self.directional_threshold,
        }
    }

    fn guide(learned: &Learned) -> GuidedHooks<'_> {
        GuidedHooks {
            field: &learned.field,
            reflected: 1.0,
        }
    }
}

/// The result of training for an image.
#[derive(Clone, Debug)]
pub struct Learned {
    field: SdTree,
    /// The pictures of the training.
    pictures: Option<TrainingImages>,
    /// The replicate that is being rendered.
    replicate: u32,
}

impl Preparation for Learned {
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

impl Integrator for Guided {
    const UNBIASED: bool = true;
    const MEDIA: bool = true;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = false;

    type State = Learned;

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        capabilities.incompatibilities(LightSearch::FromCamera)
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Independent
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        before: Option<Learned>,
    ) -> Learned {
        // Learned for the image: every pass finds the same.
        let learned = before.unwrap_or_else(|| {
            let (field, pictures) = self.trainer(pass).learn(world, placing, pass);
            Learned {
                field,
                pictures,
                replicate: 0,
            }
        });
        Learned {
            replicate: pass.replicate,
            ..learned
        }
    }

    /// A single sample, without the pictures of the training, which join batches only.
    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        learned: &Learned,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let guide = Self::guide(learned);
        let config = PathConfig::plain(self.settings);
        follow_alone(world, &config, guide, (site, sampler), sink);
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        learned: &Learned,
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        let guide = Self::guide(learned);
        let config = PathConfig::plain(self.settings);
        match &learned.pictures {
            Some(pictures) => {
                let first = (jobs.as_slice().iter())
                    .map(|job| job.site.sample == 0)
                    .collect();
                let mut sink = TrainingSink::new(sink, pictures, learned.replicate, first);
                follow_jobs(world, &config, guide, jobs, &mut sink);
            }
            None => follow_jobs(world, &config, guide, jobs, sink),
        }
    }
}
