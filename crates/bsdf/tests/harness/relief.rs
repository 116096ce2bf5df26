//! Normals that a texture tilts, seen from either side.

use crate::directions::Uniform;
use crate::scene::Sample;
use etalon_transport::{Bsdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::FRAC_1_PI;

/// A relief of this normal, as a map and as the slope of heights.
fn reliefs(normal: Vec3) -> [String; 2] {
    let [x, y, z] = (0.5 * (normal + 1.0)).to_array();
    let slope = -normal.truncate() / normal.z;
    [
        format!("normalmap normalmap=t:450:{z},550:{y},600:{x} use_shadowing_function=b:false"),
        format!(
            "bumpmap heights=n:450:0,550:{},600:{} use_shadowing_function=b:false",
            slope.y, slope.x
        ),
    ]
}

/// ρ/π max(0, n·ωi), by the relief's own side: its back is −n where the map is outside of `twosided`, and the mirror
/// image of its front where it is inside (Mitsuba 3.5 gives the same sixteen numbers for tilts of 30°).
#[test]
fn a_relief_is_seen_from_both_sides() {
    let tilts = [Vec2::X, -Vec2::X, Vec2::Y, -Vec2::Y, Vec2::new(0.6, -0.8)];
    let mut uniform = Uniform::new(21);
    for tilt in tilts.map(|tilt| 0.5 * tilt) {
        let normal = tilt.extend((1.0 - tilt.length_squared()).sqrt());
        for relief in reliefs(normal) {
            let outside = Sample::new(&format!("{relief} ( twosided ( diffuse ) )"));
            let inside = Sample::new(&format!("twosided ( {relief} ( diffuse ) )"));
            for side in [1.0, -1.0] {
                let mirrored = Vec3::new(normal.x, normal.y, side * normal.z);
                for (sample, n) in [(&outside, side * normal), (&inside, mirrored)] {
                    let wo = Vec3::new(0.1, 0.2, side).normalize();
                    let bsdf = sample.at(wo);
                    for _ in 0..50 {
                        let wi = uniform.direction();
                        let wi = Vec3::new(wi.x, wi.y, side * wi.z.abs());
                        let expected = 0.5 * FRAC_1_PI * n.dot(wi).max(0.0);
                        let value = bsdf.eval(wo, wi, TransportMode::Radiance).x;
                        let text = &sample.text;
                        assert!(
                            (value - expected).abs() < 1e-5,
                            "{text} {wo} {wi}: {value}, {expected}"
                        );
                    }
                    // And it is sampled there.
                    let total: f32 = (0..4000)
                        .filter_map(|_| {
                            bsdf.sample(wo, uniform.next(), uniform.pair(), TransportMode::Radiance)
                        })
                        .map(|sample| sample.value.x / sample.chance.lanes().x)
                        .sum();
                    // What falls below the surface is lost: (1 + cos 30°)/2 of the light is left.
                    let expected = 0.25 * (1.0 + normal.z);
                    assert!(
                        (total / 4000.0 - expected).abs() < 0.01,
                        "{} {total}",
                        sample.text
                    );
                }
            }
        }
    }
}

/// All that a model does with light from `wo`, if it has no direction but discrete ones, or at `wi`.
fn scattered(bsdf: &impl Bsdf, wo: Vec3, wi: Vec3) -> Vec4 {
    let mode = TransportMode::Radiance;
    let discrete = (0..).map_while(|index| bsdf.discrete(wo, index, mode));
    let discrete: Vec4 = discrete.map(|sample| sample.value).sum();
    bsdf.eval(wo, wi, mode) + discrete
}

/// A normal that is not seen is turned about the surface's: to turn viewer and light in its place is the same, of every
/// model that looks the same from both. Mutant rejected: rough glass that counts as smooth and rough at once, whose
/// normals are left alone.
#[test]
fn normals_that_are_not_seen_are_turned_whatever_lets_light_through() {
    let turned = |v: Vec3| Vec3::new(-v.x, -v.y, v.z);
    let near = |a: Vec4, b: Vec4| {
        (a - b)
            .abs()
            .cmple(1e-3 * a.abs().max(b.abs()) + 1e-5)
            .all()
    };
    let (normal, mut held) = (Vec3::new(0.766, 0.0, 0.643), 0);
    let [map, _] = reliefs(normal);
    for plain in Sample::test_materials() {
        let traits = plain.material().traits();
        if !traits.transmission || traits.tilted || traits.lobes == 0 || traits.lobes > 1 {
            continue;
        }
        let symmetric = |uniform: &mut Uniform| {
            (0..50).all(|_| {
                let (wo, wi) = (uniform.direction(), uniform.direction());
                let [a, b] = [(wo, wi), (turned(wo), turned(wi))]
                    .map(|(wo, wi)| scattered(&plain.at(wo), wo, wi));
                near(a, b)
            })
        };
        let mut uniform = Uniform::new(4);
        if !symmetric(&mut uniform) {
            continue;
        }
        let tilted = Sample::new(&format!("{map} ( {} )", plain.text));
        let (mut lit, mut unseen) = (0, 0);
        while unseen < 100 {
            let (wo, wi) = (uniform.direction(), uniform.direction());
            if wo.z * wo.dot(normal) > 0.0 || wo.z.abs() < 0.01 {
                continue;
            }
            unseen += 1;
            let [value, expected] = [(wo, wi), (turned(wo), turned(wi))]
                .map(|(wo, wi)| scattered(&tilted.at(wo), wo, wi));
            assert!(
                near(value, expected),
                "{} {wo} {wi}: {value}, {expected}",
                tilted.text
            );
            lit += usize::from(value != Vec4::ZERO);
        }
        assert!(lit > 10, "{} is dark", tilted.text);
        held += 1;
    }
    assert!(held >= 10, "{held}");
}

/// The light that rough glass with steep normals scatters under an even sky, as smooth glass of the same relief.
#[test]
fn rough_glass_with_a_steep_relief_is_as_bright_as_smooth_glass() {
    let [map, _] = reliefs(Vec3::new(0.766, 0.0, 0.643));
    let wo = Vec3::new(-20.0, 0.0, 8.0).normalize();
    let [rough, smooth] = ["roughdielectric alpha=f:0.05", "dielectric"].map(|glass| {
        let sample = Sample::new(&format!("{map} ( {glass} )"));
        let bsdf = sample.at(wo);
        let mut uniform = Uniform::new(9);
        let found = (0..20_000).filter_map(|_| {
            bsdf.sample(wo, uniform.next(), uniform.pair(), TransportMode::Radiance)
        });
        // Radiance that is entered is squeezed by η², which the sky within would be, too.
        let energy = found.map(|s| s.value.x / s.chance.lanes().x);
        energy.sum::<f32>() / 20_000.0
    });
    assert!((rough / smooth - 1.0).abs() < 0.02, "{rough}, {smooth}");
}
