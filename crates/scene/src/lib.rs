//! Compiles a description tree into an immutable scene.
//!
//! [`compile()`] turns what a scene file said into a [`Compiled`]: the [`Scene`], which implements
//! [`etalon_transport::World`] for the integrators, and what the caller needs to render it.

mod attributes;
mod bodies;
pub mod builder;
mod capabilities;
pub mod compile;
pub mod contents;
mod dark_media;
mod displacement;
mod emission_medium;
mod groups;
mod homogeneous_media;
pub mod lookup;
mod media;
mod medium_lights;
mod merge;
mod parts;
mod passage;
mod rays;
pub mod sampler;
pub mod scene;
mod sensor;
mod sensor_choice;
mod short_flights;
mod solids;
mod space;
mod subsurface;
pub mod surfaces;
mod view;

pub use capabilities::Contents;
pub use compile::{CompileOptions, Compiled, compile, compile_with};
pub use etalon_geometry::AcceleratorKind;
pub use etalon_lights::LightSamplerKind;
pub use sampler::SamplerSettings;
pub use scene::Scene;
pub use sensor_choice::SensorChoice;
pub use surfaces::Names;
