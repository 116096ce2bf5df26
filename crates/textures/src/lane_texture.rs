//! Spectra of textures at several points in lanes: colours, images of colours, and anything else one by one.

use crate::bilinear_tap::BilinearTap;
use crate::coded::At;
use crate::picture::{Stored, ask};
use crate::pixels::Texels;
use crate::{Bitmap, Filter, Texture, TextureTable};
use etalon_math::lane::{Lane, Spectral};
use etalon_spectrum::{RgbCoefficients, RgbSpectrum, Spectrum, illuminants};
use etalon_transport::{Shapes, TextureId, TexturePoint};
use glam::{Vec2, Vec4};

/// How the spectrum of a texture is found. In lanes all must be found alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// It is that of a colour.
    Colour,
    /// Of a colour, times D65.
    Lit,
    /// Of an image of colours, interpolated.
    Image,
    /// Of anything else.
    Other,
}

/// What lanes ask of every texture first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneTexture {
    way: Way,
    /// The coefficients of a colour's spectrum, and a factor.
    colour: [f32; 4],
}

impl From<&Texture> for LaneTexture {
    fn from(texture: &Texture) -> Self {
        let of_colour = |way, colour: &RgbSpectrum| {
            let RgbCoefficients([a, b, c]) = colour.coefficients();
            let colour = [a, b, c, colour.scale()];
            Self { way, colour }
        };
        let way = match texture {
            Texture::Constant(constant) => match &constant.spectrum {
                Spectrum::Srgb(colour) => return of_colour(Way::Colour, colour),
                Spectrum::D65(colour) => return of_colour(Way::Lit, colour),
                _ => Way::Other,
            },
            Texture::Bitmap(bitmap) if bitmap.filter == Filter::Bilinear => {
                ask!(&bitmap.image.stored,
                    _numbers => Way::Other,
                    _raw => Way::Other,
                    _colours => Way::Image,
                    _bright => Way::Image
                )
            }
            _ => Way::Other,
        };
        let colour = [0.0; 4];
        Self { way, colour }
    }
}

impl Bitmap {
    /// The coefficients of a texel's spectrum, and a factor.
    #[inline]
    fn coefficients(&self, texel: usize) -> [f32; 4] {
        ask!(&self.image.stored,
            _numbers => unreachable!("an image of colours"),
            _raw => unreachable!("an image of colours"),
            colours => {
                let [a, b, c] = colours.at(texel);
                [a, b, c, 1.0]
            },
            bright => bright.at(texel)
        )
    }

    #[inline]
    fn tap(&self, uv: Vec2) -> BilinearTap {
        BilinearTap::bilinear(self.to_uv.apply(uv), self.image.size, self.wrap)
    }
}

/// The spectra of colours.
#[inline(always)]
fn colours<F: Lane>(
    colour: impl Fn(usize) -> [f32; 4],
    lit: bool,
    lambda: impl Fn(usize) -> Vec4,
) -> F::Spectrum {
    let [a, b, c, scale, i, j, k, l] = F::columns(|lane| {
        let ([a, b, c, scale], [i, j, k, l]) = (colour(lane), lambda(lane).to_array());
        [a, b, c, scale, i, j, k, l]
    });
    let lambda = F::Spectrum::from_waves([i, j, k, l]);
    let smooth = RgbCoefficients::eval_lanes::<F>([a, b, c], lambda) * scale;
    match lit {
        true => illuminants::white().eval_lanes::<F>(lambda) * smooth,
        false => smooth,
    }
}

/// The spectra of places of images.
#[inline(always)]
fn places<'b, F: Lane>(
    bitmap: impl Fn(usize) -> &'b Bitmap,
    uv: impl Fn(usize) -> Vec2,
    lambda: impl Fn(usize) -> Vec4,
) -> F::Spectrum {
    let taps = F::array(|i| bitmap(i).tap(uv(i)));
    let taps = taps.as_ref();
    let lambda = F::Spectrum::of_lanes(lambda);
    let [a, b, c, d] = [0, 1, 2, 3].map(|corner| {
        let [a, b, c, scale, weight, ..] = F::columns(|i| {
            let [a, b, c, scale] = bitmap(i).coefficients(taps[i].texels[corner]);
            [a, b, c, scale, taps[i].weights[corner], 0.0, 0.0, 0.0]
        });
        RgbCoefficients::eval_lanes::<F>([a, b, c], lambda) * scale * weight
    });
    a + b + (c + d)
}

impl TextureTable {
    /// [`TextureTable::spectrum`] of `texture(i)` at `at(i)` in lane i.
    #[inline]
    pub fn spectra<F: Lane>(
        &self,
        texture: impl Fn(usize) -> TextureId,
        shapes: &impl Shapes,
        at: impl Fn(usize) -> TexturePoint,
        lambda: impl Fn(usize) -> Vec4,
    ) -> F::Spectrum {
        let one_by_one =
            || F::Spectrum::of_lanes(|i| self.spectrum_at(texture(i), shapes, || at(i), lambda(i)));
        let way = self.in_lanes[texture(0).0 as usize].way;
        if F::WIDTH == 1 || way == Way::Other {
            return one_by_one();
        }
        let all = F::array(|i| &self.in_lanes[texture(i).0 as usize]);
        let all = all.as_ref();
        if !all.iter().all(|texture| texture.way == way) {
            return one_by_one();
        }
        if way == Way::Image {
            let bitmap = |i: usize| match self.get(texture(i)) {
                Texture::Bitmap(bitmap) => bitmap,
                _ => unreachable!("all are images"),
            };
            return places::<F>(bitmap, |i| at(i).uv, lambda);
        }
        colours::<F>(|i| all[i].colour, way == Way::Lit, lambda)
    }
}
