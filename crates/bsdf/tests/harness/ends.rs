//! `principled` and `principledthin` at the ends of their parameters: what they are just before.
//!
//! A quotient that is 0/0 at an end, or a case that is left out there, shows as a jump.

use crate::directions::Uniform;
use crate::scene::Sample;
use etalon_transport::{Bsdf, TransportMode};
use glam::Vec4;

/// Parameters with an end, and a number just before it.
const COMMON: &[(&str, f32, f32)] = &[
    ("base_color", 0.0, 1e-9),
    ("base_color", 1.0, 0.99999),
    ("roughness", 0.0, 1e-4),
    ("roughness", 1.0, 0.99999),
    ("anisotropic", 0.0, 1e-5),
    ("anisotropic", 1.0, 0.99999),
    ("spec_trans", 0.0, 1e-5),
    ("spec_trans", 1.0, 0.99999),
    ("spec_tint", 0.0, 1e-5),
    ("spec_tint", 1.0, 0.99999),
    ("sheen", 0.0, 1e-5),
    ("sheen_tint", 0.0, 1e-5),
    ("sheen_tint", 1.0, 0.99999),
    ("flatness", 0.0, 1e-5),
    ("flatness", 1.0, 0.99999),
];

const SOLID: &[(&str, f32, f32)] = &[
    ("metallic", 0.0, 1e-5),
    ("metallic", 1.0, 0.99999),
    ("specular", 0.0, 1e-12),
    ("clearcoat", 0.0, 1e-5),
    ("clearcoat_gloss", 0.0, 1e-5),
    ("clearcoat_gloss", 1.0, 0.99999),
];

const THIN: &[(&str, f32, f32)] = &[
    ("eta", 0.0, 1e-5),
    ("diff_trans", 0.0, 1e-5),
    ("diff_trans", 2.0, 1.9999),
];

/// What the others are: all of them in between, and in turn at either end of what takes light away.
const SOLIDS: &[&str] = &[
    "base_color=f:0.6 metallic=f:0.5 specular=f:0.5 roughness=f:0.5 spec_tint=f:0.4 sheen=f:0.5 sheen_tint=f:0.3 \
     clearcoat=f:0.5 clearcoat_gloss=f:0.3 spec_trans=f:0.4 flatness=f:0.2 anisotropic=f:0.3",
    "metallic=f:1 roughness=f:0.5 sheen=f:0.5 spec_tint=f:0.5",
    "metallic=f:0 roughness=f:0.5 spec_tint=f:1 sheen=f:0.5 sheen_tint=f:1",
    "metallic=f:0 roughness=f:0.4 spec_trans=f:1 sheen=f:0.5",
    "specular=f:0 roughness=f:0.5 metallic=f:0.5",
    "specular=f:0 roughness=f:0.5 metallic=f:1",
    "specular=f:0 roughness=f:0.5 spec_tint=f:0.5",
];

const SHEETS: &[&str] = &[
    "base_color=f:0.6 roughness=f:0.5 spec_trans=f:0.4 eta=f:1.4 spec_tint=f:0.4 sheen=f:0.5 sheen_tint=f:0.3 \
     flatness=f:0.2 diff_trans=f:0.6 anisotropic=f:0.3",
    "roughness=f:0.5 spec_trans=f:1 sheen=f:0.5",
    "roughness=f:0.5 spec_trans=f:0 diff_trans=f:2",
];

/// The parameters `others`, but for `name`, which has this value.
fn with(model: &str, others: &str, name: &str, value: f32) -> Sample {
    let is_other = |part: &&str| part.split('=').next() != Some(name);
    let mut text = model.to_owned();
    for part in others.split_whitespace().filter(is_other) {
        text += " ";
        text += part;
    }
    Sample::new(&format!("{text} {name}=f:{value}"))
}

#[test]
fn at_the_end_of_a_range_a_material_is_what_it_is_just_before() {
    let mut found = Vec::new();
    let models = [
        ("principled", SOLIDS, SOLID),
        ("principledthin", SHEETS, THIN),
    ];
    for (model, others, own) in models {
        for (name, end, before) in COMMON.iter().chain(own) {
            for others in others {
                // What lets light through, however little, is given an interface.
                if (*name, *end) == ("spec_trans", 0.0) && others.contains("specular=f:0 ") {
                    continue;
                }
                let [at, near] = [*end, *before].map(|value| with(model, others, name, value));
                let mut uniform = Uniform::new(31);
                for _ in 0..200 {
                    let (wo, wi) = (uniform.direction(), uniform.direction());
                    let of = |sample: &Sample| sample.at(wo).eval(wo, wi, TransportMode::Radiance);
                    let (a, b) = (of(&at), of(&near));
                    let alike = (a - b)
                        .abs()
                        .cmple(0.02 * a.abs().max(b.abs()) + 2e-4)
                        .all();
                    if !(alike && a.is_finite() && a.cmpge(Vec4::ZERO).all()) {
                        found.push(format!("{}: {wo} {wi}: {a}, just before {b}", at.text));
                        break;
                    }
                }
                // Whatever it scatters is found, and counts no more than it ought to.
                for wo in [(0.3, 0.2, 1.0), (0.3, 0.2, -1.0)] {
                    let wo = glam::Vec3::from(wo).normalize();
                    let bsdf = at.at(wo);
                    for _ in 0..50 {
                        let sampled = bsdf.sample(
                            wo,
                            uniform.next(),
                            uniform.pair(),
                            TransportMode::Radiance,
                        );
                        if let Some(s) = sampled {
                            let weight = s.value / s.chance.lanes().x;
                            assert!(weight.is_finite() && s.wi.is_finite(), "{} {s:?}", at.text);
                        }
                    }
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A metal reflects whatever the dielectric that it is not would do. Mutant rejected: it reflects where that does.
#[test]
fn a_metal_without_specular_reflects_as_metal() {
    let reflected = |specular: f32| {
        let sample = with(
            "principled",
            "metallic=f:1 base_color=f:0.9 roughness=f:0.5",
            "specular",
            specular,
        );
        let wo = glam::Vec3::new(0.3, 0.0, 1.0).normalize();
        let bsdf = sample.at(wo);
        let mut uniform = Uniform::new(5);
        let found = (0..20_000).filter_map(|_| {
            bsdf.sample(wo, uniform.next(), uniform.pair(), TransportMode::Radiance)
        });
        found.map(|s| s.value.x / s.chance.lanes().x).sum::<f32>() / 20_000.0
    };
    let (none, little) = (reflected(0.0), reflected(0.001));
    assert!(
        none > 0.8 && (none / little - 1.0).abs() < 0.01,
        "{none}, {little}"
    );
}
