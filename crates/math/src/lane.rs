//! Code written once for one number or for a SIMD vector of them, generic over [`Lane`].
//!
//! Lane i of a vector gets the bits that `f32` gets from the same operands. So neither the width of vectors, nor the size
//! and order of a batch, nor a scalar call in its place can change a picture. [`Lane`] therefore offers only operations
//! with one correct result: IEEE 754's arithmetic, fused multiply-add, comparison and selection; no approximate
//! reciprocals, no fusing at the compiler's choice, no reductions across lanes. The one exception is IEEE 754's own:
//! which payload a NaN has.
//!
//! ```
//! use etalon_math::lane::{F32x8, Lane};
//!
//! /// Reflectance of a dielectric at normal incidence.
//! fn reflectance<F: Lane>(eta: F) -> F {
//!     let root = (eta - 1.0) / (eta + 1.0);
//!     root * root
//! }
//! assert_eq!(reflectance(F32x8::splat(1.5)).lane(7).to_bits(), reflectance(1.5_f32).to_bits());
//! ```
//!
//! Branches become [`Select::select`]: both sides are evaluated. Numbers on the right of an operator may be plain `f32`.
//! In generic code, functions should be `#[inline(always)]`: a vector passed to a function that is not inlined goes
//! through memory.
//!
//! # Choice of the SIMD crate
//!
//! `fearless_simd` 1.2 and `wide` 1.7 were measured side by side at x86-64-v3, both behind types without a token: equal
//! bits, and equal times within 4 % (four Fresnel terms of a conductor: 3.4 ns each at width 8 and 3.2 at width 16, 35
//! as `f32`), also of compilation. Plain arrays left to the compiler to vectorise took 2 to 3 times as long.
//! `fearless_simd` can also choose AVX-512 at run time, which gained nothing, and fuses multiply-adds on processors
//! without the instruction. `wide` was in use already; it is named in one file here, which fuses lane by lane where
//! `wide` would not.

pub mod agreement;
mod arc;
mod erf;
mod exp;
mod frame;
mod int;
mod kernel;
mod ln;
mod mask;
mod pow;
mod scalar;
mod simd_vector;
mod spectrum;
mod trigonometric;
mod vector3;

pub use crate::branch;
pub use arc::{acos, asin, atan, atan2};
pub use erf::erf;
pub use exp::exp;
pub use frame::LaneFrame;
pub use int::Int;
pub use kernel::{Kernel, apply};
pub use ln::ln;
pub use mask::{Mask, Select};
pub use pow::pow;
pub use simd_vector::{F32x8, F32x16, FUSES, Mask8, Mask16, U32x8, U32x16};
pub use spectrum::{Spectral, Spectrum};
pub use trigonometric::{sin_cos, sin_cos_turns};
pub use vector3::{Vector, Vector3};

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// The most lanes that a vector has.
pub const MOST_LANES: usize = 16;

/// `value(i)` for each lane i of `F`, and defaults beyond.
#[inline(always)]
pub fn per_lane<F: Lane, T: Default>(value: impl Fn(usize) -> T) -> [T; MOST_LANES] {
    core::array::from_fn(|i| if i < F::WIDTH { value(i) } else { T::default() })
}

/// One single-precision number or a vector of them.
///
/// Where `f32` has a method of the same name, that one hides the trait's in code that is not generic; the two differ
/// for [`Lane::min`] and [`Lane::max`] of NaN and of zeros with different signs.
pub trait Lane:
    Copy
    + Debug
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
{
    /// How many numbers.
    const WIDTH: usize;
    /// 0 in every lane.
    const ZERO: Self;
    /// 1 in every lane.
    const ONE: Self;
    /// What a comparison returns.
    type Mask: Mask
        + Select<Self>
        + Select<Self::Int>
        + Select<Self::Vector>
        + Select<Self::Spectrum>;
    /// As many 32-bit integers.
    type Int: Int<Mask = Self::Mask>;
    /// As many points or directions.
    type Vector: Vector<Self>;
    /// As many quantities at a path's four wavelengths.
    type Spectrum: Spectral<Self>;
    /// As many items of any other kind.
    type Array<T: Copy + Debug>: Copy + Debug + AsRef<[T]>;

    /// The same number in every lane.
    fn splat(value: f32) -> Self;
    /// `value(i)` in lane i.
    fn from_fn(value: impl FnMut(usize) -> f32) -> Self;
    /// `item(i)` for lane i.
    fn array<T: Copy + Debug>(item: impl FnMut(usize) -> T) -> Self::Array<T>;
    /// The number in lane `index`.
    fn lane(self, index: usize) -> f32;

    /// The first [`Lane::WIDTH`] numbers of `from`, which has that many or more.
    fn load(from: &[f32]) -> Self;
    /// Writes the lanes over the first numbers of `to`.
    fn store(self, to: &mut [f32]);
    /// The columns of a matrix whose row i belongs to lane i: lane i of the result k is number k of `row(i)`.
    fn columns(row: impl FnMut(usize) -> [f32; 8]) -> [Self; 8];
    /// The rows of the matrix with these columns, one for each lane.
    fn rows(columns: [Self; 8]) -> Self::Array<[f32; 8]>;
    /// The numbers of `table` at `indices`, one by one.
    #[inline(always)]
    fn gather(table: &[f32], indices: Self::Int) -> Self {
        Self::from_fn(|i| table[indices.lane(i) as usize])
    }

    /// `self` · `factor` + `term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// The square root; NaN below −0.
    fn sqrt(self) -> Self;
    /// The number without its sign.
    fn abs(self) -> Self;
    /// The number with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// The greatest integer that is not above.
    fn floor(self) -> Self;
    /// The nearest integer, of two the even one.
    fn round_ties_even(self) -> Self;

    /// Whether `self` = `other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// Whether `self` < `other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether `self` ≤ `other`.
    fn le(self, other: Self) -> Self::Mask;
    /// Whether `self` > `other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// Whether `self` ≥ `other`.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// `other` where it is less, else `self`: a NaN in `self` remains, one in `other` has no effect.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        other.lt(self).select(other, self)
    }
    /// `other` where it is greater, else `self`: a NaN in `self` remains, one in `other` has no effect.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.gt(self).select(other, self)
    }
    /// The number brought into [`low`, `high`]; NaN remains.
    #[inline(always)]
    fn clamp(self, low: f32, high: f32) -> Self {
        self.max(Self::splat(low)).min(Self::splat(high))
    }
    /// The square root, 0 below 0 (where rounding alone leads).
    #[inline(always)]
    fn safe_sqrt(self) -> Self {
        self.max(Self::ZERO).sqrt()
    }
    /// The polynomial with these coefficients, that of the highest power first, by fused multiply-adds.
    #[inline(always)]
    fn polynomial<const N: usize>(self, coefficients: [f32; N]) -> Self {
        (coefficients.iter().skip(1)).fold(Self::splat(coefficients[0]), |sum, &coefficient| {
            sum.mul_add(self, Self::splat(coefficient))
        })
    }

    /// The IEEE 754 encoding.
    fn to_bits(self) -> Self::Int;
    /// The number with this encoding.
    fn from_bits(bits: Self::Int) -> Self;
    /// The integer part, as a signed integer in two's complement; saturating, and 0 for NaN.
    fn to_int(self) -> Self::Int;
    /// The number nearest to a signed integer.
    fn from_int(int: Self::Int) -> Self;
}
