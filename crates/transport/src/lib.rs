//! The types and contracts of light transport.
//!
//! Shapes, scattering models, lights, cameras and estimators depend on each other only through the
//! traits of this crate: an integrator never names a concrete material, a light never names a
//! concrete shape. Read this crate first, beginning with [`World`], [`Bsdf`] and [`Integrator`].
//!
//! Conventions: lengths in metres, wavelengths in nanometres, radiance in W·sr⁻¹·m⁻²·nm⁻¹.
//! `wo` is the known direction and `wi` the sampled one; both leave the point. A `Vec4` holds one
//! value per wavelength lane; lane 0 is the hero, which makes all random choices.

pub mod assets;
pub mod bsdf;
pub mod build;
pub mod camera;
pub mod diffusion;
pub mod film;
pub mod ids;
pub mod integrator;
pub mod lane_surface;
pub mod lanes;
pub mod leaving;
pub mod legacy_phong;
pub mod light;
pub mod light_sample_context;
pub mod medium;
pub mod mesh;
pub mod phase;
pub mod ray;
mod rolling_shutter;
pub mod sample_pdf;
pub mod scatterer;
pub mod scene_capabilities;
pub mod shapes;
pub mod shutter;
pub mod surface_interaction;
pub mod textures;
pub mod world;

pub use assets::{AssetError, Assets, MeshFormat, OpenFile, in_memory};
pub use bsdf::{Bsdf, BsdfSample, TransportMode};
pub use build::uniformity::{is_varying, refuse_varying};
pub use build::{Build, SpectrumKind, file};
pub use camera::{ApertureHit, Camera, CameraRay, CameraRays, CameraSample};
pub use diffusion::{DiffusionProfile, Exit, NoProfile};
pub use film::{Channel, Film, FilmSample, Placing, Sink, TileSink};
pub use ids::{InstanceId, LightId, MaterialId, MediumId, ShapeId, TextureId};
pub use integrator::{Integrator, Pass, PixelSample, Preparation, SampleJob};
pub use lane_surface::{LaneSurface, LaneVertices, ShadedPoint};
pub use lanes::{
    LaneBsdf, LaneBsdfSample, LaneKind, LaneLightSample, LanePoint, LaneReceiver, LaneShading,
    NoLanes,
};
pub use leaving::{Leaving, LeavingRays, LeftSurface};
pub use legacy_phong::LegacyPhong;
pub use light::{Emission, EmissionPdf, LightKind, LightSample, LightVariety};
pub use light_sample_context::LightSampleContext;
pub use medium::{Coefficients, Collision, FreeFlight, Medium, MediumInterface, Vacuum};
pub use mesh::{Attribute, MeshData};
pub use phase::{Phase, PhaseSample};
pub use ray::{Departure, Ray};
pub use rolling_shutter::{RollingShutter, RowExposure};
pub use sample_pdf::SamplePdf;
pub use scatterer::{PhaseOf, Scatterer, ScattererOf};
pub use scene_capabilities::{
    CameraProbe, Incompatibility, LightCount, LightSearch, SceneCapabilities, Subject,
};
pub use shapes::{SampledPoint, Shapes, SurfacePoint};
pub use shutter::Shutter;
pub use surface_interaction::{Hit, SurfaceInteraction};
pub use textures::{TexturePoint, Textures, gradient_by_differences};
pub use world::{
    BsdfOf, Lights, Media, MediumOf, NoMedia, Sensor, ShadowQuery, Surfaces, Transmission, World,
};
