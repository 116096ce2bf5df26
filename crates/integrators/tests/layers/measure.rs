//! Means of an estimator with their standard errors.

use crate::world::Stack;
use etalon_sampling::{Independent, SampleId, Sampler};
use etalon_transport::{Integrator, PixelSample, Sink};
use glam::{UVec2, Vec2};

/// One sample's findings.
#[derive(Default)]
struct Meter {
    rgb: [f64; 3],
    alpha: f64,
}

impl Sink for Meter {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        self.rgb = rgb.map(f64::from);
        self.alpha = f64::from(alpha);
    }
    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("no estimator here splats");
    }
    fn channel(&mut self, _: usize, _: f32) {}
}

/// Mean and squared standard error of red, green, blue and alpha.
pub(crate) struct Measured {
    pub mean: [f64; 4],
    variance: [f64; 4],
}

/// Draws `n` samples.
pub(crate) fn measure<I: Integrator<State = ()>>(
    integrator: &I,
    world: &Stack,
    n: u32,
) -> Measured {
    let (mut sum, mut squares) = ([0.0; 4], [0.0; 4]);
    for sample in 0..n {
        let mut sampler = Independent::start(&SampleId {
            seed: 2026,
            replicate: 0,
            pixel: (0, 0),
            sample,
            samples_per_replicate: n,
            blocks: 1,
        });
        let site = PixelSample {
            pixel: UVec2::ZERO,
            raster: sampler.next_2d(),
            margin: 0.0,
            pixels: 1,
            spacing: 1.0,
            sample: 0,
        };
        let mut meter = Meter::default();
        integrator.sample(world, &(), &site, &mut sampler, &mut meter);
        let [r, g, b] = meter.rgb;
        for (i, value) in [r, g, b, meter.alpha].into_iter().enumerate() {
            sum[i] += value;
            squares[i] += value * value;
        }
    }
    let n = f64::from(n);
    let mean = sum.map(|s| s / n);
    let variance = std::array::from_fn(|i| (squares[i] / n - mean[i] * mean[i]) / n);
    Measured { mean, variance }
}

impl Measured {
    /// The largest |z| of the three colours against their exact means.
    pub(crate) fn z(&self, exact: [f64; 3]) -> f64 {
        // Rounding of the single-precision sums is far below 10⁻⁵ of the mean.
        let z = |i: usize| {
            let rounding = 1e-5 * exact[i].abs() + 1e-12;
            (self.mean[i] - exact[i]) / (self.variance[i].sqrt() + rounding)
        };
        (0..3).map(|i| z(i).abs()).fold(0.0, f64::max)
    }
}

/// Bound on |z| for a whole test file's family: α = 10⁻³ over at most 100 comparisons of three
/// colours (two-sided normal quantile of 10⁻³ / 300 ≈ 4.65).
pub(crate) const LIMIT: f64 = 4.65;
