//! `bitmap`: an image as a texture.
//!
//! A spectrum is interpolated as Mitsuba does it: the spectra of the four texels around the
//! point are evaluated and averaged with the bilinear weights, t(λ) = Σᵢ wᵢ S(cᵢ; λ). Averaging
//! the coefficients cᵢ instead would give colours that are in none of the texels.

use crate::bilinear_tap::BilinearTap;
use crate::coded::At;
use crate::decode::ImageChannel;
use crate::picture::{FilePixels, Picture, Stored, ask};
use crate::pixels::{Texels, Values};
use crate::reader::Use;
use crate::recoding::Recoding;
use crate::recovered::{self, luminance};
use crate::texture::TextureModel;
use crate::{Filter, Texture, TextureReader, TextureTable, UvTransform, Wrap};
use etalon_params::{Diagnostic, Params};
use etalon_spectrum::RgbCoefficients;
use etalon_transport::{Shapes, SpectrumKind, TexturePoint, file};
use glam::{UVec2, Vec2, Vec3, Vec4};
use std::ops::{Add, Mul};
use std::sync::Arc;

/// An image with its way of being looked up. Cloning shares the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Bitmap {
    /// The image.
    pub image: Arc<Picture>,
    /// `filter_type`.
    pub filter: Filter,
    /// `wrap_mode`.
    pub wrap: Wrap,
    /// `to_uv`.
    pub to_uv: UvTransform,
}

impl Bitmap {
    /// Width and height in pixels.
    pub(crate) fn resolution(&self) -> [u32; 2] {
        self.image.size.to_array()
    }

    /// Σ wᵢ f(texel i).
    #[inline]
    fn average<T>(&self, uv: Vec2, value: impl Fn(usize) -> T) -> T
    where
        T: Add<Output = T> + Mul<f32, Output = T>,
    {
        let uv = self.to_uv.apply(uv);
        match self.filter {
            Filter::Bilinear => {
                let BilinearTap {
                    texels: [a, b, c, d],
                    weights: w,
                } = BilinearTap::bilinear(uv, self.image.size, self.wrap);
                value(a) * w[0] + value(b) * w[1] + (value(c) * w[2] + value(d) * w[3])
            }
            Filter::Nearest => {
                let (texel, share) = BilinearTap::nearest(uv, self.image.size, self.wrap);
                value(texel) * share
            }
        }
    }

    /// The spectrum at `uv`.
    #[inline]
    pub fn spectrum(&self, uv: Vec2, lambda: Vec4) -> Vec4 {
        ask!(&self.image.stored,
            numbers => Vec4::splat(self.average(uv, |i| numbers.at(i))),
            // Does not occur in scenes that Mitsuba accepts; the channels are taken for a colour.
            raw => {
                let rgb = self.average(uv, |i| Vec3::from_array(raw.at(i)));
                RgbCoefficients::from_rgb(rgb.to_array()).eval(lambda)
            },
            colours => self.average(uv, |i| RgbCoefficients(colours.at(i)).eval(lambda)),
            bright => self.average(uv, |i| {
                let [a, b, c, scale] = bright.at(i);
                RgbCoefficients([a, b, c]).eval(lambda) * scale
            })
        )
    }

    /// The number at `uv`: the luminance of a colour.
    #[inline]
    pub fn number(&self, uv: Vec2) -> f32 {
        ask!(&self.image.stored,
            numbers => self.average(uv, |i| numbers.at(i)),
            _raw => luminance(self.colour(uv)),
            _colours => luminance(self.colour(uv)),
            _bright => luminance(self.colour(uv))
        )
    }

    /// (∂/∂u, ∂/∂v) of the number at `uv`: exact where it is interpolated; an image of steps has none.
    pub fn gradient(&self, uv: Vec2) -> Vec2 {
        if self.filter == Filter::Nearest {
            return Vec2::ZERO;
        }
        let at = self.to_uv.apply(uv);
        let number = |texel: usize| -> f32 {
            ask!(&self.image.stored,
                numbers => numbers.at(texel),
                raw => luminance(Vec3::from_array(raw.at(texel))),
                colours => luminance(recovered::colour(|lambda| {
                    RgbCoefficients(colours.at(texel)).eval(lambda)
                })),
                bright => luminance(recovered::colour(|lambda| {
                    let [a, b, c, scale] = bright.at(texel);
                    RgbCoefficients([a, b, c]).eval(lambda) * scale
                }))
            )
        };
        let along = |BilinearTap { texels, weights }: BilinearTap| -> f32 {
            let terms = texels.into_iter().zip(weights);
            terms.map(|(texel, weight)| number(texel) * weight).sum()
        };
        let [u, v] = BilinearTap::slopes(at, self.image.size, self.wrap).map(along);
        self.to_uv.gradient(Vec2::new(u, v))
    }

    /// The channels at `uv`: as stored, or those of the colour.
    #[inline]
    pub fn colour(&self, uv: Vec2) -> Vec3 {
        let recovered = || recovered::colour(|lambda| self.spectrum(uv, lambda));
        ask!(&self.image.stored,
            numbers => Vec3::splat(self.average(uv, |i| numbers.at(i))),
            raw => self.average(uv, |i| Vec3::from_array(raw.at(i))),
            _colours => recovered(),
            _bright => recovered()
        )
    }
}

impl TextureModel for Bitmap {
    const VARIES: bool = true;

    #[inline]
    fn spectrum(&self, _: &TextureTable, _: &impl Shapes, at: &TexturePoint, lambda: Vec4) -> Vec4 {
        Self::spectrum(self, at.uv, lambda)
    }

