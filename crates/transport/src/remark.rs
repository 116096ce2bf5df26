//! Events that an estimator records when one of its samples is replayed.
//!
//! Most of a sample follows from the calls to the world and their results. Decisions of the estimator
//! itself, and the purpose of a call, it records by [`crate::World::record`] and [`crate::Bsdf::mixed`].
//! A world that renders never calls the closure, so an event costs nothing there.

use crate::{BsdfSample, SamplePdf};
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use glam::{Vec3, Vec4};

/// An event.
#[derive(Clone, Copy, Debug)]
pub enum TraceEvent {
    /// The path has these wavelengths, not those drawn before.
    Wavelengths(Wavelengths),
    /// Photons are looked up around the current vertex. Calls to its BSDF up to [`TraceEvent::Gathered`] are for
    /// these photons.
    Gathering {
        /// The radius (m).
        radius: f32,
        /// Number of photons in the map.
        among: usize,
    },
    /// One of them counts.
    Photon(MergedPhoton),
    /// All of them have been counted.
    Gathered,
    /// The technique of bidirectional path tracing that generates the path.
    Technique {
        /// Vertices made from the light.
        light: usize,
        /// Vertices made from the camera.
        camera: usize,
    },
    /// About Markov chains.
    Chain(ChainRemark),
}

/// A remark about Markov chains of paths.
#[derive(Clone, Copy, Debug)]
pub enum ChainRemark {
    /// The Markov chains, and the samples with which they begin, are spread over the samples of all pixels;
    /// this one has none.
    HostsNone,
    /// The sample does its share of these.
    Hosts {
        /// Contributions of the replicate's uniform samples.
        contributions: usize,
        /// Chains.
        chains: usize,
        /// Steps of each.
        steps: u32,
    },
    /// The path of the replicate's uniform sample of this number follows, and what it contributes.
    Uniform(u32),
    /// A chain begins; the path where it does follows.
    Begins {
        /// Index of the chain in its replicate.
        number: usize,
        /// The uniform sample at which it begins.
        start: u32,
    },
    /// The path that a step of the chain proposes follows.
    Proposal {
        /// Index of the step, from 0.
        step: u32,
        /// Whether it is a large step: all numbers are drawn independently.
        large: bool,
    },
    /// The chain goes there, or not. Which of the two it does not stay at contributes now.
    Decision {
        /// I of the path where the chain stands, in proportion to which it visits paths.
        from: f64,
        /// I of the path proposed.
        to: f64,
        /// The probability of going there.
        acceptance: f64,
        /// Whether the chain goes there.
        accepted: bool,
    },
    /// The chain ends. The path where it stands contributes now.
    Ends,
}

/// A photon that counts at a surface.
#[derive(Clone, Copy, Debug)]
pub struct MergedPhoton {
    /// Its position (m).
    pub position: Vec3,
    /// Distance from the vertex (m).
    pub distance: f32,
    /// Unit direction to where it came from.
    pub from: Vec3,
    /// Segments behind it.
    pub segments: u32,
    /// Its wavelengths, to whose lanes the following belong.
    pub wavelengths: Wavelengths,
    /// f·|cos θ| of the surface for its direction.
    pub scattering: Vec4,
    /// Its contribution to the pixel's radiance, over the density of its wavelengths, without the camera's weight.
    pub estimate: Vec4,
}

/// A direction that was sampled or weighed with a mixture of two densities: a scattering model's, and
/// another that the model does not know.
#[derive(Clone, Copy, Debug)]
pub struct Mixture {
    /// The direction.
    pub wi: Vec3,
    /// The model's own density of it, or probability.
    pub own: SamplePdf,
    /// The other density, times the probability that light does not pass straight on; zero of a discrete
    /// direction.
    pub other: Density<SolidAngle>,
    /// The weight of the model's density; that of the other is one minus this.
    pub share: f32,
    /// Its purpose.
    pub mixed: Mixed,
}

/// The purpose of a mixture.
#[derive(Clone, Copy, Debug)]
pub enum Mixed {
    /// To weigh a given direction, which has this density in the mixture.
    Weighed(Density<SolidAngle>),
    /// To sample a direction.
    Sampled {
        /// Whether the model chose it, or the other density.
        by_model: bool,
        /// The result, with its density in the mixture; `None` if the surface does not scatter there.
        sample: Option<BsdfSample>,
    },
}
