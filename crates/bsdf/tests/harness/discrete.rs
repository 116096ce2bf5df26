//! The discrete directions that a model lists are those that it samples.
//!
//! Estimators that follow every direction (`whitted`) must see the same surface as those that
//! choose one: each direction that sampling finds is listed with the same value and probability,
//! and none is listed that sampling does not find with its probability.

use crate::directions::Uniform;
use crate::scene::Sample;
use etalon_transport::{Bsdf, BsdfSample, TransportMode};
use glam::Vec2;

const DRAWS: u32 = 2000;

fn listed(bsdf: &impl Bsdf, wo: glam::Vec3, mode: TransportMode) -> Vec<BsdfSample> {
    (0..).map_while(|i| bsdf.discrete(wo, i, mode)).collect()
}

fn same(a: &BsdfSample, b: &BsdfSample) -> bool {
    a.wi == b.wi
        && a.value == b.value
        && a.chance == b.chance
        && (a.eta, a.is_null) == (b.eta, b.is_null)
}

#[test]
fn what_is_sampled_is_listed_and_what_is_listed_is_sampled() {
    for sample in Sample::test_materials() {
        let mut uniform = Uniform::new(11);
        for round in 0..24 {
            let mode = [TransportMode::Radiance, TransportMode::Importance][round % 2];
            let wo = uniform.direction();
            let bsdf = sample.at(wo);
            let list = listed(&bsdf, wo, mode);
            let mut met = vec![0; list.len()];
            for draw in 0..DRAWS {
                let u_lobe = (draw as f32 + 0.5) / DRAWS as f32;
                let found = bsdf.sample(wo, u_lobe, Vec2::new(0.3, 0.6), mode);
                let Some(found) = found.filter(|s| s.chance.is_delta()) else {
                    continue;
                };
                let index = list.iter().position(|s| same(s, &found));
                let index = index.unwrap_or_else(|| panic!("{}: {found:?}", sample.text));
                met[index] += 1;
            }
            for (entry, met) in list.iter().zip(met) {
                // Equally spaced numbers meet an interval to within one at each end.
                let expected = entry.chance.lanes().x * DRAWS as f32;
                assert!(
                    (met as f32 - expected).abs() <= 2.0,
                    "{} from {wo}: {met} times {entry:?}",
                    sample.text
                );
            }
        }
    }
}

#[test]
fn there_are_as_many_whichever_lane_chooses() {
    for sample in Sample::test_materials() {
        let mut uniform = Uniform::new(12);
        for _ in 0..40 {
            let wo = uniform.direction();
            let count = |turn| listed(&sample.rotated(wo, turn), wo, TransportMode::Radiance).len();
            let first = count(0);
            assert!((1..4).all(|turn| count(turn) == first), "{}", sample.text);
        }
    }
}
