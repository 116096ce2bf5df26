//! Eight and sixteen lanes, on the crate `wide`: sixteen are two registers of eight at x86-64-v3.

use super::{Int, Lane, Mask, Select, Spectral, Spectrum, Vector, Vector3};
use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Shl, Shr, Sub};

/// Whether `wide` fuses its multiply-add: where it does not, the rounding would differ from `f32`'s.
pub const FUSES: bool = cfg!(any(
    all(
        any(target_arch = "x86", target_arch = "x86_64"),
        target_feature = "fma"
    ),
    all(target_arch = "aarch64", target_feature = "neon")
));

/// An operator of a wrapper, given by that of what it wraps.
macro_rules! operator {
    ($wrapper:ident, $operator:ident, $method:ident) => {
        impl $operator for $wrapper {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    };
    ($wrapper:ident, $operator:ident, $method:ident, $element:ty) => {
        operator!($wrapper, $operator, $method);
        impl $operator<$element> for $wrapper {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: $element) -> Self {
                self.$method(Self::splat(other))
            }
        }
    };
}

/// A vector of floats, that of integers and the mask of one width.
macro_rules! simd_vector {
    ($width:literal, $float:ident: $wide_float:ident, $int:ident: $wide_int:ident, $mask:ident) => {
        #[doc = concat!(stringify!($width), " single-precision numbers.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $float(wide::$wide_float);

        #[doc = concat!(stringify!($width), " integers.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $int(wide::$wide_int);

        #[doc = concat!("What a comparison of ", stringify!($width), " lanes returns.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $mask(wide::$wide_float);

        operator!($float, Add, add, f32);
        operator!($float, Sub, sub, f32);
        operator!($float, Mul, mul, f32);
        operator!($float, Div, div, f32);
        operator!($int, BitAnd, bitand, u32);
        operator!($int, BitOr, bitor, u32);
        operator!($int, BitXor, bitxor, u32);
        operator!($mask, BitAnd, bitand);
        operator!($mask, BitOr, bitor);
        operator!($mask, BitXor, bitxor);

        impl Neg for $float {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }
        impl Not for $int {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Self(!self.0)
            }
        }
        impl Not for $mask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Self(!self.0)
            }
        }
        impl Shl<u32> for $int {
            type Output = Self;
            #[inline(always)]
            fn shl(self, bits: u32) -> Self {
                Self(self.0 << bits)
            }
        }
        impl Shr<u32> for $int {
            type Output = Self;
            #[inline(always)]
            fn shr(self, bits: u32) -> Self {
                Self(self.0 >> bits)
            }
        }

        impl Lane for $float {
            const WIDTH: usize = $width;
            const ZERO: Self = Self(wide::$wide_float::ZERO);
            const ONE: Self = Self(wide::$wide_float::ONE);
            type Mask = $mask;
            type Int = $int;
            type Vector = Vector3<Self>;
            type Spectrum = Spectrum<Self>;
            type Array<T: Copy + Debug> = [T; $width];

            #[inline(always)]
            fn splat(value: f32) -> Self {
                Self(wide::$wide_float::splat(value))
            }
            #[inline(always)]
            fn from_fn(value: impl FnMut(usize) -> f32) -> Self {
                Self(wide::$wide_float::new(core::array::from_fn(value)))
            }
            #[inline(always)]
            fn array<T: Copy + Debug>(item: impl FnMut(usize) -> T) -> [T; $width] {
                core::array::from_fn(item)
            }
            #[inline(always)]
            fn lane(self, index: usize) -> f32 {
                self.0.as_array()[index]
            }
            #[inline(always)]
            fn load(from: &[f32]) -> Self {
                let first = from.first_chunk().expect("as many numbers as lanes");
                Self(wide::$wide_float::new(*first))
            }
            #[inline(always)]
            fn store(self, to: &mut [f32]) {
                to[..$width].copy_from_slice(self.0.as_array());
            }
            #[inline(always)]
            fn columns(mut row: impl FnMut(usize) -> [f32; 8]) -> [Self; 8] {
                let mut columns = [[0.0; $width]; 8];
                for block in 0..$width / 8 {
                    let rows = core::array::from_fn(|i| wide::f32x8::new(row(8 * block + i)));
                    let transposed = wide::f32x8::transpose(rows);
                    for (column, part) in columns.iter_mut().zip(transposed) {
                        column[8 * block..][..8].copy_from_slice(part.as_array());
                    }
                }
                columns.map(|column| Self(wide::$wide_float::new(column)))
            }
            #[inline(always)]
            fn rows(columns: [Self; 8]) -> [[f32; 8]; $width] {
                let mut rows = [[0.0; 8]; $width];
                for (block, rows) in rows.chunks_exact_mut(8).enumerate() {
                    let part = |column: Self| {
                        let numbers = column.0.as_array()[8 * block..].first_chunk();
                        wide::f32x8::new(*numbers.expect("eight of as many as lanes"))
                    };
                    let transposed = wide::f32x8::transpose(columns.map(part));
                    for (row, numbers) in rows.iter_mut().zip(transposed) {
                        *row = *numbers.as_array();
                    }
                }
                rows
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, term: Self) -> Self {
                if FUSES {
                    Self(self.0.mul_add(factor.0, term.0))
                } else {
                    Self::from_fn(|i| self.lane(i).mul_add(factor.lane(i), term.lane(i)))
                }
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }
            #[inline(always)]
            fn copysign(self, sign: Self) -> Self {
                Self(self.0.copysign(sign.0))
            }
            #[inline(always)]
            fn floor(self) -> Self {
                Self(self.0.floor())
            }
            #[inline(always)]
            fn round_ties_even(self) -> Self {
                // Without SSE 4.1, `wide` loses the sign of what becomes 0.
                Self(self.0.round_ties_even().copysign(self.0))
            }
            #[inline(always)]
            fn eq(self, other: Self) -> $mask {
                $mask(self.0.simd_eq(other.0))
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $mask {
                $mask(self.0.simd_lt(other.0))
            }
            #[inline(always)]
            fn le(self, other: Self) -> $mask {
                $mask(self.0.simd_le(other.0))
            }
            #[inline(always)]
            fn to_bits(self) -> $int {
                $int(self.0.to_bits())
            }
            #[inline(always)]
            fn from_bits(bits: $int) -> Self {
                Self(wide::$wide_float::from_bits(bits.0))
            }
            #[inline(always)]
            fn to_int(self) -> $int {
                $int(self.0.trunc_int().cast_unsigned())
            }
            #[inline(always)]
            fn from_int(int: $int) -> Self {
                Self(int.0.cast_signed().round_float())
            }
        }

        impl Int for $int {
            type Mask = $mask;

            #[inline(always)]
            fn splat(value: u32) -> Self {
                Self(wide::$wide_int::splat(value))
            }
            #[inline(always)]
            fn from_fn(value: impl FnMut(usize) -> u32) -> Self {
                Self(wide::$wide_int::new(core::array::from_fn(value)))
            }
            #[inline(always)]
            fn lane(self, index: usize) -> u32 {
                self.0.as_array()[index]
            }
            #[inline(always)]
            fn load(from: &[u32]) -> Self {
                let first = from.first_chunk().expect("as many integers as lanes");
                Self(wide::$wide_int::new(*first))
            }
            #[inline(always)]
            fn store(self, to: &mut [u32]) {
                to[..$width].copy_from_slice(self.0.as_array());
            }
            #[inline(always)]
            fn wrapping_add(self, other: Self) -> Self {
                Self(self.0 + other.0)
            }
            #[inline(always)]
            fn wrapping_sub(self, other: Self) -> Self {
                Self(self.0 - other.0)
            }
            #[inline(always)]
            fn wrapping_mul(self, other: Self) -> Self {
                Self(self.0 * other.0)
            }
            #[inline(always)]
            fn shift_right_signed(self, bits: u32) -> Self {
                Self((self.0.cast_signed() >> bits).cast_unsigned())
            }
            #[inline(always)]
            fn eq(self, other: Self) -> $mask {
                $mask(wide::$wide_float::from_bits(self.0.simd_eq(other.0)))
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $mask {
                $mask(wide::$wide_float::from_bits(self.0.simd_lt(other.0)))
            }
        }

        impl Mask for $mask {
            #[inline(always)]
            fn splat(value: bool) -> Self {
                Self::from_fn(|_| value)
            }
            #[inline(always)]
            fn from_fn(mut value: impl FnMut(usize) -> bool) -> Self {
                let bits = core::array::from_fn(|i| u32::from(value(i)).wrapping_neg());
                Self(wide::$wide_float::from_bits(wide::$wide_int::new(bits)))
            }
            #[inline(always)]
            fn bits(self) -> u32 {
                self.0.to_bitmask()
            }
            #[inline(always)]
            fn any(self) -> bool {
                self.0.any()
            }
            #[inline(always)]
            fn all(self) -> bool {
                self.0.all()
            }
        }

        impl Select<$float> for $mask {
            #[inline(always)]
            fn select(self, yes: $float, no: $float) -> $float {
                $float(self.0.select(yes.0, no.0))
            }
        }
        impl Select<$int> for $mask {
            #[inline(always)]
            fn select(self, yes: $int, no: $int) -> $int {
                $int(self.0.select(yes.0, no.0))
            }
        }
        impl Select<Vector3<$float>> for $mask {
            #[inline(always)]
            fn select(self, yes: Vector3<$float>, no: Vector3<$float>) -> Vector3<$float> {
                Vector::choose(self, yes, no)
            }
        }
        impl Select<Spectrum<$float>> for $mask {
            #[inline(always)]
            fn select(self, yes: Spectrum<$float>, no: Spectrum<$float>) -> Spectrum<$float> {
                Spectral::choose(self, yes, no)
            }
        }
    };
}

simd_vector!(8, F32x8: f32x8, U32x8: u32x8, Mask8);
simd_vector!(16, F32x16: f32x16, U32x16: u32x16, Mask16);
