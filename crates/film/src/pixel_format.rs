//! What a film stores of a colour: linear Rec. 709, CIE XYZ or luminance, with alpha or without, or bands of the spectrum.
//!
//! A colour is converted sample by sample, before anything is squared: the standard error of Y
//! does not follow from those of R, G and B, which are correlated.

use etalon_spectrum::colour_space::rgb_to_xyz;

/// The pixel formats of Mitsuba's `hdrfilm`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PixelFormat {
    /// `Y`.
    Luminance,
    /// `Y`, `A`.
    LuminanceAlpha,
    /// `R`, `G`, `B`.
    #[default]
    Rgb,
    /// `R`, `G`, `B`, `A`.
    Rgba,
    /// `X`, `Y`, `Z`.
    Xyz,
    /// `X`, `Y`, `Z`, `A`.
    Xyza,
    /// The bands of a spectral film, called as the film says.
    Bands,
}

impl PixelFormat {
    /// The pixel formats of `hdrfilm`, by their names in scenes.
    pub const ALL: [(&'static str, Self); 6] = [
        ("luminance", Self::Luminance),
        ("luminance_alpha", Self::LuminanceAlpha),
        ("rgb", Self::Rgb),
        ("rgba", Self::Rgba),
        ("xyz", Self::Xyz),
        ("xyza", Self::Xyza),
    ];

    /// The name of [`PixelFormat::Bands`] in files.
    pub const BANDS: &str = "bands";

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        let named = Self::ALL.iter().find(|(_, format)| *format == self);
        named.map_or(Self::BANDS, |(name, _)| *name)
    }

    /// The names of its colour channels, if they do not depend on the film.
    pub fn colours(self) -> &'static [&'static str] {
        match self {
            Self::Luminance | Self::LuminanceAlpha => &["Y"],
            Self::Rgb | Self::Rgba => &["R", "G", "B"],
            Self::Xyz | Self::Xyza => &["X", "Y", "Z"],
            Self::Bands => &[],
        }
    }

    /// Whether there is a channel `A` after the colours.
    pub fn has_alpha(self) -> bool {
        matches!(self, Self::LuminanceAlpha | Self::Rgba | Self::Xyza)
    }

    /// A linear Rec. 709 colour, or three bands, in this format; as many numbers count as it has colours.
    #[inline]
    pub fn convert(self, rgb: [f32; 3]) -> [f32; 3] {
        let xyz = || rgb_to_xyz(rgb.map(f64::from)).map(|x| x as f32);
        match self {
            Self::Rgb | Self::Rgba | Self::Bands => rgb,
            Self::Xyz | Self::Xyza => xyz(),
            Self::Luminance | Self::LuminanceAlpha => [xyz()[1], 0.0, 0.0],
        }
    }
}
