//! Lines with known errors against 30-digit arithmetic (mpmath) and their own error rates.

// Reference values keep the digits they were computed to.
#![allow(clippy::excessive_precision)]

use crate::checks::{Random, near};
use etalon_statistics::{Line, proportion};

#[test]
fn known_errors() {
    let (x, y) = ([1.0, 2.0, 3.0, 5.0, 8.0], [2.1, 3.9, 6.2, 9.7, 16.4]);
    let errors = [0.1, 0.2, 0.2, 0.4, 0.5];
    let fit = Line::fit_with_errors(&x, &y, &errors).expect("a line");
    near(fit.line.slope.value(), 2.004_502_630_612_994, 1e-13);
    near(
        fit.line.slope.standard_error(),
        0.056_010_346_704_573_031,
        1e-13,
    );
    near(fit.line.intercept.value(), 0.068_187_935_886_455_402, 1e-11);
    near(
        fit.line.intercept.standard_error(),
        0.128_025_600_033_899_986,
        1e-13,
    );
    near(
        3.0 * fit.line.scatter * fit.line.scatter,
        2.513_428_361_678_698_2,
        1e-12,
    );
    near(fit.p_straight, 0.472_869_165_138_519_06, 1e-12);
    // A parabola is no line.
    let squares = x.map(|x| x * x);
    let bent = Line::fit_with_errors(&x, &squares, &errors).expect("a line");
    assert!(bent.p_straight < 1e-6);
    assert_eq!(Line::fit_with_errors(&x, &y, &[0.1; 4]), None);
    assert_eq!(Line::fit_with_errors(&x, &y, &[0.0; 5]), None);
}

/// Squared errors c/n of independent sampling at n = 4 … 1024, each the mean of 128 squares of
/// normal numbers, so with a relative standard error of √(2/128): the interval of the exponent
/// covers −1 at its rate of 95 % in 2,000 fits (exact 99.9 % interval), and the points are called
/// bent at α = 0.01 in at most 2.5 % (the logarithm of χ² is a little skewed). Mutants: an exponent of
/// −1.1 is excluded in nine tenths; errors too small by √2 are caught by the misfit in a fifth.
#[test]
fn exponents_are_covered() {
    let samples: Vec<f64> = (2..=10).map(|k| f64::from(1 << k)).collect();
    let mut random = Random(5);
    let (mut covered, mut bent, mut excluded, mut misfit) = (0, 0, 0, 0);
    for _ in 0..2000 {
        let errors: Vec<f64> = samples
            .iter()
            .map(|n| {
                let squares = (0..128).map(|_| random.normal()).map(|z| z * z);
                3.0 / n * squares.sum::<f64>() / 128.0
            })
            .collect();
        // From the fitted value's scale only its relative size is known: √(2/128).
        let standard: Vec<f64> = errors.iter().map(|e| e * 0.125).collect();
        let fit = Line::fit_power_law_with_errors(&samples, &errors, &standard).expect("positive");
        let interval = fit.line.slope.interval(0.95);
        covered += u64::from(interval.contains(-1.0));
        excluded += u32::from(!interval.contains(-1.1));
        bent += u32::from(fit.p_straight < 0.01);
        let small: Vec<f64> = errors.iter().map(|e| e * 0.0625).collect();
        let wrong = Line::fit_power_law_with_errors(&samples, &errors, &small).expect("positive");
        misfit += u32::from(wrong.p_straight < 0.01);
    }
    let share = proportion::interval(covered, 2000, 0.999).expect("trials");
    assert!(share.contains(0.95), "{covered}");
    assert!(bent <= 50, "{bent}");
    assert!(excluded >= 1800, "{excluded}");
    assert!(misfit >= 400, "{misfit}");
    assert_eq!(
        Line::fit_power_law_with_errors(&[1.0, 2.0, 3.0], &[1.0, 0.0, 1.0], &[0.1; 3]),
        None
    );
}

/// Points whose logarithms are lower than the law's by s²/2 are on it.
#[test]
fn logarithms_are_corrected() {
    let relative = [0.1, 0.3, 0.2, 0.5];
    let x = [1.0, 2.0, 4.0, 8.0];
    let y: Vec<f64> = (x.iter().zip(relative))
        .map(|(x, s)| 3.0 / x * libm::exp(-0.5 * s * s))
        .collect();
    let errors: Vec<f64> = y.iter().zip(relative).map(|(y, s)| y * s).collect();
    let fit = Line::fit_power_law_with_errors(&x, &y, &errors).expect("positive");
    near(fit.line.slope.value(), -1.0, 1e-13);
    near(fit.line.intercept.value(), 1.098_612_288_668_109_7, 1e-13);
    near(fit.p_straight, 1.0, 1e-12);
}