    #[inline]
    fn number(&self, _: &TextureTable, _: &impl Shapes, at: &TexturePoint) -> f32 {
        Self::number(self, at.uv)
    }

    fn gradient(&self, _: &TextureTable, _: &impl Shapes, at: &TexturePoint, _: [Vec3; 2]) -> Vec2 {
        Self::gradient(self, at.uv)
    }

    #[inline]
    fn colour(&self, _: &TextureTable, _: &impl Shapes, at: &TexturePoint) -> Vec3 {
        Self::colour(self, at.uv)
    }

    fn mean(&self, _: &TextureTable) -> f32 {
        self.image.mean
    }

    fn is_constant(&self, _: &TextureTable) -> bool {
        self.image.size == UVec2::ONE && self.wrap != Wrap::Zero
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        Some("a `gridvolume` has values in space")
    }
}

pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let raw = params.boolean_or("raw", false) || file::is_linear(params);
    let channel = channel(params);
    let filter = filter(params);
    let wrap = wrap(params);
    let to_uv = UvTransform::from_params(params);
    let Some(filename) = params.string("filename") else {
        if !params.has("filename") {
            params.missing("filename", "the name of an image file");
        }
        return None;
    };
    let recoding = Recoding::read(params);
    let image = image(reader, params, filename, (raw, channel, recoding), role)?;
    Some(Texture::from(Bitmap {
        image,
        filter,
        wrap,
        to_uv,
    }))
}

/// The image in a file, prepared for lookup; files are read once.
fn image(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    filename: &str,
    (raw, channel, recoding): (bool, Option<ImageChannel>, Recoding),
    role: SpectrumKind,
) -> Option<Arc<Picture>> {
    let is_bounded = role == SpectrumKind::Reflectance;
    let key = (
        filename.to_owned(),
        raw,
        channel,
        is_bounded,
        recoding.key(),
    );
    if let Some(image) = reader.set.images.get(&key) {
        return Some(Arc::clone(image));
    }
    let property = params.property("filename")?;
    let fail = |message: String, help: Option<String>| {
        let mut diagnostic = Diagnostic::error(property.span, message);
        diagnostic.help = help;
        reader.diagnostics.push(diagnostic);
    };
    let mut file = match reader.assets.open(filename) {
        Ok(file) => file,
        Err(error) => {
            fail(error.message, error.help);
            return None;
        }
    };
    let plain = raw || recoding.has_exponent();
    let (size, pixels, notes) = match FilePixels::decode(&mut *file, plain, channel, filename) {
        Ok(decoded) => decoded,
        Err(message) => {
            fail(message, None);
            return None;
        }
    };
    for note in notes {
        reader
            .diagnostics
            .push(Diagnostic::note(property.span, note));
    }
    let pixels = recoding.apply(pixels, size);
    let negative =
        matches!(&pixels, FilePixels::Floats(Values::One(v)) if v.iter().any(|&x| x < 0.0));
    if negative && role == SpectrumKind::Emission {
        fail(
            format!("`{filename}` has negative values, which no light can emit"),
            None,
        );
        return None;
    }
    let image = Picture::new(size, pixels, raw, role);
    if image.moved > 0 {
        let UVec2 { x, y } = image.size;
        let message = format!(
            "{} of the {} texels of `{filename}` lie outside of what this colour can be; \
             their components count as the nearest that can",
            image.moved,
            u64::from(x) * u64::from(y),
        );
        reader
            .diagnostics
            .push(Diagnostic::note(property.span, message));
    }
    let image = Arc::new(image);
    reader.set.images.insert(key, Arc::clone(&image));
    Some(image)
}

/// Mitsuba 0.6's `channel`: one of an image's, as a number.
fn channel(params: &Params<'_>) -> Option<ImageChannel> {
    match params.choice("channel", "all", &["all", "r", "g", "b", "a"]) {
        "r" => Some(ImageChannel::Colour(0)),
        "g" => Some(ImageChannel::Colour(1)),
        "b" => Some(ImageChannel::Colour(2)),
        "a" => Some(ImageChannel::Alpha),
        _ => None,
    }
}

/// `filter_type`. Those of other versions of Mitsuba that average over a pixel's footprint are left to the
/// samples of the pixel, with a note.
fn filter(params: &Params<'_>) -> Filter {
    let names = ["bilinear", "nearest", "trilinear", "ewa", "anisotropic"];
    match params.choice("filter_type", "bilinear", &names) {
        "nearest" => Filter::Nearest,
        "bilinear" => Filter::Bilinear,
        other => {
            let span = params.property("filter_type").map(|p| p.span);
            let message = format!(
                "`{other}` is read as `bilinear`: a pixel's samples average over the texels it sees"
            );
            let span = span.unwrap_or(params.node.plugin.span);
            params.diagnostics.push(Diagnostic::note(span, message));
            Filter::Bilinear
        }
    }
}

/// `wrap_mode`, or Mitsuba 0.6's `wrap_mode_u` and `wrap_mode_v`, which must agree.
fn wrap(params: &Params<'_>) -> Wrap {
    let read = |name, default| params.choice(name, default, &["repeat", "mirror", "clamp", "zero"]);
    let both = read("wrap_mode", "repeat");
    let [u, v] = ["wrap_mode_u", "wrap_mode_v"].map(|name| read(name, both));
    if u != v {
        let message = format!("one mode for both directions is built, not `{u}` and `{v}`");
        params.error_at("wrap_mode_v", message);
    }
    match u {
        "mirror" => Wrap::Mirror,
        "clamp" => Wrap::Clamp,
        "zero" => Wrap::Zero,
        _ => Wrap::Repeat,
    }
}
