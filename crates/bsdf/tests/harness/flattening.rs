//! Composed materials against the mixtures they stand for.

use crate::directions::Uniform;
use crate::scene::Sample;
use etalon_bsdf::MAX_LOBES;
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec3, Vec4};

const ROUGH: &str = "roughconductor alpha=f:0.3";
const DIFFUSE: &str = "diffuse reflectance=u:0.8";

/// Checks that `text` has the values and densities of the parts with their weights, and lets
/// `null_transmittance` light pass.
fn is_mixture(text: &str, parts: &[(f32, &str)], passing: f32) {
    let whole = Sample::new(text);
    let parts: Vec<(f32, Sample)> = parts.iter().map(|(w, t)| (*w, Sample::new(t))).collect();
    let mut uniform = Uniform::new(4);
    for _ in 0..200 {
        let (wo, wi) = (uniform.direction(), uniform.direction());
        let (value, density) = whole
            .at(wo)
            .eval_and_density(wo, wi, TransportMode::Radiance);
        let mut expected = (Vec4::ZERO, Vec4::ZERO);
        for (weight, part) in &parts {
            let (v, d) = part
                .at(wo)
                .eval_and_density(wo, wi, TransportMode::Radiance);
            expected.0 += v * *weight;
            expected.1 += d.lanes() * *weight;
        }
        let near = |a: Vec4, b: Vec4| (a - b).abs().max_element() <= 1e-6 * (1.0 + b.max_element());
        assert!(
            near(value, expected.0) && near(density.lanes(), expected.1),
            "{text} {wo} {wi}"
        );
        let bsdf = whole.at(wo);
        assert!(
            near(bsdf.null_transmittance(), Vec4::splat(passing)),
            "{text} {}",
            bsdf.null_transmittance()
        );
        assert!(near(bsdf.null_probability(), Vec4::splat(passing)));
    }
}

#[test]
fn mask_and_blend_are_mixtures() {
    is_mixture(
        &format!("mask opacity=f:0.3 ( {DIFFUSE} )"),
        &[(0.3, DIFFUSE)],
        0.7,
    );
    is_mixture(
        &format!("blendbsdf weight=f:0.25 ( {DIFFUSE} ) ( {ROUGH} )"),
        &[(0.75, DIFFUSE), (0.25, ROUGH)],
        0.0,
    );
    is_mixture(
        &format!(
            "mask opacity=f:0.5 ( blendbsdf weight=f:0.2 ( mask opacity=f:0.5 ( {DIFFUSE} ) ) \
             ( blendbsdf weight=f:0.5 ( {ROUGH} ) ( null ) ) )"
        ),
        &[(0.2, DIFFUSE), (0.05, ROUGH)],
        0.5 + 0.2 + 0.05,
    );
    // Shares beyond [0, 1], as bitmaps may have, are brought into it.
    is_mixture(
        &format!("mask opacity=f:1.5 ( {DIFFUSE} )"),
        &[(1.0, DIFFUSE)],
        0.0,
    );
    is_mixture(
        &format!("blendbsdf weight=f:-1 ( {DIFFUSE} ) ( {ROUGH} )"),
        &[(1.0, DIFFUSE)],
        0.0,
    );
}

#[test]
fn either_side_of_a_twosided_material_sees_its_front() {
    let both = Sample::new(&format!("twosided ( {ROUGH} ) ( {DIFFUSE} )"));
    let one = Sample::new(&format!("twosided ( {ROUGH} )"));
    let (rough, diffuse) = (Sample::new(ROUGH), Sample::new(DIFFUSE));
    let mut uniform = Uniform::new(8);
    let turned = |v: Vec3| Vec3::new(v.x, v.y, -v.z);
    for _ in 0..200 {
        let (a, b) = (uniform.direction(), uniform.direction());
        let (wo, wi) = (
            Vec3::new(a.x, a.y, a.z.abs()),
            Vec3::new(b.x, b.y, b.z.abs()),
        );
        let eval = |sample: &Sample, wo: Vec3, wi: Vec3| {
            sample.at(wo).eval(wo, wi, TransportMode::Radiance)
        };
        let (back_o, back_i) = (turned(wo), turned(wi));
        assert_eq!(eval(&both, wo, wi), eval(&rough, wo, wi));
        assert_eq!(eval(&both, back_o, back_i), eval(&diffuse, wo, wi));
        assert_eq!(eval(&one, back_o, back_i), eval(&rough, wo, wi));
        assert_eq!(eval(&both, wo, back_i), Vec4::ZERO);
    }
}

#[test]
fn only_materials_that_pass_light_need_transmittance() {
    for (text, passing) in [
        ("diffuse", false),
        ("dielectric", false),
        ("thindielectric", true),
        ("null", true),
        ("mask ( diffuse )", true),
        (
            "blendbsdf weight=f:0.5 ( diffuse ) ( twosided ( plastic ) )",
            false,
        ),
        ("blendbsdf weight=f:0.5 ( diffuse ) ( null )", true),
    ] {
        assert_eq!(Sample::new(text).material().has_null(), passing, "{text}");
    }
}

#[test]
fn what_says_that_nothing_passes_lets_nothing_pass() {
    let mut uniform = Uniform::new(12);
    for sample in Sample::test_materials() {
        for _ in 0..50 {
            let passing = sample.at(uniform.direction()).null_transmittance();
            let silent = sample.material().has_null() || passing == Vec4::ZERO;
            assert!(silent, "{}", sample.text);
        }
    }
}

#[test]
fn as_many_lobes_as_promised() {
    let mut text = "diffuse".to_owned();
    for _ in 1..MAX_LOBES {
        text = format!("blendbsdf weight=f:0.5 ( {text} ) ( {DIFFUSE} )");
    }
    let sample = Sample::new(&text);
    assert_eq!(sample.at(Vec3::Z).lobes().len(), MAX_LOBES);
}
