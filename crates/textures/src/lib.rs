//! Spectra and images that vary over surfaces.
//!
//! A [`Texture`] has three kinds of value at a point: a spectrum, a number, a raw colour. A scene keeps
//! its textures in a [`TextureTable`] and refers to them by [`etalon_transport::TextureId`];
//! [`TextureReader`] makes them from a scene description by Mitsuba's rules (which plugin a number, an
//! `rgb` or a `spectrum` property is short for).
//!
//! Texture coordinates follow Mitsuba: (0, 0) is the upper left corner of an image's first row,
//! v grows with the rows, and the centre of texel (i, j) of a w × h image is at
//! ((i + ½)/w, (j + ½)/h).

pub mod arithmetic;
pub mod bilinear_tap;
mod bitmap;
pub mod checkerboard;
pub mod coded;
pub mod computed;
pub mod constant;
pub mod decode;
pub mod extinction;
pub mod grid;
pub mod incandescence;
mod lane_texture;
pub mod mesh_attribute;
pub mod nanovdb;
pub mod palette;
pub mod picture;
pub mod pixels;
mod place;
pub mod procedural;
pub mod projected;
pub mod ramp;
pub mod reader;
mod recalled;
mod recoding;
pub mod recovered;
mod spectra;
pub mod texture;
pub mod texture_table;
pub mod times_d65;
pub mod uv_transform;
mod vol_file;

pub use arithmetic::Arithmetic;
pub use bilinear_tap::{Filter, Wrap};
pub use bitmap::Bitmap;
pub use checkerboard::Checkerboard;
pub use computed::Computed;
pub use constant::Constant;
pub use extinction::Extinction;
pub use grid::Grid;
pub use incandescence::Incandescence;
pub use mesh_attribute::MeshAttribute;
pub use picture::Picture;
pub use pixels::{Pixels, Texels};
pub use procedural::Procedural;
pub use projected::Projected;
pub use ramp::Ramp;
pub use reader::TextureReader;
pub use texture::Texture;
pub use texture_table::TextureTable;
pub use times_d65::TimesD65;
pub use uv_transform::UvTransform;

#[cfg(test)]
mod tests;
