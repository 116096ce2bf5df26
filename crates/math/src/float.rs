//! Elementary functions in single precision, the same bits on every machine.
//!
//! The platform's own `sin`, `exp` or `pow` differ between operating systems and library
//! versions; an image that depends on them could not be reproduced. These are `libm`'s
//! portable implementations (errors below 1 ulp unless its documentation says otherwise).
//! Everything an image depends on calls these; a lint forbids the standard library's.

/// Sine of `x` radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Cosine of `x` radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// Sine and cosine of `x` radians.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// Tangent of `x` radians.
#[inline]
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

/// Arc sine of `x`, with `x` brought into [−1, 1] first.
#[inline]
pub fn asin(x: f32) -> f32 {
    libm::asinf(x.clamp(-1.0, 1.0))
}

/// Arc cosine of `x`, with `x` brought into [−1, 1] first.
#[inline]
pub fn acos(x: f32) -> f32 {
    libm::acosf(x.clamp(-1.0, 1.0))
}

/// Arc tangent of `x`.
#[inline]
pub fn atan(x: f32) -> f32 {
    libm::atanf(x)
}

/// The angle of the point (`x`, `y`) in (−π, π].
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Inverse hyperbolic tangent.
#[inline]
pub fn atanh(x: f32) -> f32 {
    libm::atanhf(x)
}

/// Hyperbolic cosine.
#[inline]
pub fn cosh(x: f32) -> f32 {
    libm::coshf(x)
}

/// e to the power `x`.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Natural logarithm.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Logarithm to base 2.
#[inline]
pub fn log2(x: f32) -> f32 {
    libm::log2f(x)
}

/// `x` to the power `y`.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

/// Cube root.
#[inline]
pub fn cbrt(x: f32) -> f32 {
    libm::cbrtf(x)
}

/// The error function.
#[inline]
pub fn erf(x: f32) -> f32 {
    libm::erff(x)
}

/// Square root of `x`, zero for negative `x` (which rounding alone produces here).
#[inline]
pub fn safe_sqrt(x: f32) -> f32 {
    x.max(0.0).sqrt()
}
