//! No model makes light.
//!
//! Measured with importance, which refraction does not squeeze: the integral of the continuous
//! values plus the discrete energies plus what passes is at most 1, and exactly 1 for a smooth
//! interface between dielectrics.

use crate::directions;
use crate::scene::Sample;
use crate::sphere;
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// All energies that leave for a known direction, by lane; discrete ones as the lane that
/// chooses finds them.
fn outgoing(sample: &Sample, wo: Vec3) -> Vec4 {
    let bsdf = sample.at(wo);
    let [x, y, z, w] = sphere::total(&sphere::integrate(8, |wi| {
        bsdf.eval(wo, wi, TransportMode::Importance).to_array()
    }));
    let mut energy = Vec4::new(x as f32, y as f32, z as f32, w as f32);
    for turn in 0..4 {
        let mut met: Vec<Vec3> = Vec::new();
        let turned = sample.rotated(wo, turn);
        for i in 0..2000 {
            let u_lobe = (i as f32 + 0.5) / 2000.0;
            if let Some(s) = turned.sample(wo, u_lobe, Vec2::splat(0.5), TransportMode::Importance)
                && s.chance.is_delta()
                && !met.iter().any(|m| (*m - s.wi).length() < 1e-6)
            {
                met.push(s.wi);
                energy[turn] += s.value.x;
            }
        }
    }
    energy
}

#[test]
fn nothing_reflects_more_than_it_receives() {
    for sample in Sample::test_materials() {
        for wo in directions::known() {
            let energy = outgoing(&sample, wo);
            // A thousandth for the quadrature.
            assert!(
                energy.max_element() < 1.001,
                "{} from {wo}: {energy}",
                sample.text
            );
        }
    }
}

#[test]
fn smooth_dielectrics_lose_nothing() {
    for text in [
        "dielectric",
        "dielectric int_ior=f:1 ext_ior=f:2",
        "dielectric int_ior=s:cauchy:1.5,0.01",
        "thindielectric",
        "mask opacity=f:0.4 ( thindielectric )",
        "null",
    ] {
        for wo in directions::known() {
            let energy = outgoing(&Sample::new(text), wo);
            assert!(
                (energy - 1.0).abs().max_element() < 1e-6,
                "{text} from {wo}: {energy}"
            );
        }
    }
}
