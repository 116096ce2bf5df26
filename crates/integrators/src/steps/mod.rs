//! The steps that estimators share: the camera's ray, where a path arrives, light samples, multiple importance sampling.

pub(crate) mod arrival;
pub(crate) mod camera_ray;
pub(crate) mod candidates;
pub mod dimensions;
pub(crate) mod light_connection;
pub(crate) mod light_mis;
pub(crate) mod light_path;
pub mod path_throughput;
pub mod settings;
pub(crate) mod visibility;
