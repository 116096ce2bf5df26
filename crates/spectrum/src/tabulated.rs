//! Spectra given by values at wavelengths, linear in between: equally spaced ([`Regular`]) or not
//! ([`Irregular`]).

use crate::{SpectrumError, error};
use etalon_math::lane::{Int, Lane, Select, Spectral};
use glam::Vec4;

/// A tabulated spectrum beyond its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Outside {
    /// Zero, as emission and reflectance are.
    #[default]
    Zero,
    /// The value at the nearer end, as a refractive index is.
    Hold,
}

/// 2²³: single precision has no fractions beyond.
const TWO_TO_23: f32 = 8_388_608.0;

/// Values at equally spaced wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Regular {
    min: f32,
    max: f32,
    /// Intervals per nanometre.
    rate: f32,
    /// The last value is repeated so that entry i + 1 exists for every i.
    values: Box<[f32]>,
}

impl Regular {
    /// `values` (two or more, finite) at wavelengths equally spaced from `min` to `max` nm.
    pub fn new(min: f64, max: f64, values: &[f64]) -> Result<Self, SpectrumError> {
        error::positive("the shortest wavelength", min)?;
        error::finite("the longest wavelength", max)?;
        if max <= min {
            return Err(SpectrumError::OutOfRange {
                what: "the longest wavelength",
                value: max,
                accepted: "above the shortest wavelength",
            });
        }
        let last = check_values(values)?;
        Ok(Self {
            min: min as f32,
            max: max as f32,
            rate: ((values.len() - 1) as f64 / (max - min)) as f32,
            values: values.iter().chain([&last]).map(|&v| v as f32).collect(),
        })
    }

    /// Values at four wavelengths in nm; zero outside the table.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        let inside = lambda.cmpge(Vec4::splat(self.min)) & lambda.cmple(Vec4::splat(self.max));
        let t = (lambda - self.min) * self.rate;
        // A wavelength outside gets some entry, which `inside` discards.
        let last = (self.values.len() - 2) as f32;
        let place = t.max(Vec4::ZERO).min(Vec4::splat(last)).floor();
        let fraction = t - place;
        // The bits of 2²³ + i end with those of i: faster than four conversions.
        let sums = (place + TWO_TO_23).to_array();
        let pair = |sum: f32| &self.values[(sum.to_bits() & 0x7f_ffff) as usize..][..2];
        let [a, b, c, d] = sums.map(pair);
        let low = Vec4::new(a[0], b[0], c[0], d[0]);
        let high = Vec4::new(a[1], b[1], c[1], d[1]);
        Vec4::select(inside, low + (high - low) * fraction, Vec4::ZERO)
    }

    /// The same at wavelengths in lanes.
    #[inline(always)]
    pub fn eval_lanes<F: Lane>(&self, lambda: F::Spectrum) -> F::Spectrum {
        let (min, max) = (F::splat(self.min), F::splat(self.max));
        let last = F::splat((self.values.len() - 2) as f32);
        let t = (lambda - min) * F::splat(self.rate);
        let place = t.at_each(|t| t.max(F::ZERO).min(last).floor());
        let index = place.waves().map(F::to_int);
        let [a, b, c, d, e, f, g, h] = F::columns(|i| {
            let pair = |index: F::Int| &self.values[index.lane(i) as usize..][..2];
            let [a, b, c, d] = index.map(pair);
            [a[0], b[0], c[0], d[0], a[1], b[1], c[1], d[1]]
        });
        let [low, high] = [[a, b, c, d], [e, f, g, h]].map(F::Spectrum::from_waves);
        let values = (low + (high - low) * (t - place)).waves();
        let [i, j, k, l] = lambda.waves();
        let within = |value: F, lambda: F| (lambda.ge(min) & lambda.le(max)).select(value, F::ZERO);
        let [p, q, r, s] = values;
        F::Spectrum::from_waves([within(p, i), within(q, j), within(r, k), within(s, l)])
    }

    /// The same spectrum times `factor`.
    pub fn scaled(mut self, factor: f32) -> Self {
        self.values.iter_mut().for_each(|v| *v *= factor);
        self
    }

    /// The same spectrum with no value above `top`.
    pub fn held_to(mut self, top: f32) -> Self {
        self.values.iter_mut().for_each(|v| *v = v.min(top));
        self
    }

    /// First and last wavelength, nm.
    pub fn range(&self) -> [f32; 2] {
        [self.min, self.max]
    }

    /// The tabulated values.
    pub fn values(&self) -> &[f32] {
        &self.values[..self.values.len() - 1]
    }

    /// The wavelengths (nm) and their values.
    pub fn knots(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let [min, max] = self.range().map(f64::from);
        let step = (max - min) / (self.values().len() - 1) as f64;
        let values = self.values().iter().enumerate();
        values.map(move |(i, value)| (min + i as f64 * step, f64::from(*value)))
    }
}

