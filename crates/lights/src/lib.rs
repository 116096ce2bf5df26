//! Light sources: each can be hit, sampled and made to emit.
//!
//! A [`Light`] is one source as described. A [`LightSet`] is all of a scene's lights made ready:
//! it knows how large the scene is, how much each light emits, and which light to choose ([`LightSamplerKind`]). It is
//! what [`etalon_transport::World`]'s questions about light are forwarded to.
//!
//! | light | what its quantity is |
//! |---|---|
//! | `area` | radiance, W·m⁻²·sr⁻¹·nm⁻¹, on the outer side of a shape |
//! | `point`, `spot`, `goniometric` | radiant intensity, W·sr⁻¹·nm⁻¹ |
//! | `directional` | irradiance on a surface perpendicular to the light, W·m⁻²·nm⁻¹ |
//! | `constant`, `envmap`, `sunsky` | radiance from infinity, W·m⁻²·sr⁻¹·nm⁻¹ |

mod alike;
mod angular_table;
pub mod area;
pub mod bounding_sphere;
pub mod constant;
pub mod directional;
pub mod directional_area;
pub mod environment;
pub mod extent;
pub mod few;
mod goniometric;
mod ies_profile;
pub mod light;
mod light_model;
pub mod light_sampler;
pub mod point;
pub mod pose;
mod projector;
pub mod set;
mod sky;
mod sky_image;
pub mod spot;
mod spot_profile;
pub mod sunsky;
pub mod tree;

pub use area::AreaLight;
pub use bounding_sphere::BoundingSphere;
pub use constant::ConstantLight;
pub use directional::DirectionalLight;
pub use directional_area::DirectionalArea;
pub use environment::EnvironmentMap;
pub use extent::{LightBounds, LightExtent};
pub use few::FewLights;
pub use goniometric::Goniometric;
pub use light::{Light, LightDescription};
pub use light_sampler::{Candidate, Far, LightChoice, LightSampler, LightSamplerKind};
pub use point::PointLight;
pub use projector::Projector;
pub use set::LightSet;
pub use spot::SpotLight;
pub use sunsky::SunSky;
pub use tree::LightTree;

#[cfg(test)]
mod tests;
