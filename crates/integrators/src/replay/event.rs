//! What happened while a sample was drawn again.

use crate::steps::path_throughput::PathThroughput;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    ApertureHit, BsdfSample, CameraSample, ChainRemark, Emission, LightSample, MergedPhoton,
    Mixture, Ray, SurfaceInteraction, Transmission,
};
use glam::{Vec2, Vec3, Vec4};

/// What the estimator was told, in the order of its questions. `walk` tells several walks apart,
/// such as those from the camera and from a light; it is `None` for a ray that belongs to none.
#[derive(Clone, Debug)]
pub enum Event {
    /// The wavelengths of the path.
    Wavelengths(Wavelengths),
    /// A walk from the camera begins.
    CameraRay {
        /// The walk.
        walk: usize,
        /// The film position.
        raster: Vec2,
        /// The ray.
        ray: Ray,
    },
    /// A walk from a light begins, or would, if anything were emitted.
    Emitted {
        /// The walk.
        walk: usize,
        /// The particle.
        emission: Option<Emission>,
    },
    /// A ray went on to the next surface, if there is one.
    Ray {
        /// The walk.
        walk: Option<usize>,
        /// The ray.
        ray: Ray,
        /// Distance to the surface (m).
        hit: Option<f32>,
    },
    /// A surface was met.
    SurfaceInteraction {
        /// The walk.
        walk: Option<usize>,
        /// Where.
        vertex: Box<SurfaceInteraction>,
        /// Value and densities of the walk so far, Russian roulette apart; `None` if the estimator
        /// drew a direction by itself.
        prefix: Option<PathThroughput>,
    },
    /// Radiance emitted by the surface.
    Emission(Vec4),
    /// Radiance of the sky along a direction.
    Background(Vec3, Vec4),
    /// A direction was sampled, from the scattering model or a mixture of it with something learned.
    Scattered {
        /// The walk.
        walk: Option<usize>,
        /// The direction; `None` if light is absorbed.
        sample: Option<BsdfSample>,
        /// Value and densities of the walk with it.
        prefix: Option<PathThroughput>,
        /// How it was chosen, if not by the model alone.
        mixture: Option<Mixture>,
    },
    /// The scattering model was asked for a direction.
    Evaluated {
        /// The direction.
        wi: Vec3,
        /// f·|cos θ|, per lane.
        value: Vec4,
        /// The density with which the model would have sampled it, if that was asked.
        density: Option<Density<SolidAngle>>,
        /// The density with which the estimator would have, if that is another.
        mixture: Option<Mixture>,
    },
    /// Photons were gathered around a surface.
    Photons {
        /// How far they may be (m).
        radius: f32,
        /// How many there are in the map.
        among: usize,
        /// Those that bring anything.
        photons: Vec<Gathered>,
    },
    /// A path is made with one technique of bidirectional path tracing: so many vertices from the light,
    /// and so many from the camera.
    Technique(usize, usize),
    /// What the estimator says of its Markov chains. Before a path, walks are counted anew.
    Chain(ChainRemark),
    /// A light was sampled.
    Light(Option<LightSample>),
    /// Straight travel to somewhere; `None` if light does not arrive.
    Transmission(Ray, Option<Transmission>),
    /// A point was connected with the camera; `None` if it does not see it.
    CameraSample(Option<CameraSample>),
    /// A particle hit the aperture.
    ApertureHit(ApertureHit),
    /// The pixel's radiance (linear Rec. 709) and alpha, as the estimator delivered them.
    Radiance([f32; 3], f32),
    /// A splat somewhere on the film (pixels).
    Splat(Vec2, [f32; 3]),
    /// A value of one of the estimator's channels.
    Channel(usize, f32),
}

/// A photon that brings something.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// The photon.
    pub photon: MergedPhoton,
    /// What it adds to the pixel (linear Rec. 709), the film's weight apart.
    pub rgb: [f32; 3],
}
