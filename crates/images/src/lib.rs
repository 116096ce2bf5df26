//! Pixel buffers; reading and writing EXR, PNG, JPEG, BMP and HDR, bounded against hostile files.
//!
//! Renderings are [`Image`]s: named planes of 32-bit floats, read and written by [`exr`].
//! Pictures for textures and screens are [`Raster`]s: interleaved pixels with the sample type
//! they were stored in, read by [`raster`] and written by [`png`], [`hdr`] and [`pfm`].
//! Everything is written to a temporary name first ([`write_atomically`]), so no reader ever
//! sees half a file.

pub mod atomic_file;
pub mod error;
pub mod exr;
pub mod hdr;
pub mod losses;
pub mod pfm;
pub mod plane;
pub mod png;
pub mod raster;
pub mod srgb;

pub use atomic_file::write_atomically;
pub use error::Error;
pub use losses::Losses;
pub use plane::{Channel, Frame, Image};
pub use raster::{Format, Raster, RasterHeader, Samples};