/// Values at any strictly increasing wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Irregular {
    /// (wavelength nm, value, slope to the next knot nm⁻¹).
    knots: Box<[[f32; 3]]>,
    /// For each of equally wide buckets, an interval at or below every wavelength in it.
    first: Box<[u32]>,
    /// Buckets per nanometre.
    rate: f32,
    outside: Outside,
}

impl Irregular {
    /// `values` at `wavelengths` (nm; two or more, finite, strictly increasing), zero outside.
    pub fn new(wavelengths: &[f64], values: &[f64]) -> Result<Self, SpectrumError> {
        Self::with_outside(wavelengths, values, Outside::Zero)
    }

    /// As [`Irregular::new`], with a rule for wavelengths beyond the ends.
    pub fn with_outside(
        wavelengths: &[f64],
        values: &[f64],
        outside: Outside,
    ) -> Result<Self, SpectrumError> {
        if wavelengths.len() != values.len() {
            return Err(SpectrumError::LengthMismatch {
                wavelengths: wavelengths.len(),
                values: values.len(),
            });
        }
        check_values(values)?;
        for (index, &value) in wavelengths.iter().enumerate() {
            error::positive("a wavelength", value)?;
            if index > 0 && !(value as f32 > wavelengths[index - 1] as f32) {
                return Err(SpectrumError::NotIncreasing { index, value });
            }
        }
        let count = wavelengths.len();
        let knots: Box<[[f32; 3]]> = (0..count)
            .map(|i| {
                // Between the wavelengths as they are stored: a steep slope else misses the next value.
                let stored = |i: usize| f64::from(wavelengths[i] as f32);
                let slope = if i + 1 < count {
                    (values[i + 1] - values[i]) / (stored(i + 1) - stored(i))
                } else {
                    0.0
                };
                [wavelengths[i] as f32, values[i] as f32, slope as f32]
            })
            .collect();
        let (min, max) = (knots[0][0], knots[count - 1][0]);
        // Buckets as wide as the closest two knots hold one knot each; more than a few thousand
        // would not stay in the cache.
        let closest = knots
            .windows(2)
            .map(|k| k[1][0] - k[0][0])
            .fold(f32::INFINITY, f32::min);
        let buckets = ((max - min) / closest).clamp(1.0, 4096.0).ceil();
        let rate = buckets / (max - min);
        let bucket = |lambda: f32| ((lambda - min) * rate) as usize;
        let first = (0..=bucket(max))
            .map(|b| {
                // `bucket` never decreases, so the knots of earlier buckets lie below all of b.
                let below = knots.partition_point(|k| bucket(k[0]) < b);
                below.saturating_sub(1).min(count - 2) as u32
            })
            .collect();
        Ok(Self {
            knots,
            first,
            rate,
            outside,
        })
    }

