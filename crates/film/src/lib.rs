//! Films: reconstruction filters, exact accumulation per pixel, replicates and tile means.
//!
//! [`ExactFilm`] implements [`etalon_transport::Film`]. Rendering fills it replicate by
//! replicate; [`ExactFilm::develop`] computes a [`RenderedImage`], which has standard errors and can
//! be written to, and read from, an EXR file;
//! [`ExactFilm::into_part`] gives a [`Part`], which can be merged with others.

mod consistency;
mod exact_film;
mod exact_sums;
mod filter_sampler_1d;
mod footprint;
mod given_replicate;
mod layout;
mod pixel_moments;
mod placing;
mod running;
mod spread;
mod taps;
mod tile_sink;

pub mod checkpoint;
pub mod disagreement;
pub mod faults;
pub mod filter_method;
pub mod filters;
pub mod fingerprint;
pub mod framing;
pub mod glance;
pub mod light_carriers;
pub mod metadata;
pub mod outliers;
pub mod part;
pub mod part_facts;
pub mod pixel_filter;
pub mod pixel_format;
pub mod rendered_image;
pub mod replicate_set;
pub mod sample_counts;
pub mod settings;
pub mod tile_means;
pub mod unfinished;

pub use checkpoint::CheckpointFacts;
pub use disagreement::{Conflict, Disagreement, disagreements};
pub use exact_film::{ExactFilm, STANDARD_ERROR};
pub use exact_sums::EXACT;
pub use faults::{FaultLog, InvalidKind, InvalidSample};
pub use filter_method::FilterMethod;
pub use filters::{BoxFilter, CatmullRom, Filter, Gaussian, Lanczos, Mitchell, Tent, WideBox};
pub use fingerprint::floating_point_fingerprint;
pub use framing::{FilmSize, Framing};
pub use glance::Glance;
pub use light_carriers::LightCarriers;
pub use metadata::{FeatureFacts, FilmFacts, Metadata, RenderFacts, recorded_seconds};
pub use outliers::{Outlier, OutlierLog};
pub use part::Part;
pub use part_facts::PartFacts;
pub use pixel_filter::PixelFilter;
pub use pixel_format::PixelFormat;
pub use rendered_image::{ReadError, RenderedImage, read_developed};
pub use replicate_set::ReplicateSet;
pub use sample_counts::{DealtFacts, SAMPLES, SampleCounts};
pub use settings::{FileFormat, FilmSettings};
pub use tile_means::TileMeans;
pub use tile_sink::ExactTile;
pub use unfinished::UnfinishedFacts;
