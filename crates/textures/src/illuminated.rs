//! `d65` around another texture: a colour image that emits, scale · D65(λ) · t(λ).

use etalon_transport::TextureId;
use glam::Vec4;
use std::sync::LazyLock;

/// D65, scaled so that it looks white with luminance one.
static WHITE: LazyLock<etalon_spectrum::Regular> =
    LazyLock::new(etalon_spectrum::illuminants::d65_spectrum);

/// A texture times D65.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illuminated {
    /// What varies over the surface.
    pub inner: TextureId,
    /// A factor.
    pub scale: f32,
}

impl Illuminated {
    /// The factor at four wavelengths (nm).
    #[inline]
    pub fn factor(&self, lambda: Vec4) -> Vec4 {
        WHITE.eval(lambda) * self.scale
    }
}