    /// Values at four wavelengths in nm.
    #[inline]
    pub fn eval(&self, lambda: Vec4) -> Vec4 {
        let [min, max] = self.range().map(Vec4::splat);
        let within = lambda.max(min).min(max);
        let t = (within - min) * self.rate;
        let values = Vec4::new(
            self.value(within.x, t.x),
            self.value(within.y, t.y),
            self.value(within.z, t.z),
            self.value(within.w, t.w),
        );
        match self.outside {
            Outside::Zero => Vec4::select(within.cmpeq(lambda), values, Vec4::ZERO),
            Outside::Hold => values,
        }
    }

    /// Value at `lambda` nm within the table, which lies `t` buckets from its beginning.
    #[inline]
    fn value(&self, lambda: f32, t: f32) -> f32 {
        let mut i = self.first[t as usize] as usize;
        // Almost always at most one step, taken without a branch.
        i += usize::from(self.knots[i + 1][0] < lambda);
        while self.knots[i + 1][0] < lambda {
            i += 1;
        }
        let [start, value, slope] = self.knots[i];
        value + slope * (lambda - start)
    }

    /// The same spectrum times `factor`.
    pub fn scaled(mut self, factor: f32) -> Self {
        for knot in &mut self.knots {
            knot[1] *= factor;
            knot[2] *= factor;
        }
        self
    }

    /// The same spectrum with no value above `top`.
    pub fn held_to(mut self, top: f32) -> Self {
        for i in 0..self.knots.len() {
            self.knots[i][1] = self.knots[i][1].min(top);
        }
        for i in 1..self.knots.len() {
            let [[x, y, _], [next_x, next_y, _]] = [self.knots[i - 1], self.knots[i]];
            // A slope between values that stay is kept to the bit.
            if y >= top || next_y >= top {
                self.knots[i - 1][2] = (next_y - y) / (next_x - x);
            }
        }
        self
    }

    /// First and last wavelength, nm.
    pub fn range(&self) -> [f32; 2] {
        [self.knots[0][0], self.knots[self.knots.len() - 1][0]]
    }

    /// The tabulated (wavelength nm, value) pairs.
    pub fn knots(&self) -> impl ExactSizeIterator<Item = (f32, f32)> + '_ {
        self.knots.iter().map(|k| (k[0], k[1]))
    }
}

