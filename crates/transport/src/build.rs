//! Services for plugins while they are built from their descriptions.

pub mod file;
pub mod uniformity;

use crate::{Assets, Shutter, TextureId};
use etalon_params::{Node, Params};
use std::sync::Arc;

/// The role of a colour (Mitsuba's property rules in spectral mode).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpectrumKind {
    /// A reflectance or other quantity in [0, 1]: RGB is upsampled as is.
    Reflectance,
    /// Emitted light: RGB and plain numbers scale D65.
    Emission,
    /// A quantity without upper bound: RGB is upsampled with a scale.
    Unbounded,
    /// A refractive index or an extinction coefficient (η, k): without upper bound; a table is constant beyond its ends.
    Index,
    /// Numbers that are no colour, for [`crate::Textures::colour`]: three channels from this one on, zero where there
    /// are none.
    Raw(u8),
}

/// Services for plugins being built; implemented by the scene.
pub trait Build {
    /// The files of the scene.
    fn assets(&self) -> &dyn Assets;

    /// The interval during which things move.
    fn shutter(&self) -> Shutter;

    /// The texture or spectrum in the property `name`; the constant `default` if the property is
    /// absent; a diagnostic if it is absent and there is no default. After a mistake, any valid
    /// texture is returned and the mistake has been recorded.
    fn texture(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId;

    /// The same where it is asked at points of space, which are on no surface: what has values on surfaces only is refused.
    fn volume(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId;

    /// The texture described by a nested texture or spectrum object.
    fn nested_texture(&mut self, node: &Arc<Node>, role: SpectrumKind) -> TextureId;

    /// Whether textures of this plugin vary in space, regardless of their parameters.
    fn varies(&self, plugin: &str) -> bool;

    /// Pixels of a texture that is an image, width and height; 1 × 1 of anything else.
    fn resolution(&self, texture: TextureId) -> [u32; 2];

    /// A texture for a spectrum computed by the plugin itself (a named metal's η).
    fn spectrum(&mut self, spectrum: etalon_spectrum::Spectrum) -> TextureId;
}
