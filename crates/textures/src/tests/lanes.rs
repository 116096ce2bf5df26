//! Spectra in lanes have the bits of each texture's spectrum at its point.

use super::{LAMBDA, OneShape};
use crate::pixels::{Image, Pixels, Values};
use crate::{Bitmap, Constant, Filter, Texture, TextureTable, UvTransform, Wrap};
use core::f32::consts::PI;
use etalon_math::lane::{F32x8, F32x16, Lane, Spectral};
use etalon_spectrum::{Spectrum, SpectrumError};
use etalon_transport::{SpectrumKind, TextureId, TexturePoint};
use glam::{UVec2, Vec2, Vec4};
use std::sync::Arc;

/// The fractional parts of multiples of an irrational number.
fn number(i: usize) -> f32 {
    (i as f32 * PI).fract()
}

fn bitmap(role: SpectrumKind, bright: bool, wrap: Wrap, filter: Filter) -> Texture {
    let size = UVec2::new(3, 2);
    let colours = (0..6).map(|i| [number(i), number(i + 7), number(i + 20)]);
    let values = Values::Three(colours.collect());
    Texture::from(Bitmap {
        image: Arc::new(Image::new(Pixels { size, values }, false, role, bright).into()),
        filter,
        wrap,
        to_uv: UvTransform::IDENTITY,
    })
}

fn compare<F: Lane>(table: &TextureTable, ids: &[TextureId], shift: usize) {
    let id = |i: usize| ids[(i * 7 + shift) % ids.len()];
    let at = |i: usize| {
        let place = Vec2::new(number(3 * i + shift), number(5 * i + shift));
        TexturePoint::at_uv(place * 8.0 - 4.0)
    };
    let lambda = |i: usize| LAMBDA + Vec4::new(50.0, 20.0, -70.0, 230.0) * number(i + shift);
    let together = table.spectra::<F>(id, &OneShape, at, lambda);
    for i in 0..F::WIDTH {
        let alone = table.spectrum(id(i), &OneShape, &at(i), lambda(i));
        assert_eq!(together.at_lane(i), alone, "{:?}", table.get(id(i)));
    }
}

/// Of one kind and of several. Mutants rejected: the texture, the point or the wavelengths of another lane; lamps of colours without
/// D65; a factor of a bright texel that is left out; images of steps that are interpolated.
#[test]
fn lanes_have_the_spectra_of_each_texture() {
    let mut table = TextureTable::new();
    let mut add = |texture: Texture| table.add(texture);
    let constant = |spectrum: Result<Spectrum, SpectrumError>| {
        Texture::from(Constant::new(spectrum.expect("a valid spectrum")))
    };
    let colours = [[0.2, 0.9, 0.4], [0.7, 0.1, 0.1]].map(|rgb| {
        let reflected = add(constant(Spectrum::reflectance(rgb)));
        let lamp = add(constant(Spectrum::emission(rgb.map(|x| 9.0 * x))));
        [reflected, lamp]
    });
    let others = [
        add(Texture::from(Constant::uniform(0.3))),
        add(constant(Spectrum::blackbody(3000.0))),
        add(bitmap(
            SpectrumKind::Reflectance,
            false,
            Wrap::Repeat,
            Filter::Nearest,
        )),
    ];
    let images = [
        add(bitmap(
            SpectrumKind::Reflectance,
            false,
            Wrap::Mirror,
            Filter::Bilinear,
        )),
        add(bitmap(
            SpectrumKind::Unbounded,
            true,
            Wrap::Clamp,
            Filter::Bilinear,
        )),
    ];
    let [[a, b], [c, d]] = colours;
    let sets = [
        vec![a],
        vec![a, c],
        vec![b, d],
        images.to_vec(),
        others.to_vec(),
        vec![a, b],
    ];
    let all = sets.concat();
    for ids in sets.iter().chain([&all]) {
        for shift in 0..20 {
            compare::<f32>(&table, ids, shift);
            compare::<F32x8>(&table, ids, shift);
            compare::<F32x16>(&table, ids, shift);
        }
    }
}
