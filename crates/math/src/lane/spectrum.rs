//! Four numbers per lane: what a quantity is at a path's four wavelengths.
//!
//! Operations are written out: arrays of vectors that are mapped stay loops through memory.

use super::{Lane, Select};
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Sub};

/// A quantity at four wavelengths, each in lanes: [`glam::Vec4`] for one number, [`Spectrum`] for a vector of them, with the same
/// bits.
pub trait Spectral<F: Lane>:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<F, Output = Self>
    + Sub<F, Output = Self>
    + Mul<F, Output = Self>
    + Div<F, Output = Self>
{
    /// The quantity at each wavelength.
    fn from_waves(waves: [F; 4]) -> Self;
    /// The same.
    fn waves(self) -> [F; 4];
    /// (first + second) + (third + fourth).
    fn sum(self) -> F;
    /// The greatest of the four.
    fn greatest(self) -> F;

    /// The same at every wavelength.
    #[inline(always)]
    fn uniform(value: F) -> Self {
        Self::from_waves([value; 4])
    }

    /// The same spectrum in every lane.
    #[inline(always)]
    fn broadcast(spectrum: glam::Vec4) -> Self {
        let [a, b, c, d] = spectrum.to_array();
        Self::from_waves([F::splat(a), F::splat(b), F::splat(c), F::splat(d)])
    }

    /// `spectrum(i)` in lane i.
    #[inline(always)]
    fn of_lanes(spectrum: impl Fn(usize) -> glam::Vec4) -> Self {
        let [a, b, c, d, ..] = F::columns(|i| {
            let [a, b, c, d] = spectrum(i).to_array();
            [a, b, c, d, 0.0, 0.0, 0.0, 0.0]
        });
        Self::from_waves([a, b, c, d])
    }

    /// Two spectra, `pair(i)` in lane i.
    #[inline(always)]
    fn pairs_of_lanes(pair: impl Fn(usize) -> [glam::Vec4; 2]) -> [Self; 2] {
        let [a, b, c, d, e, f, g, h] = F::columns(|i| {
            let [[a, b, c, d], [e, f, g, h]] = pair(i).map(|spectrum| spectrum.to_array());
            [a, b, c, d, e, f, g, h]
        });
        [[a, b, c, d], [e, f, g, h]].map(Self::from_waves)
    }

    /// The pair of spectra in any lane.
    #[inline(always)]
    fn pairs(pair: [Self; 2]) -> impl Fn(usize) -> [glam::Vec4; 2] {
        let [[a, b, c, d], [e, f, g, h]] = pair.map(Self::waves);
        let rows = F::rows([a, b, c, d, e, f, g, h]);
        move |i| {
            let [a, b, c, d, e, f, g, h] = rows.as_ref()[i];
            [[a, b, c, d], [e, f, g, h]].map(glam::Vec4::from)
        }
    }

    /// The spectrum in lane `index`.
    #[inline(always)]
    fn at_lane(self, index: usize) -> glam::Vec4 {
        let [a, b, c, d] = self.waves();
        glam::Vec4::new(a.lane(index), b.lane(index), c.lane(index), d.lane(index))
    }

    /// The number at the wavelength that chooses where only one can.
    #[inline(always)]
    fn hero(self) -> F {
        let [hero, ..] = self.waves();
        hero
    }

    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (yes.waves(), no.waves());
        let choose = |yes, no| mask.select(yes, no);
        Self::from_waves([choose(a, e), choose(b, f), choose(c, g), choose(d, h)])
    }

    /// Each without its sign.
    #[inline(always)]
    fn magnitudes(self) -> Self {
        self.at_each(F::abs)
    }

    /// That of `yes` where the quantity is below 0, that of `no` elsewhere.
    fn where_negative(self, yes: Self, no: Self) -> Self;

    /// Each, or `least` if that is greater; NaN remains.
    fn at_least(self, least: F) -> Self;

    /// Each where it is less than `most`; `most` in place of what is not, NaN too.
    fn below(self, most: F) -> Self;

    /// The square root of each.
    fn square_roots(self) -> Self;

    /// The result of `function` at each wavelength.
    #[inline(always)]
    fn at_each(self, function: impl Fn(F) -> F) -> Self {
        let [a, b, c, d] = self.waves();
        Self::from_waves([function(a), function(b), function(c), function(d)])
    }

    /// Whether it is the same at every wavelength.
    #[inline(always)]
    fn is_uniform(self) -> F::Mask {
        let [a, b, c, d] = self.waves();
        Lane::eq(a, b) & (Lane::eq(a, c) & Lane::eq(a, d))
    }

    /// Whether it is 0 at every wavelength.
    #[inline(always)]
    fn is_zero(self) -> F::Mask {
        let [a, b, c, d] = self.waves();
        let zero = |value| Lane::eq(value, F::ZERO);
        (zero(a) & zero(b)) & (zero(c) & zero(d))
    }
}

