//! Integrals over wavelengths from few of them, without random numbers.
//!
//! The range is divided into n strata Sₖ of equal probability. Each is represented by one wavelength, its mean weighted by the
//! sensor's response, assuming daylight D (CIE D65) on a reflectance that is constant over a stratum:
//!
//! ```text
//! ∫ L(λ) s(λ) dλ ≈ 1/n Σₖ L(λₖ) rₖ,   rₖ = n/D(λₖ) ∫_Sₖ D(λ) s(λ) dλ,   λₖ = ∫_Sₖ λ D |s| dλ / ∫_Sₖ D |s| dλ
//! ```
//!
//! A product rule (P. Davis, P. Rabinowitz, Methods of Numerical Integration, 1984, section 2.5.6): white under daylight is
//! exact with any n, and smooth reflectances under daylight converge with n⁻², though D is not smooth. Other light does not
//! profit from D, and loses little.

use crate::{Sensor, SensorWeights, Wavelengths, illuminants::d65};
use glam::{DVec4, Vec4};

/// Points of each stratum at which the integrals over it are taken: a multiple of the cells of equal probability.
const POINTS: u32 = 1024;

/// Four wavelengths that represent four strata.
#[derive(Clone, Copy, Debug)]
pub struct QuadratureNode {
    /// λₖ.
    pub wavelengths: Wavelengths,
    /// rₖ for each channel, instead of s/p: the weight of radiance at λₖ in the mean over all strata.
    pub response: SensorWeights,
    /// D(λₖ).
    pub daylight: Vec4,
}

impl QuadratureNode {
    /// The nodes of 4 `count` strata, for wavelengths that are drawn and seen in these ways.
    pub fn all(
        count: u32,
        draw: impl Fn(f32) -> Wavelengths,
        sensor: impl Fn(&Wavelengths) -> SensorWeights,
    ) -> impl Iterator<Item = Self> {
        let strata = f64::from(4 * count);
        (0..count).map(move |stratum| {
            let [mut weight, mut moment, mut sum, mut inverse] = [DVec4::ZERO; 4];
            let mut channels = [DVec4::ZERO; 3];
            for point in 0..POINTS {
                let part = (f64::from(point) + 0.5) / f64::from(POINTS);
                let drawn = draw(((f64::from(stratum) + part) / strata) as f32);
                let seen = sensor(&drawn);
                let (lambda, light) = (drawn.lambda.as_dvec4(), daylight(drawn.lambda).as_dvec4());
                for (channel, seen) in channels.iter_mut().zip([seen.r, seen.g, seen.b]) {
                    let seen = light * seen.as_dvec4();
                    *channel += seen;
                    weight += seen.abs();
                    moment += seen.abs() * lambda;
                }
                sum += lambda;
                inverse += drawn.density.as_dvec4().recip();
            }
            let points = f64::from(POINTS);
            let seen = weight.cmpgt(DVec4::ZERO);
            let lambda = DVec4::select(seen, moment / weight, sum / points).as_vec4();
            let light = daylight(lambda);
            let mean = |channel: DVec4| {
                let over = (channel / points).as_vec4() / light;
                Vec4::select(light.cmpgt(Vec4::ZERO), over, Vec4::ZERO)
            };
            let [r, g, b] = channels.map(mean);
            Self {
                wavelengths: Wavelengths {
                    lambda,
                    density: (inverse / points).recip().as_vec4(),
                },
                response: SensorWeights { r, g, b },
                daylight: light,
            }
        })
    }

    /// The same for the standard sensor.
    pub fn standard(count: u32) -> impl Iterator<Item = Self> {
        let sensor = std::sync::Arc::new(Sensor::default());
        let drawn = sensor.clone();
        Self::all(count, move |u| drawn.sample(u), move |w| sensor.weights(w))
    }
}

/// D at four wavelengths.
fn daylight(lambda: Vec4) -> Vec4 {
    Vec4::from_array(
        lambda
            .to_array()
            .map(|lambda| d65(f64::from(lambda)) as f32),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::response;
    use crate::{LAMBDA_MAX, LAMBDA_MIN};
    use glam::DVec3;

    /// The colour of light, by a sum over fractions of a nanometre.
    fn exact(light: impl Fn(f64) -> f64) -> DVec3 {
        let parts = 20;
        let steps = (LAMBDA_MAX - LAMBDA_MIN) as u32 * parts;
        let step = 1.0 / f64::from(parts);
        let at = (0..steps).map(|i| LAMBDA_MIN + (f64::from(i) + 0.5) * step);
        at.map(|lambda| {
            let [r, g, b, _] = response(Vec4::splat(lambda as f32)).map(|c| f64::from(c.x));
            DVec3::new(r, g, b) * (light(lambda) * step)
        })
        .sum()
    }

    /// The largest error of a channel with 4 `count` wavelengths, over the largest channel.
    fn error(count: u32, light: &impl Fn(f64) -> f64) -> f64 {
        let rule: DVec3 = QuadratureNode::standard(count)
            .map(|node| {
                let lambda = node.wavelengths.lambda.to_array();
                let radiance = Vec4::from_array(lambda.map(|l| light(f64::from(l)) as f32));
                (node.response.rgb(radiance) / (4 * count) as f32).as_dvec3()
            })
            .sum();
        let exact = exact(light);
        (rule - exact).abs().max_element() / exact.abs().max_element()
    }

    fn step(lambda: f64, at: f64, width: f64) -> f64 {
        let x = (lambda - at) / width;
        0.5 + 0.5 * x / (1.0 + x * x).sqrt()
    }

    /// Every allowed number of wavelengths is better than half as many, and none is worse than the ones before by more than
    /// single precision. Mutant rejected: the midpoint rule in the distribution of wavelengths, worse with 64 than with 36.
    #[test]
    fn more_wavelengths_are_better() {
        let reflectances: [(&str, &dyn Fn(f64) -> f64); 5] = [
            ("white", &|_| 1.0),
            ("red", &|l| 0.05 + 0.8 * step(l, 590.0, 25.0)),
            ("blue", &|l| 0.7 - 0.6 * step(l, 500.0, 25.0)),
            ("green", &|l| {
                0.2 + 0.5 * step(l, 500.0, 40.0) - 0.5 * step(l, 580.0, 40.0)
            }),
            ("rising", &|l| l / 830.0),
        ];
        for (name, reflectance) in reflectances {
            let light = |lambda: f64| d65(lambda) * reflectance(lambda);
            let errors: Vec<f64> = (1..=16).map(|count| error(count, &light)).collect();
            let places = || (0..errors.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
            for (fewer, more) in places() {
                let held = errors[more] < errors[fewer] + 1e-4;
                assert!(
                    held,
                    "{name}: {} is worse than {}: {errors:?}",
                    4 * more + 4,
                    4 * fewer + 4
                );
            }
            assert!(
                errors[8] < 1.5e-3 && errors[15] < 5e-4,
                "{name}: {errors:?}"
            );
        }
        // Light of other kinds: evenly spread, and of a lamp.
        let others: [&dyn Fn(f64) -> f64; 2] = [&|_| 1.0, &|l| (l / 560.0).powi(3)];
        for light in others {
            let errors: Vec<f64> = (1..=16).map(|count| error(count, &light)).collect();
            assert!(errors[15] < 2e-3 && errors[15] < errors[8], "{errors:?}");
        }
    }
}
