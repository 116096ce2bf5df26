//! What an estimator says of itself when one of its samples is drawn again.
//!
//! Most of a sample can be told from what its estimator asks of the world and is told. What it does by
//! itself, and what it asks for the sake of something else, it remarks ([`crate::World::record`],
//! [`crate::Bsdf::mixed`]). A world that renders does not listen: there a remark is a closure that nobody
//! calls, and costs nothing.

use crate::{BsdfSample, SamplePdf};
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use glam::{Vec3, Vec4};

/// A remark about what was done, or is done next.
#[derive(Clone, Copy, Debug)]
pub enum TraceEvent {
    /// The path has these wavelengths, whatever was drawn.
    Wavelengths(Wavelengths),
    /// Photons are looked up around the surface at hand. What is asked of scattering models before
    /// [`TraceEvent::Gathered`] is asked for their sake.
    Gathering {
        /// How far they may be (m).
        radius: f32,
        /// How many there are in the map.
        among: usize,
    },
    /// One of them counts.
    Photon(MergedPhoton),
    /// All of them have been counted.
    Gathered,
    /// Of all techniques of bidirectional path tracing, this one makes the path.
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
        /// Which of the replicate's chains.
        number: usize,
        /// The uniform sample at which it begins.
        start: u32,
    },
    /// The path that a step of the chain proposes follows.
    Proposal {
        /// Which step, from 0.
        step: u32,
        /// Whether all of its numbers are drawn anew.
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
    /// Where it arrived (m).
    pub position: Vec3,
    /// How far away from the surface's point that is (m).
    pub distance: f32,
    /// Unit direction to where it came from.
    pub from: Vec3,
    /// Segments behind it.
    pub segments: u32,
    /// Its wavelengths, to whose lanes the following belong.
    pub wavelengths: Wavelengths,
    /// f·|cos θ| of the surface for its direction.
    pub scattering: Vec4,
    /// What it adds to the pixel's radiance over the density of its wavelengths, the camera's weight apart.
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
    /// What it was for.
    pub mixed: Mixed,
}

/// What a mixture was asked for.
#[derive(Clone, Copy, Debug)]
pub enum Mixed {
    /// To weigh a given direction, which has this density in the mixture.
    Weighed(Density<SolidAngle>),
    /// To sample a direction.
    Sampled {
        /// Whether the model chose it, or the other density.
        by_model: bool,
        /// What became of it, with its density in the mixture; `None` if the surface does not scatter there.
        sample: Option<BsdfSample>,
    },
}
