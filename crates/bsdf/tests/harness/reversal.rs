//! What bidirectional estimators rely on: a model resolved for one direction serves the way back,
//! and a discrete direction is as likely one way as the other.

use crate::directions::Uniform;
use crate::scene::Sample;
use etalon_transport::{Bsdf, SamplePdf, TransportMode};
use glam::Vec4;

fn close(a: Vec4, b: Vec4, relative: f32) -> bool {
    (a - b)
        .abs()
        .cmple(relative * a.abs().max(b.abs()) + 1e-6)
        .all()
}

#[test]
fn a_model_resolved_for_one_direction_knows_the_density_of_the_way_back() {
    for sample in Sample::test_materials() {
        let mut uniform = Uniform::new(8);
        for _ in 0..400 {
            let wo = uniform.direction();
            let forward = sample.at(wo);
            let found = forward.sample(wo, uniform.next(), uniform.pair(), TransportMode::Radiance);
            let Some(s) = found.filter(|s| !s.chance.is_delta()) else {
                continue;
            };
            let [a, b] = [&forward, &sample.at(s.wi)].map(|m| m.density(s.wi, wo).lanes());
            assert!(close(a, b, 1e-4), "{} {wo} {}: {a} {b}", sample.text, s.wi);
        }
    }
}

#[test]
fn discrete_directions_are_as_likely_one_way_as_the_other() {
    for sample in Sample::test_materials() {
        let mut uniform = Uniform::new(9);
        for _ in 0..100 {
            let wo = uniform.direction();
            let u = uniform.pair();
            let found = sample
                .at(wo)
                .sample(wo, uniform.next(), u, TransportMode::Radiance);
            let Some((s, SamplePdf::Discrete(there))) = found.map(|s| (s, s.chance)) else {
                continue;
            };
            // Near the critical angle Fresnel's equations turn rounding into more.
            if s.wi.z.abs().min(wo.z.abs()) < 0.1 {
                continue;
            }
            let back = (0..400)
                .filter_map(|i| {
                    let u_lobe = (i as f32 + 0.5) / 400.0;
                    sample
                        .at(s.wi)
                        .sample(s.wi, u_lobe, u, TransportMode::Importance)
                })
                .find(|b| b.chance.is_delta() && (b.wi - wo).length() < 1e-3);
            let Some(back) = back else {
                assert!(there.0.x < 0.01, "{} {s:?}", sample.text);
                continue;
            };
            let here = back.chance.lanes();
            assert!(
                close(there.0, here, 1e-3),
                "{} {wo} {s:?} {back:?}",
                sample.text
            );
            assert!((s.eta * back.eta - 1.0).abs() < 1e-5, "{}", sample.text);
        }
    }
}
