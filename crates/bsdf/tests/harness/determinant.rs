//! density == 1 / |∂ω/∂u|, by finite differences.
//!
//! For fixed (u, v) the number that chooses lobes is scanned for its branches; a branch with
//! probability P and Jacobian J contributes P/J to the density of its direction. Where at
//! most one continuous branch leaves into each hemisphere that is all of the density; in mixtures
//! it is a lower bound. A model for which that number is a coordinate, too (hair needs three), has a
//! branch at every step, and no such determinant; it is left to χ².

use crate::directions::{self, Uniform};
use crate::scene::Sample;
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec2, Vec3};

/// So many branches are a continuum.
const COORDINATE: usize = 100;

/// A continuous branch: a choice that is in force, its probability, and where it leads.
struct Branch {
    u_lobe: f32,
    probability: f32,
    wi: Vec3,
}

fn continuous(bsdf: &impl Bsdf, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<Vec3> {
    bsdf.sample(wo, u_lobe, u, TransportMode::Radiance)
        .filter(|s| !s.chance.is_delta())
        .map(|s| s.wi)
}

/// The branches for the numbers `u`.
fn branches(bsdf: &impl Bsdf, wo: Vec3, u: Vec2) -> Vec<Branch> {
    let same = |a: Option<Vec3>, b: Option<Vec3>| match (a, b) {
        (Some(a), Some(b)) => (a - b).length() < 1e-4,
        (None, None) => true,
        _ => false,
    };
    let at = |u_lobe| continuous(bsdf, wo, u_lobe, u);
    let mut list = Vec::new();
    let (mut start, mut here) = (0.0f32, at(0.0));
    let steps = 256;
    for i in 1..=steps {
        let next = (i as f32 / steps as f32).min(0.999_999_9);
        let there = at(next);
        let end = if same(here, there) && i < steps {
            continue;
        } else if i == steps {
            1.0
        } else {
            let (mut low, mut high) = ((i - 1) as f32 / steps as f32, next);
            for _ in 0..24 {
                let middle = 0.5 * (low + high);
                if same(here, at(middle)) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            high
        };
        if let Some(wi) = here {
            list.push(Branch {
                u_lobe: 0.5 * (start + end).min(2.0 * 0.999_999),
                probability: end - start,
                wi,
            });
        }
        (start, here) = (end, there);
    }
    list
}

/// |∂ω/∂u| of a branch by five-point differences; `None` if it ends within the stencil.
fn jacobian(bsdf: &impl Bsdf, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<f32> {
    let h = 2e-3;
    let at = |x: f32, y: f32| continuous(bsdf, wo, u_lobe, u + h * Vec2::new(x, y));
    let difference = |x: f32, y: f32| {
        let near = at(x, y)? - at(-x, -y)?;
        let far = at(2.0 * x, 2.0 * y)? - at(-2.0 * x, -2.0 * y)?;
        // A jump to another branch is no derivative.
        ((far - 2.0 * near).length() < 0.1 * near.length()).then(|| (8.0 * near - far) / (12.0 * h))
    };
    Some(difference(1.0, 0.0)?.cross(difference(0.0, 1.0)?).length())
}

/// The largest relative difference between the density and P/J, and how many were compared. In a
/// mixture only P/J above the density counts.
pub(crate) fn worst(bsdf: &impl Bsdf, wo: Vec3, seed: u64) -> (f32, usize) {
    let mut uniform = Uniform::new(seed);
    let points: Vec<Vec2> = (0..200).map(|_| 0.06 + 0.88 * uniform.pair()).collect();
    let all: Vec<(Vec2, Vec<Branch>)> = points
        .into_iter()
        .map(|u| (u, branches(bsdf, wo, u)))
        .collect();
    let mixture = all.iter().any(|(_, list)| {
        let above = list.iter().filter(|b| b.wi.z > 0.0).count();
        above > 1 || list.len() - above > 1
    });
    let (mut worst, mut compared) = (0.0f32, 0);
    for (u, list) in &all {
        for branch in list {
            let Some(jacobian) = jacobian(bsdf, wo, branch.u_lobe, *u) else {
                continue;
            };
            let density = bsdf.density(wo, branch.wi).hero();
            let ratio = branch.probability / jacobian / density - 1.0;
            worst = worst.max(if mixture { ratio } else { ratio.abs() });
            compared += 1;
        }
    }
    (worst, compared)
}

#[test]
fn density_is_one_over_the_jacobian() {
    let mut failures = Vec::new();
    for sample in Sample::with_equations() {
        for wo in directions::known() {
            let bsdf = sample.at(wo);
            if branches(&bsdf, wo, Vec2::splat(0.4)).len() > COORDINATE {
                assert!(sample.text.starts_with("hair"), "{}", sample.text);
                continue;
            }
            let (worst, compared) = worst(&bsdf, wo, 7);
            // One per cent: what differences in single precision leave.
            if worst > 0.01 {
                failures.push(format!("{} from {wo}: {worst} of {compared}", sample.text));
            }
            if wo.z > 0.0 && bsdf.has_continuous() && compared < 50 {
                failures.push(format!("{} from {wo}: only {compared}", sample.text));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
