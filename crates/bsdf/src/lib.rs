//! Scattering models, one file each, and their resolution at a hit.
//!
//! A [`Material`] is the description from the scene file: a model's parameters with textures. At a
//! hit it *resolves* ([`Material::resolve`]) into a [`BsdfAtPoint`]: a small `Copy` value that knows
//! neither textures nor scene and implements [`etalon_transport::Bsdf`]. `twosided` disappears there;
//! `mask` and `blendbsdf` flatten into at most [`MAX_LOBES`] weighted lobes plus a null lobe.
//!
//! Each model is one file: its equation and source, its textured description, its plain
//! [`Bxdf`] in a local frame whose z is the shading normal, and its exemplars, the materials that
//! the tests run on. The list of all of them is in [`models`].
//!
//! Everywhere `wo` is the known direction, `wi` the sampled one, both leave the point, and values
//! include |cos θi|. A model's density has a value per wavelength lane: the density had that lane
//! been the one that chose.

mod bsdf_at_point;
mod bxdf;
mod inputs;
pub mod interface;
mod lane_bsdf_at_point;
mod lane_model;
pub mod layers;
pub mod lobe;
pub mod lobe_list;
mod material_flags;
pub mod microfacet;
pub mod models;
pub mod quadrature;
mod texture_site;
pub mod tilt;

pub use bsdf_at_point::{BsdfAtPoint, MAX_LOBES};
pub use bxdf::Bxdf;
pub use lane_bsdf_at_point::LaneBsdfAtPoint;
pub use lane_model::LaneModel;
pub use lobe::Lobe;
pub use lobe_list::{LobeList, ShadingContext};
pub use material_flags::MaterialFlags;
pub use models::{AnyBxdf, Material, plugin_names, test_materials};
pub use texture_site::TextureSite;
