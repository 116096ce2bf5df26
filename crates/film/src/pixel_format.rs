//! What a film stores of a colour: linear Rec. 709, CIE XYZ or luminance, with alpha or without.
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
}

impl PixelFormat {
    /// All of them, by the names that scenes use.
    pub const ALL: [(&'static str, Self); 6] = [
        ("luminance", Self::Luminance),
        ("luminance_alpha", Self::LuminanceAlpha),
        ("rgb", Self::Rgb),
        ("rgba", Self::Rgba),
        ("xyz", Self::Xyz),
        ("xyza", Self::Xyza),
    ];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(_, format)| *format == self)
            .map(|(name, _)| *name)
            .expect("all formats have a name")
    }

    /// The names of its colour channels.
    pub fn colours(self) -> &'static [&'static str] {
        match self {
            Self::Luminance | Self::LuminanceAlpha => &["Y"],
            Self::Rgb | Self::Rgba => &["R", "G", "B"],
            Self::Xyz | Self::Xyza => &["X", "Y", "Z"],
        }
    }

    /// Whether there is a channel `A` after the colours.
    pub fn has_alpha(self) -> bool {
        matches!(self, Self::LuminanceAlpha | Self::Rgba | Self::Xyza)
    }

    /// A linear Rec. 709 colour in this format; the first `self.colours().len()` numbers count.
    #[inline]
    pub fn convert(self, rgb: [f32; 3]) -> [f32; 3] {
        let xyz = || rgb_to_xyz(rgb.map(f64::from)).map(|x| x as f32);
        match self {
            Self::Rgb | Self::Rgba => rgb,
            Self::Xyz | Self::Xyza => xyz(),
            Self::Luminance | Self::LuminanceAlpha => [xyz()[1], 0.0, 0.0],
        }
    }
}