/// Some operations have instructions of their own.
impl Spectral<f32> for glam::Vec4 {
    #[inline(always)]
    fn from_waves(waves: [f32; 4]) -> Self {
        waves.into()
    }
    #[inline(always)]
    fn waves(self) -> [f32; 4] {
        self.to_array()
    }
    #[inline(always)]
    fn uniform(value: f32) -> Self {
        Self::splat(value)
    }
    #[inline(always)]
    fn broadcast(spectrum: glam::Vec4) -> Self {
        spectrum
    }
    #[inline(always)]
    fn of_lanes(spectrum: impl Fn(usize) -> glam::Vec4) -> Self {
        spectrum(0)
    }
    #[inline(always)]
    fn hero(self) -> f32 {
        self.x
    }
    #[inline(always)]
    fn is_uniform(self) -> bool {
        self == Self::splat(self.x)
    }
    #[inline(always)]
    fn sum(self) -> f32 {
        self.element_sum()
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        self.max_element()
    }
    #[inline(always)]
    fn magnitudes(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn where_negative(self, yes: Self, no: Self) -> Self {
        Self::select(self.cmplt(Self::ZERO), yes, no)
    }
    #[inline(always)]
    fn at_least(self, least: f32) -> Self {
        let least = Self::splat(least);
        Self::select(least.cmpgt(self), least, self)
    }
    #[inline(always)]
    fn below(self, most: f32) -> Self {
        let most = Self::splat(most);
        Self::select(self.cmplt(most), self, most)
    }
    #[inline(always)]
    fn square_roots(self) -> Self {
        self.sqrt()
    }
}

/// A quantity at four wavelengths, in vectors of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum<F>(pub [F; 4]);

impl<F: Lane> Spectral<F> for Spectrum<F> {
    #[inline(always)]
    fn from_waves(waves: [F; 4]) -> Self {
        Self(waves)
    }
    #[inline(always)]
    fn waves(self) -> [F; 4] {
        self.0
    }
    #[inline(always)]
    fn sum(self) -> F {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }
    #[inline(always)]
    fn greatest(self) -> F {
        let [a, b, c, d] = self.0;
        a.max(b).max(c.max(d))
    }
    #[inline(always)]
    fn where_negative(self, yes: Self, no: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h], [i, j, k, l]) = (self.0, yes.0, no.0);
        let select = |x: F, yes, no| x.lt(F::ZERO).select(yes, no);
        Self([
            select(a, e, i),
            select(b, f, j),
            select(c, g, k),
            select(d, h, l),
        ])
    }
    #[inline(always)]
    fn at_least(self, least: F) -> Self {
        self.at_each(|value| value.max(least))
    }
    #[inline(always)]
    fn below(self, most: F) -> Self {
        self.at_each(|value| most.min(value))
    }
    #[inline(always)]
    fn square_roots(self) -> Self {
        self.at_each(F::sqrt)
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident) => {
        impl<F: Lane> $operator for Spectrum<F> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
                Self([a.$method(e), b.$method(f), c.$method(g), d.$method(h)])
            }
        }

        impl<F: Lane> $operator<F> for Spectrum<F> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: F) -> Self {
                let [a, b, c, d] = self.0;
                Self([
                    a.$method(other),
                    b.$method(other),
                    c.$method(other),
                    d.$method(other),
                ])
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);
