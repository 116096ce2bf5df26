//! One lane: `f32`, `u32` and `bool`.

use super::{Int, Lane, Mask, Select};
use core::fmt::Debug;

impl Lane for f32 {
    const WIDTH: usize = 1;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    type Mask = bool;
    type Int = u32;
    type Vector = glam::Vec3;
    type Spectrum = glam::Vec4;
    type Array<T: Copy + Debug> = [T; 1];

    #[inline(always)]
    fn splat(value: f32) -> Self {
        value
    }
    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f32) -> Self {
        value(0)
    }
    #[inline(always)]
    fn array<T: Copy + Debug>(mut item: impl FnMut(usize) -> T) -> [T; 1] {
        [item(0)]
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f32 {
        [self][index]
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[0] = self;
    }
    #[inline(always)]
    fn columns(mut row: impl FnMut(usize) -> [f32; 8]) -> [Self; 8] {
        row(0)
    }
    #[inline(always)]
    fn rows(columns: [Self; 8]) -> [[f32; 8]; 1] {
        [columns]
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        f32::mul_add(self, factor, term)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f32::copysign(self, sign)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        f32::floor(self)
    }
    #[inline(always)]
    fn round_ties_even(self) -> Self {
        f32::round_ties_even(self)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn to_bits(self) -> u32 {
        f32::to_bits(self)
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        f32::from_bits(bits)
    }
    #[inline(always)]
    fn to_int(self) -> u32 {
        self as i32 as u32
    }
    #[inline(always)]
    fn from_int(int: u32) -> Self {
        int as i32 as f32
    }
}

impl Int for u32 {
    type Mask = bool;

    #[inline(always)]
    fn splat(value: u32) -> Self {
        value
    }
    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> u32) -> Self {
        value(0)
    }
    #[inline(always)]
    fn lane(self, index: usize) -> u32 {
        [self][index]
    }
    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        to[0] = self;
    }
    #[inline(always)]
    fn wrapping_add(self, other: Self) -> Self {
        u32::wrapping_add(self, other)
    }
    #[inline(always)]
    fn wrapping_sub(self, other: Self) -> Self {
        u32::wrapping_sub(self, other)
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        u32::wrapping_mul(self, other)
    }
    #[inline(always)]
    fn shift_right_signed(self, bits: u32) -> Self {
        (self as i32 >> bits) as u32
    }
    #[inline(always)]
    fn eq(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
}

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> bool) -> Self {
        value(0)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.into()
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
}

macro_rules! select {
    ($($value:ty),*) => {
        $(impl Select<$value> for bool {
            #[inline(always)]
            fn select(self, yes: $value, no: $value) -> $value {
                if self { yes } else { no }
            }
        })*
    };
}

select!(f32, u32, glam::Vec3, glam::Vec4);
