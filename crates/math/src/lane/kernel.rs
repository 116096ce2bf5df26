//! Functions over slices, at any width.

use super::Lane;

/// A function from `N` numbers to `M`, written once for every width.
pub trait Kernel<const N: usize, const M: usize> {
    /// The function.
    fn evaluate<F: Lane>(&self, inputs: [F; N]) -> [F; M];
}

/// Evaluates `kernel` for all elements of slices of one length: whole vectors of type `F` first, what remains one by one.
#[inline(always)]
pub fn apply<F: Lane, const N: usize, const M: usize>(
    kernel: &impl Kernel<N, M>,
    inputs: [&[f32]; N],
    mut outputs: [&mut [f32]; M],
) {
    let length = (inputs.iter().map(|input| input.len()))
        .chain(outputs.iter().map(|output| output.len()))
        .min()
        .unwrap_or(0);
    let whole = length - length % F::WIDTH;
    for at in (0..whole).step_by(F::WIDTH) {
        let results = kernel.evaluate(inputs.map(|input| F::load(&input[at..])));
        for (output, result) in outputs.iter_mut().zip(results) {
            result.store(&mut output[at..]);
        }
    }
    for at in whole..length {
        let results = kernel.evaluate(inputs.map(|input| input[at]));
        for (output, result) in outputs.iter_mut().zip(results) {
            output[at] = result;
        }
    }
}
