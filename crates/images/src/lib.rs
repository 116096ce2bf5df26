//! Pixel buffers; reading EXR, PNG, JPEG, BMP, TGA, PNM, HDR and PFM, bounded against hostile files,
//! and writing some of them.
//!
//! Renderings are [`Image`]s: named planes of 32-bit floats, read and written by [`exr`].
//! Pictures for textures and screens are [`Raster`]s: interleaved pixels with the sample type
//! they were stored in, read by [`raster_file`] and written by [`png`], [`hdr`] and [`pfm`].
//! Everything is written to a temporary name first ([`write_atomically`]), so no reader ever
//! sees half a file.

pub mod animated_png;
pub mod atomic_file;
pub mod chromaticities;
pub mod colour;
pub mod error;
pub mod exr;
mod foreign;
pub mod format;
pub mod halves;
pub mod hdr;
pub mod image;
pub mod jpeg;
mod layer_kind;
pub mod losses;
pub mod pfm;
pub mod png;
mod png_encoding;
pub mod raster;
pub mod raster_file;
pub mod srgb;
pub mod view;
pub mod volume;

pub use atomic_file::write_atomically;
pub use chromaticities::Chromaticities;
pub use colour::Colour;
pub use error::Error;
pub use format::{Format, lfs_pointer};
pub use image::{Channel, Frame, Image};
pub use losses::Losses;
pub use raster::{Raster, RasterHeader, Samples};
pub use view::{Development, View};
pub use volume::Volume;
