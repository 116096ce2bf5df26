//! The Kolmogorov–Smirnov test of a sample against a continuous distribution.
//!
//! D = sup |Fₙ(x) − F(x)|. Its tail is exact (Marsaglia, Tsang & Wang 2003) where it is not
//! small and n ≤ 500; the tail beyond n·D² ≥ 4 is twice the exact one-sided one (Birnbaum &
//! Tingey 1951), from which it differs by less than 10⁻⁶ relative (Simard & L'Ecuyer 2011); and
//! the rest is Kolmogorov's limit with Vrbik's (2018) correction, good to 10⁻⁴.

use std::f64::consts::PI;

/// The outcome of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KolmogorovSmirnov {
    /// D, the greatest distance of the two distribution functions.
    pub distance: f64,
    /// The probability of a distance at least this great under the hypothesis.
    pub p_value: f64,
}

/// Tests whether a sample comes from the distribution with this cumulative function; `None` of
/// an empty sample or where the function leaves [0, 1], NaN included.
#[must_use]
pub fn test(sample: &[f64], cumulative: impl Fn(f64) -> f64) -> Option<KolmogorovSmirnov> {
    if sample.is_empty() {
        return None;
    }
    let mut values: Vec<f64> = sample.iter().map(|&x| cumulative(x)).collect();
    if values.iter().any(|value| !(0.0..=1.0).contains(value)) {
        return None;
    }
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let distance = values
        .iter()
        .enumerate()
        .map(|(i, &value)| (value - i as f64 / n).max((i as f64 + 1.0) / n - value))
        .fold(0.0, f64::max);
    Some(KolmogorovSmirnov {
        distance,
        p_value: sf(distance, values.len()),
    })
}

/// Tests whether a sample, such as p-values under their hypothesis, is uniform on [0, 1];
/// `None` of an empty sample or of numbers outside.
#[must_use]
pub fn test_uniform(sample: &[f64]) -> Option<KolmogorovSmirnov> {
    test(sample, |x| x)
}

/// The probability that D of `n` observations is at least `distance`.
#[must_use]
pub fn sf(distance: f64, n: usize) -> f64 {
    let count = n as f64;
    if distance.is_nan() || n == 0 {
        return f64::NAN;
    }
    if distance <= 0.5 / count {
        1.0
    } else if distance >= 1.0 {
        0.0
    } else if count * distance * distance >= 4.0 {
        2.0 * one_sided(distance, n)
    } else if n <= 500 {
        (1.0 - exact_cumulative(distance, n)).clamp(0.0, 1.0)
    } else {
        limit(distance, count)
    }
}

/// P(D⁺ ≥ d) = d Σⱼ C(n, j) (d + j/n)^(j−1) (1 − d − j/n)^(n−j), all terms positive.
fn one_sided(distance: f64, n: usize) -> f64 {
    let count = n as f64;
    let last = (count * (1.0 - distance)) as usize;
    let mut sum = 0.0;
    // ln C(n, j), by its recurrence.
    let mut choices = 0.0;
    for j in 0..=last.min(n) {
        let at = j as f64;
        if j > 0 {
            choices += libm::log((count - at + 1.0) / at);
        }
        let (up, down) = (distance + at / count, 1.0 - distance - at / count);
        let falling = if j == n {
            0.0
        } else if down > 0.0 {
            (count - at) * libm::log(down)
        } else {
            continue;
        };
        sum += libm::exp(choices + (at - 1.0) * libm::log(up) + falling);
    }
    distance * sum
}

/// P(D < d) by Marsaglia, Tsang & Wang: n!/nⁿ times the middle element of Hⁿ.
fn exact_cumulative(distance: f64, n: usize) -> f64 {
    let count = n as f64;
    let k = (count * distance) as usize + 1;
    let size = 2 * k - 1;
    let h = k as f64 - count * distance;

    let mut matrix = vec![0.0; size * size];
    for (index, element) in matrix.iter_mut().enumerate() {
        let (row, column) = (index / size, index % size);
        *element = f64::from(row + 1 >= column);
    }
    let mut power = 1.0;
    for i in 0..size {
        power *= h;
        matrix[i * size] -= power;
        matrix[(size - 1) * size + size - 1 - i] -= power;
    }
    if h > 0.5 {
        matrix[(size - 1) * size] += libm::pow(2.0 * h - 1.0, size as f64);
    }
    for row in 0..size {
        for column in 0..(row + 1).min(size) {
            for divisor in 1..=row + 1 - column {
                matrix[row * size + column] /= divisor as f64;
            }
        }
    }

    let (raised, mut exponent) = raise(&matrix, size, n);
    let mut probability = raised[(k - 1) * size + k - 1];
    for i in 1..=n {
        probability *= i as f64 / count;
        if probability < 1e-140 {
            probability *= 1e140;
            exponent -= 140;
        }
    }
    probability * libm::pow(10.0, f64::from(exponent))
}

/// A matrix to the `n`-th power, scaled by 10 to the second result.
fn raise(matrix: &[f64], size: usize, n: usize) -> (Vec<f64>, i32) {
    if n == 1 {
        return (matrix.to_vec(), 0);
    }
    let (half, exponent) = raise(matrix, size, n / 2);
    let mut raised = multiply(&half, &half, size);
    let mut exponent = 2 * exponent;
    if n % 2 == 1 {
        raised = multiply(matrix, &raised, size);
    }
    let middle = size / 2;
    if raised[middle * size + middle] > 1e140 {
        for element in &mut raised {
            *element *= 1e-140;
        }
        exponent += 140;
    }
    (raised, exponent)
}

fn multiply(a: &[f64], b: &[f64], size: usize) -> Vec<f64> {
    let mut product = vec![0.0; size * size];
    for row in 0..size {
        for inner in 0..size {
            let factor = a[row * size + inner];
            for column in 0..size {
                product[row * size + column] += factor * b[inner * size + column];
            }
        }
    }
    product
}

/// 1 − K(x) for x = √n·D, shifted by 1/(6√n) + (x − 1)/(4n).
fn limit(distance: f64, count: f64) -> f64 {
    let x = count.sqrt() * distance;
    let x = x + 1.0 / (6.0 * count.sqrt()) + (x - 1.0) / (4.0 * count);
    let cumulative_or_tail =
        |terms: &dyn Fn(f64) -> f64| (1..=20).map(|i| terms(f64::from(i))).sum();
    if x < 1.0 {
        let sum: f64 = cumulative_or_tail(&|i| {
            let odd = 2.0 * i - 1.0;
            libm::exp(-odd * odd * PI * PI / (8.0 * x * x))
        });
        1.0 - (2.0 * PI).sqrt() / x * sum
    } else {
        let sum: f64 = cumulative_or_tail(&|i| {
            let sign = if i % 2.0 == 1.0 { 1.0 } else { -1.0 };
            sign * libm::exp(-2.0 * i * i * x * x)
        });
        (2.0 * sum).clamp(0.0, 1.0)
    }
}
