//! Sampling against density (χ²) and against quadrature of the values, over all exemplars as one
//! family.
//!
//! χ²: directions sampled for 40,000 pairs of numbers fall into 1,024 cells of equal area, one
//! more for each discrete direction and one for absorbed light; expected is the density's
//! integral over the cell.
//!
//! Quadrature: with lane k choosing in turn, the mean of Σₖ vⱼ / Σₗ pₗ is ∫ fⱼ for every lane j,
//! which is what makes an image with four wavelengths per path right.
//!
//! α = 10⁻³ for any false rejection in the family (Holm). `mutants.rs` shows what is rejected.

use crate::directions::{self, Uniform};
use crate::scene::Sample;
use crate::sphere;
use etalon_statistics::{Family, chi_squared, normal};
use etalon_transport::{Bsdf, SamplePdf, TransportMode};
use glam::{Vec3, Vec4};

const SAMPLES: usize = 40_000;

/// The density (first) and value (the other four) over each cell, and in all with fewer nodes.
pub(crate) struct Integrals {
    cells: Vec<[f64; 5]>,
    coarse: [f64; 5],
}

impl Integrals {
    pub(crate) fn new(bsdf: &impl Bsdf, wo: Vec3) -> Self {
        let f = |wi| {
            let (value, density) = bsdf.eval_and_density(wo, wi, TransportMode::Radiance);
            [density.hero(), value.x, value.y, value.z, value.w]
        };
        Self {
            cells: sphere::integrate(10, f),
            coarse: sphere::total(&sphere::integrate(6, f)),
        }
    }
}

/// A discrete direction that was met.
struct Met {
    wi: Vec3,
    probability: f32,
    count: u64,
}

/// The p-value of the hypothesis that `sample` follows `density`.
pub(crate) fn chi_squared_p(bsdf: &impl Bsdf, wo: Vec3, integrals: &Integrals, seed: u64) -> f64 {
    let mut uniform = Uniform::new(seed);
    let mut observed = vec![0u64; sphere::CELLS];
    let (mut met, mut absorbed) = (Vec::<Met>::new(), 0);
    for _ in 0..SAMPLES {
        match bsdf.sample(wo, uniform.next(), uniform.pair(), TransportMode::Radiance) {
            None => absorbed += 1,
            Some(s) => match s.chance {
                SamplePdf::Continuous(_) => observed[sphere::cell(s.wi)] += 1,
                SamplePdf::Discrete(atom) => {
                    match met.iter_mut().find(|m| (m.wi - s.wi).length() < 1e-5) {
                        Some(m) => m.count += 1,
                        None => met.push(Met {
                            wi: s.wi,
                            probability: atom.0.x,
                            count: 1,
                        }),
                    }
                }
            },
        }
    }
    let n = SAMPLES as f64;
    let mut expected: Vec<f64> = integrals.cells.iter().map(|cell| cell[0] * n).collect();
    for m in &met {
        observed.push(m.count);
        expected.push(f64::from(m.probability) * n);
    }
    observed.push(absorbed);
    expected.push((n - expected.iter().sum::<f64>()).max(0.0));
    if observed.iter().filter(|&&o| o > 0).count() == 1 {
        // Only one thing can happen; it is expected with certainty or the model is wrong.
        let (o, e) = (observed.iter().zip(&expected))
            .find(|(o, _)| **o > 0)
            .expect("one is above zero");
        return if (*e - *o as f64).abs() < 1e-3 * n {
            1.0
        } else {
            0.0
        };
    }
    match chi_squared::goodness_of_fit(&observed, &expected) {
        Ok(test) => test.p_value,
        Err(error) => panic!("from {wo}: {error}"),
    }
}

/// For each lane, the p-value of the hypothesis that the sampled mean with every lane choosing in
/// turn is the integral of the values.
pub(crate) fn quadrature_p<B: Bsdf>(
    turned: impl Fn(usize) -> B,
    wo: Vec3,
    integrals: &Integrals,
    seed: u64,
) -> [f64; 4] {
    let mut uniform = Uniform::new(seed);
    let n = SAMPLES / 4;
    let mut sums = [[0.0f64; 4]; 2];
    let mut atoms: Vec<(Vec3, Vec4)> = Vec::new();
    for _ in 0..n {
        let (u_lobe, u) = (uniform.next(), uniform.pair());
        let mut estimate = Vec4::ZERO;
        for turn in 0..4 {
            if let Some(s) = turned(turn).sample(wo, u_lobe, u, TransportMode::Radiance) {
                let lanes = s.value / s.chance.lanes().element_sum();
                let value = unturn(lanes, turn);
                estimate += value;
                if s.chance.is_delta() && !atoms.iter().any(|a| (a.0 - s.wi).length() < 1e-5) {
                    atoms.push((s.wi, unturn(s.value, turn)));
                }
            }
        }
        for (j, v) in estimate.to_array().into_iter().enumerate() {
            sums[0][j] += f64::from(v);
            sums[1][j] += f64::from(v) * f64::from(v);
        }
    }
    let fine = sphere::total(&integrals.cells);
    core::array::from_fn(|j| {
        let discrete: f64 = atoms.iter().map(|a| f64::from(a.1[j])).sum();
        let mean = sums[0][j] / n as f64;
        let variance = (sums[1][j] / n as f64 - mean * mean).max(0.0);
        // The quadrature's error is at most that of fewer nodes, and rounding.
        let integral = fine[j + 1];
        let slack = (integral - integrals.coarse[j + 1]).abs() + 1e-5 * mean;
        let excess = ((mean - integral - discrete).abs() - slack).max(0.0);
        if excess == 0.0 {
            1.0
        } else {
            2.0 * normal::sf(excess / (variance / n as f64).sqrt())
        }
    })
}

/// Lanes of a model in which lane `turn` came first, in their own order.
pub(crate) fn unturn(lanes: Vec4, turn: usize) -> Vec4 {
    Vec4::from_array(core::array::from_fn(|j| lanes[(j + 4 - turn) % 4]))
}

#[test]
fn sampling_follows_density_and_finds_the_energy() {
    let mut family = Family::new(1e-3).expect("a level");
    for (i, sample) in Sample::with_equations().iter().enumerate() {
        for (j, wo) in directions::known().into_iter().enumerate() {
            let seed = (10 * i + j) as u64;
            let name = |what: &str| format!("{what} of {} from {wo}", sample.text);
            let bsdf = sample.at(wo);
            let integrals = Integrals::new(&bsdf, wo);
            let p = chi_squared_p(&bsdf, wo, &integrals, seed);
            family.push(name("χ²"), p).expect("a probability");
            for (lane, p) in quadrature_p(|turn| sample.rotated(wo, turn), wo, &integrals, seed)
                .into_iter()
                .enumerate()
            {
                family
                    .push(name(&format!("energy in lane {lane}")), p)
                    .expect("a probability");
            }
        }
    }
    let rejected: Vec<String> = family
        .decide()
        .into_iter()
        .filter(|d| d.rejected)
        .map(|d| format!("{} p = {:.1e}", d.name, d.p_value))
        .collect();
    assert!(rejected.is_empty(), "{}", rejected.join("\n"));
}
