//! For tests: whether a [`Kernel`] gives the same bits at every width.

use super::{F32x8, F32x16, Kernel, Lane, apply};

/// Numbers at which mistakes show: zeros, infinities, NaN, subnormal numbers, limits of ranges.
pub const AWKWARD_NUMBERS: [f32; 24] = [
    0.0,
    -0.0,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1e-39,
    f32::MAX,
    f32::MIN,
    0.5,
    -0.5,
    1.0,
    -1.0,
    1.0 - f32::EPSILON / 2.0,
    1.0 + f32::EPSILON,
    1.5,
    2.5,
    8_388_609.0,
    2_147_483_648.0,
    -2_147_483_648.0,
    4_294_967_296.0,
];

/// Evaluates `kernel` at every width for the elements of slices of one length.
///
/// # Panics
///
/// Where the results differ in a bit, unless both are NaN.
pub fn assert_agreement<const N: usize, const M: usize>(
    kernel: &impl Kernel<N, M>,
    inputs: [&[f32]; N],
) {
    let scalar = evaluated::<f32, N, M>(kernel, inputs);
    let vectors = [
        evaluated::<F32x8, N, M>(kernel, inputs),
        evaluated::<F32x16, N, M>(kernel, inputs),
    ];
    for (vector, width) in vectors.iter().zip([8, 16]) {
        for output in 0..M {
            for (i, (a, b)) in scalar[output].iter().zip(&vector[output]).enumerate() {
                assert!(
                    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(),
                    "output {output} for {:?}: {a:e} alone, {b:e} among {width}",
                    inputs.map(|input| input[i])
                );
            }
        }
    }
}

fn evaluated<F: Lane, const N: usize, const M: usize>(
    kernel: &impl Kernel<N, M>,
    inputs: [&[f32]; N],
) -> [Vec<f32>; M] {
    let length = inputs.iter().map(|input| input.len()).min().unwrap_or(0);
    let mut outputs = [(); M].map(|()| vec![0.0; length]);
    apply::<F, N, M>(kernel, inputs, outputs.each_mut().map(Vec::as_mut_slice));
    outputs
}
