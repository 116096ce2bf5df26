//! Compiles a description tree into an immutable scene.
//!
//! [`compile()`] turns what a scene file said into a [`Compiled`]: the [`Scene`], which implements
//! [`etalon_transport::World`] for the integrators, and what the caller needs to render it.

pub mod builder;
mod camera_probe;
pub mod compile;
mod contents;
mod describe;
mod described_sensor;
mod measured_shape;
mod media;
mod parts;
mod rays;
pub mod sampler;
pub mod scene;
pub mod scene_tables;
mod sensor;
mod sensor_choice;
mod space;
pub mod surfaces;
mod transmittance;

pub use compile::{CompileOptions, Compiled, compile, compile_with};
pub use contents::Contents;
pub use describe::describe;
pub use etalon_geometry::AcceleratorKind;
pub use etalon_lights::LightSamplerKind;
pub use sampler::SamplerSettings;
pub use scene::Scene;
pub use sensor_choice::{PlacedSensor, SensorChoice, sensors};
pub use surfaces::Names;
