//! The error function.

use super::{Lane, branch, exp};

/// The error function, within 1.3 ulp.
///
/// Below 0.93, x + xP(x²), with a polynomial of relative error 2·10⁻⁸; above, 1 − exp(−Q(x)), with one of 2·10⁻⁹.
#[inline(always)]
pub fn erf<F: Lane>(x: F) -> F {
    let size = x.abs();
    branch!(size.gt(F::splat(0.93)), large(size).copysign(x), small(x))
}

/// The error function below 0.93.
#[inline(always)]
fn small<F: Lane>(x: F) -> F {
    let x2 = x * x;
    let tail = x2.polynomial([
        -5.965_786e-4,
        4.988_304e-3,
        -2.676_332_7e-2,
        0.112_817_265,
        -0.376_124_86,
        0.128_379_15,
    ]);
    tail.mul_add(x, x)
}

/// The error function above 0.93. From 4 on it is 1 in single precision.
#[inline(always)]
fn large<F: Lane>(x: F) -> F {
    let exponent = x.min(F::splat(4.0)).polynomial([
        -1.959_426_3e-4,
        3.043_266_5e-3,
        -2.222_710_1e-2,
        0.103_931_94,
        0.637_181_9,
        1.127_675_8,
        1.956_300_5e-4,
    ]);
    F::ONE - exp(-exponent)
}
