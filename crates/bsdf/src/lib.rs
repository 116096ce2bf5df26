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

pub mod lobe;
pub mod lobe_list;
pub mod model;
pub mod models;
pub mod resolved;
pub mod tilt;
pub mod traits;

pub mod diffuse_base;
pub mod disney;
pub mod fresnel;
mod inputs;
pub mod ior;
pub mod metal;
pub mod microfacet;
pub mod quadrature;
pub mod refraction;
pub mod rough_fresnel;
pub mod roughness;

pub mod blendbsdf;
pub mod bumpmap;
pub mod classicphong;
pub mod coating;
pub mod conductor;
pub mod dielectric;
pub mod difftrans;
pub mod diffuse;
pub mod hair;
pub mod mask;
pub mod measured;
pub mod mirror;
pub mod mixture;
pub mod mixturebsdf;
pub mod normalmap;
pub mod null;
pub mod phong;
pub mod plastic;
pub mod pplastic;
pub mod principled;
pub mod principledthin;
pub mod roughcoating;
pub mod roughconductor;
pub mod roughdielectric;
pub mod roughdiffuse;
pub mod roughplastic;
pub mod thindielectric;
pub mod twosided;
pub mod ward;

pub use lobe::Lobe;
pub use lobe_list::{LobeList, ShadingContext};
pub use model::Bxdf;
pub use models::{AnyBxdf, Material, plugin_names, test_materials};
pub use resolved::{BsdfAtPoint, MAX_LOBES};
pub use traits::MaterialFlags;
