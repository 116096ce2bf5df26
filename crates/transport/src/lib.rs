//! The nouns and contracts of light transport; no implementation.
//!
//! A shape, a scattering model, a light, a camera and an estimator meet only through what is
//! defined here: an integrator never names a concrete material, a light never names a concrete
//! shape. Read this crate first; it takes twenty minutes.
//!
//! Conventions: lengths in metres, wavelengths in nanometres, radiance in W·sr⁻¹·m⁻²·nm⁻¹.
//! `wo` is the known direction and `wi` the sampled one; both leave the point. A `Vec4` holds one
//! value per wavelength lane; lane 0 is the lane that chooses.

pub mod assets;
pub mod bsdf;
pub mod build;
pub mod camera;
pub mod chance;
pub mod classic;
pub mod film;
pub mod ids;
pub mod integrator;
pub mod light;
pub mod mesh;
pub mod phase;
pub mod ray;
pub mod receiver;
pub mod remark;
pub mod shapes;
pub mod sight;
pub mod textures;
pub mod vertex;
pub mod world;

pub use assets::{AssetError, Assets, MeshFormat};
pub use bsdf::{Bsdf, BsdfSample, Mode};
pub use build::{Build, Role};
pub use camera::{Camera, CameraRay, Connection, Reception};
pub use chance::Chance;
pub use classic::ClassicPhong;
pub use film::{Channel, Film, Placement, Placing, Sink, TileSink};
pub use ids::{InstanceId, LightId, MaterialId, ShapeId, TextureId};
pub use integrator::{Draft, Integrator, Pass, PixelSite};
pub use light::{Emission, EmissionDensity, LightSample, LightVariety, Origin};
pub use mesh::{Attribute, MeshData};
pub use phase::{Phase, PhaseSample};
pub use ray::{Departure, Ray};
pub use receiver::Receiver;
pub use remark::{ChainRemark, MergedPhoton, Mixed, Mixture, Remark};
pub use shapes::{SampledPoint, Shapes, SurfacePoint};
pub use sight::{Finding, LightCount, Objection, Sight, Subject, View};
pub use textures::{TexturePoint, Textures};
pub use vertex::{Hit, Vertex};
pub use world::{Passage, World};
