//! `d65` around another texture: a colour image that emits, scale · D65(λ) · t(λ).

use crate::reader::Use;
use crate::texture::TextureModel;
use crate::{Constant, Texture, TextureReader, TextureTable};
use etalon_params::{Class, Params, Value};
use etalon_spectrum::{Spectrum, illuminants};
use etalon_transport::TextureId;
use etalon_transport::{Shapes, SpectrumKind, TexturePoint};
use glam::Vec3;
use glam::Vec4;

/// A texture times D65.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimesD65 {
    /// The texture that is multiplied.
    pub inner: TextureId,
    /// A factor.
    pub scale: f32,
}

impl TimesD65 {
    /// The factor at four wavelengths (nm).
    #[inline]
    pub fn factor(&self, lambda: Vec4) -> Vec4 {
        illuminants::white().eval(lambda) * self.scale
    }
}

impl TextureModel for TimesD65 {
    const VARIES: bool = false;

    #[inline]
    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        set.spectrum(self.inner, shapes, at, lambda) * self.factor(lambda)
    }

    #[inline]
    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        set.number(self.inner, shapes, at) * self.scale
    }

    #[inline]
    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        set.colour(self.inner, shapes, at) * self.scale
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        set.mean(self.inner) * self.scale
    }

    fn is_constant(&self, set: &TextureTable) -> bool {
        set.is_constant(self.inner)
    }

    fn nested(&self) -> &[TextureId] {
        std::slice::from_ref(&self.inner)
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        None
    }
}

/// A colour becomes one spectrum; a texture is multiplied at look-up.
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    purpose: Use,
) -> Option<Texture> {
    let scale = params.float_where("scale", 1.0, "a finite number not below 0", |x| {
        x >= 0.0 && x.is_finite()
    }) as f32;
    let children = params.children(Class::Texture);
    let colour = params.property("color");
    let spectrum = match (colour, children.as_slice()) {
        (None, []) => Spectrum::d65(1.0).ok(),
        (Some(property), []) => {
            let emission = Use {
                role: SpectrumKind::Emission,
                nested: false,
            };
            match &property.value {
                Value::Rgb(rgb) => reader.colour(*rgb, emission, property.span),
                other => {
                    let kind = other.kind();
                    params.error_at(
                        "color",
                        format!("`color` must be an rgb colour, not {kind}"),
                    );
                    None
                }
            }
        }
        (None, [(property, _)]) => {
            let nested = Use {
                role: SpectrumKind::Emission,
                nested: true,
            };
            let inner = reader.value(property, nested);
            return Some(Texture::TimesD65(TimesD65 { inner, scale }));
        }
        _ => {
            params.error("`d65` takes either `color` or one nested texture");
            None
        }
    }?;
    let spectrum = reader.held(spectrum.scaled(scale), purpose, params.node.plugin.span);
    Some(Texture::Constant(Constant::new(spectrum)))
}