/// The last of two or more finite values.
fn check_values(values: &[f64]) -> Result<f64, SpectrumError> {
    for &value in values {
        error::finite("a value of the spectrum", value)?;
    }
    match values {
        [_, .., last] => Ok(*last),
        _ => Err(SpectrumError::TooFewValues {
            given: values.len(),
            needed: 2,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Linear interpolation by search, in double precision.
    fn reference(knots: &[(f64, f64)], lambda: f64) -> f64 {
        let after = knots.partition_point(|k| k.0 < lambda);
        if after == 0 {
            return if lambda == knots[0].0 {
                knots[0].1
            } else {
                0.0
            };
        }
        let Some(b) = knots.get(after) else {
            return 0.0;
        };
        let a = knots[after - 1];
        a.1 + (b.1 - a.1) * (lambda - a.0) / (b.0 - a.0)
    }

    #[test]
    fn ends_belong_to_the_table() {
        let regular = Regular::new(400.0, 700.0, &[1.0, 2.0, 3.0, 4.0]).expect("a valid table");
        let lambda = Vec4::new(400.0, 700.0, 399.99, 700.01);
        assert_eq!(regular.eval(lambda), Vec4::new(1.0, 4.0, 0.0, 0.0));
        assert_eq!(
            regular.eval(Vec4::new(f32::NAN, 550.0, -1.0, f32::INFINITY)),
            Vec4::new(0.0, 2.5, 0.0, 0.0)
        );
        assert_eq!(regular.values(), [1.0, 2.0, 3.0, 4.0]);
        let knots = ([400.0, 410.0, 700.0], [1.0, 2.0, 4.0]);
        let irregular = Irregular::new(&knots.0, &knots.1).expect("a valid table");
        assert_eq!(irregular.eval(lambda), Vec4::new(1.0, 4.0, 0.0, 0.0));
        let held =
            Irregular::with_outside(&knots.0, &knots.1, Outside::Hold).expect("a valid table");
        assert_eq!(
            held.eval(Vec4::new(1.0, 9999.0, 405.0, 410.0)),
            Vec4::new(1.0, 4.0, 1.5, 2.0)
        );
        assert_eq!(held.scaled(2.0).eval(Vec4::splat(405.0)), Vec4::splat(3.0));
    }

    #[test]
    fn bad_tables_are_refused_with_reasons() {
        let message =
            |r: Result<Irregular, SpectrumError>| r.expect_err("must be refused").to_string();
        assert!(message(Irregular::new(&[400.0], &[1.0])).contains("at least 2"));
        assert!(
            message(Irregular::new(&[400.0, 500.0], &[1.0])).contains("2 wavelengths for 1 values")
        );
        assert!(message(Irregular::new(&[400.0, 400.0], &[1.0, 1.0])).contains("number 2"));
        assert!(message(Irregular::new(&[500.0, 400.0], &[1.0, 1.0])).contains("increasing"));
        assert!(message(Irregular::new(&[0.0, 400.0], &[1.0, 1.0])).contains("greater than 0"));
        assert!(message(Irregular::new(&[1.0, 2.0], &[1.0, f64::NAN])).contains("finite"));
        assert!(Regular::new(700.0, 400.0, &[1.0, 2.0]).is_err());
        assert!(Regular::new(400.0, 700.0, &[1.0]).is_err());
        assert!(Regular::new(400.0, f64::NAN, &[1.0, 2.0]).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None,
            rng_seed: proptest::test_runner::RngSeed::Fixed(4), ..ProptestConfig::default() })]

        #[test]
        fn tables_interpolate_linearly(start in 100_u32..600,
                                       steps in proptest::collection::vec((1_u32..4000, -1.0_f64..1.0), 2..60),
                                       places in proptest::collection::vec(0.0_f64..1.2, 32)) {
            // Knots on a grid of 1/64 nm are exact in single precision.
            let mut lambda = f64::from(start);
            let mut knots = Vec::new();
            for (step, value) in steps {
                knots.push((lambda, value));
                lambda += f64::from(step) / 64.0;
            }
            let (wavelengths, values): (Vec<f64>, Vec<f64>) = knots.iter().copied().unzip();
            let (min, max) = (wavelengths[0], wavelengths[wavelengths.len() - 1]);
            let irregular = Irregular::new(&wavelengths, &values).expect("a valid table");
            let regular = Regular::new(min, max, &values).expect("a valid table");
            let step = (max - min) / (values.len() - 1) as f64;
            let even: Vec<(f64, f64)> =
                values.iter().enumerate().map(|(i, v)| (min + step * i as f64, *v)).collect();
            for (place, knot) in places.iter().zip(wavelengths.iter().cycle()) {
                for lambda in [(min - 5.0 + place * (max - min)) as f32, *knot as f32] {
                    let exact = reference(&knots, f64::from(lambda));
                    let found = f64::from(irregular.eval(Vec4::splat(lambda)).x);
                    prop_assert!((found - exact).abs() < 2e-4, "{} {} {}", lambda, found, exact);
                    if f64::from(lambda) < max - 0.01 && f64::from(lambda) > min + 0.01 {
                        let exact = reference(&even, f64::from(lambda));
                        let found = f64::from(regular.eval(Vec4::splat(lambda)).x);
                        // Rounding of λ − min and of the rate, times the slope.
                        prop_assert!((found - exact).abs() < 1e-3 / step.min(1.0), "{} {} {}", lambda, found, exact);
                    }
                }
            }
        }
    }
}
