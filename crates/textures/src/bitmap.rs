//! `bitmap`: an image as a texture.
//!
//! A spectrum is interpolated as Mitsuba does it: the spectra of the four texels around the
//! point are evaluated and averaged with the bilinear weights, t(λ) = Σᵢ wᵢ S(cᵢ; λ). Averaging
//! the coefficients cᵢ instead would give colours that are in none of the texels.

use crate::footprint::Footprint;
use crate::pixels::{Image, Texels};
use crate::recovered::{self, luminance};
use crate::{Filter, UvTransform, Wrap};
use etalon_spectrum::RgbCoefficients;
use glam::{Vec2, Vec3, Vec4};
use std::ops::{Add, Mul};
use std::sync::Arc;

/// An image with its way of being looked up. Cloning shares the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Bitmap {
    /// The image.
    pub image: Arc<Image>,
    /// `filter_type`.
    pub filter: Filter,
    /// `wrap_mode`.
    pub wrap: Wrap,
    /// `to_uv`.
    pub to_uv: UvTransform,
}

impl Bitmap {
    /// Σ wᵢ f(texel i).
    #[inline]
    fn average<T>(&self, uv: Vec2, value: impl Fn(usize) -> T) -> T
    where
        T: Add<Output = T> + Mul<f32, Output = T>,
    {
        let uv = self.to_uv.apply(uv);
        match self.filter {
            Filter::Bilinear => {
                let Footprint {
                    texels: [a, b, c, d],
                    weights: w,
                } = Footprint::bilinear(uv, self.image.size, self.wrap);
                value(a) * w[0] + value(b) * w[1] + (value(c) * w[2] + value(d) * w[3])
            }
            Filter::Nearest => value(Footprint::nearest(uv, self.image.size, self.wrap)),
        }
    }

    /// The spectrum at `uv`.
    #[inline]
    pub fn spectrum(&self, uv: Vec2, lambda: Vec4) -> Vec4 {
        match &self.image.texels {
            Texels::Number(texels) => Vec4::splat(self.average(uv, |i| texels[i])),
            Texels::Colour(texels) => self.average(uv, |i| RgbCoefficients(texels[i]).eval(lambda)),
            Texels::Bright(texels) => self.average(uv, |i| {
                let [a, b, c, scale] = texels[i];
                RgbCoefficients([a, b, c]).eval(lambda) * scale
            }),
            // Not asked for by scenes that Mitsuba accepts; the channels name a colour then.
            Texels::Raw(texels) => {
                let rgb = self.average(uv, |i| Vec3::from_array(texels[i]));
                RgbCoefficients::from_rgb(rgb.to_array()).eval(lambda)
            }
        }
    }

    /// The number at `uv`: the luminance of a colour.
    #[inline]
    pub fn number(&self, uv: Vec2) -> f32 {
        match &self.image.texels {
            Texels::Number(texels) => self.average(uv, |i| texels[i]),
            _ => luminance(self.colour(uv)),
        }
    }

    /// The channels at `uv`: as stored, or those of the colour.
    #[inline]
    pub fn colour(&self, uv: Vec2) -> Vec3 {
        match &self.image.texels {
            Texels::Number(texels) => Vec3::splat(self.average(uv, |i| texels[i])),
            Texels::Raw(texels) => self.average(uv, |i| Vec3::from_array(texels[i])),
            Texels::Colour(_) | Texels::Bright(_) => {
                recovered::colour(|lambda| self.spectrum(uv, lambda))
            }
        }
    }
}
