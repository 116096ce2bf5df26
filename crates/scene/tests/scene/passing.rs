//! Straight travel through surfaces that let light pass.

use crate::reading::{LANES, document, down, meet, read_with, scene};
use etalon_transport::{Ray, World};
use glam::{Vec3, Vec4};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

/// A square of side 200 at a height.
fn sheet(height: f32, bsdf: &str) -> String {
    format!(
        "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"100\"/>\
         <translate z=\"{height}\"/></transform>{bsdf}</shape>\n"
    )
}

fn mask(opacity: f32) -> String {
    format!(
        "<bsdf type=\"mask\"><float name=\"opacity\" value=\"{opacity}\"/>\
         <bsdf type=\"diffuse\"/></bsdf>"
    )
}

const NULL: &str = "<bsdf type=\"null\"/>";

#[test]
fn transmittances_multiply_and_crossings_are_limited() {
    let world = scene(
        &(sheet(1.0, &mask(0.25))
            + &sheet(2.0, NULL)
            + &sheet(3.0, &mask(0.5))
            + &sheet(4.0, "<bsdf type=\"diffuse\"/>")),
    );
    let segment = |to: f32| {
        let to = Vec3::new(0.3, 0.2, to);
        Ray::between(Vec3::ZERO, to, 0.0).expect("two points")
    };
    let passage = |to, crossings| world.transmittance(&segment(to), &LANES, crossings);
    for (to, crossed, transmittance) in [
        (0.5, 0, 1.0),
        (1.5, 1, 0.75),
        (2.5, 2, 0.75),
        (3.5, 3, 0.375),
    ] {
        let found = passage(to, crossed).expect("light arrives");
        assert_eq!(found.transmittance, Vec4::splat(transmittance));
        assert_eq!(found.probability, Vec4::splat(transmittance));
        // One crossing less does not do; more change nothing.
        assert!(crossed == 0 || passage(to, crossed - 1).is_none());
        assert!(passage(to, u32::MAX).is_some());
    }
    assert!(passage(4.5, u32::MAX).is_none());
    let out = Ray::new(Vec3::ZERO, Vec3::Z, 0.0);
    assert!(world.transmittance(&out, &LANES, u32::MAX).is_none());
    let away = Ray::new(Vec3::ZERO, -Vec3::Z, 0.0);
    assert!(world.transmittance(&away, &LANES, 0).is_some());
}

#[test]
fn a_scene_without_such_surfaces_only_asks_whether_anything_is_there() {
    let world = scene(&sheet(1.0, ""));
    let to = |z| Ray::between(Vec3::ZERO, Vec3::Z * z, 0.0).expect("two points");
    assert!(world.transmittance(&to(0.9), &LANES, 0).is_some());
    assert!(world.transmittance(&to(1.1), &LANES, 7).is_none());
}

proptest! {
    #![proptest_config(Config {
        cases: 48,
        rng_seed: RngSeed::Fixed(11),
        failure_persistence: None,
        ..Config::default()
    })]

    /// Any stack of sheets, any slanted segment: the product over the sheets strictly between
    /// its ends, whichever way it is travelled.
    #[test]
    fn a_segment_crosses_what_lies_between_its_ends(
        opacities in prop::collection::vec(0.0_f32..1.0, 1..7),
        ends in (0.0_f32..7.0, 0.0_f32..7.0),
        slant in (-30.0_f32..30.0, -30.0_f32..30.0),
        far in prop::bool::ANY,
    ) {
        // Far from the origin coordinates are coarser, and so are the offsets of rays.
        let base = if far { 2000.0 } else { 0.0 };
        let height = |i: usize| base + i as f32 + 0.5;
        let near_a_sheet = |z: f32| ((z + 0.5).fract() - 0.0).abs() < 0.05 || (z + 0.5).fract() > 0.95;
        prop_assume!(!near_a_sheet(ends.0) && !near_a_sheet(ends.1));
        prop_assume!((ends.0 - ends.1).abs() > 0.01);
        let sheets: String = opacities
            .iter()
            .enumerate()
            .map(|(i, &opacity)| sheet(height(i), &mask(opacity)))
            .collect();
        let world = scene(&sheets);
        let (low, high) = (ends.0.min(ends.1), ends.0.max(ends.1));
        let mut crossed = 0;
        let mut expected = 1.0_f64;
        for (i, &opacity) in opacities.iter().enumerate() {
            let at = i as f32 + 0.5;
            if at > low && at < high {
                crossed += 1;
                expected *= 1.0 - f64::from(opacity);
            }
        }
        let from = Vec3::new(0.0, 0.0, base + ends.0);
        let to = Vec3::new(slant.0, slant.1, base + ends.1);
        for (a, b) in [(from, to), (to, from)] {
            let ray = Ray::between(a, b, 0.0).expect("two points");
            let found = world.transmittance(&ray, &LANES, crossed).expect("light arrives");
            let error = f64::from(found.transmittance.x) - expected;
            prop_assert!(error.abs() < 1e-5, "{} for {expected}", found.transmittance);
            prop_assert!(crossed == 0 || world.transmittance(&ray, &LANES, crossed - 1).is_none());
        }
    }
}

/// Boxes of water in boxes of glass that touch: both surfaces are met, whatever holds the dielectric.
/// Rejects a scene that does not tell the geometry what refracts.
#[test]
fn dielectrics_that_touch_are_both_met() {
    let water = "<bsdf type=\"dielectric\"/>";
    let named = "<bsdf type=\"mask\"><bsdf type=\"roughdielectric\"/></bsdf>";
    let principled = "<bsdf type=\"principled\"><float name=\"spec_trans\" value=\"1\"/></bsdf>";
    let both = [water, named, principled];
    let pairs = both.iter().flat_map(|a| both.iter().map(move |b| (*a, *b)));
    for (inner, outer) in pairs.filter(|(inner, outer)| inner != outer) {
        let cube = |size: &str, bsdf: &str| {
            format!(
                "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"{size}\"/>\
                 </transform>{bsdf}</shape>"
            )
        };
        let scene = scene(&(cube("1", outer) + &cube("0.9999999", inner)));
        let mut ray = down(0.3, 0.2);
        let mut met = Vec::new();
        while let Some((_, vertex)) = meet(&scene, &ray) {
            met.push(vertex.shape.0);
            ray = vertex.spawn(ray.direction);
        }
        assert_eq!(met, [0, 1, 1, 0]);
    }
}

/// Light that enters a curve does not come out: a note says so wherever any would. Mutants rejected: silence; a note for hair.
#[test]
fn curves_have_no_way_out_and_say_so() {
    let medium = "<medium type=\"homogeneous\" name=\"interior\"><float name=\"sigma_t\" value=\"1\"/></medium>";
    let glass = "<bsdf type=\"mask\"><bsdf type=\"roughdielectric\"/></bsdf>";
    let frosted = "<bsdf type=\"principled\"><float name=\"spec_trans\" value=\"0.5\"/></bsdf>";
    let notes = |shape: &str, content: &str| {
        let shape = format!(
            "<shape type=\"{shape}\"><string name=\"filename\" value=\"c.txt\"/>{content}</shape>"
        );
        let points = "0 0 0 .1\n1 0 0 .1\n2 1 0 .1\n3 1 0 .1\n";
        let read = read_with(&document(&shape), &[("c.txt", points)]);
        assert_eq!(read.errors, Vec::<String>::new());
        let said = read.notes.iter();
        said.filter(|note| note.contains("seen from outside only"))
            .count()
    };
    for curve in ["linearcurve", "bsplinecurve"] {
        for content in [
            "<bsdf type=\"dielectric\"/>",
            glass,
            frosted,
            &format!("{NULL}{medium}"),
            "<subsurface type=\"randomwalk\"><float name=\"mean_free_path\" value=\"1\"/></subsurface>",
        ] {
            assert_eq!(notes(curve, content), 1, "{curve} {content}");
        }
        for content in ["", "<bsdf type=\"hair\"/>", "<bsdf type=\"plastic\"/>"] {
            assert_eq!(notes(curve, content), 0, "{curve} {content}");
        }
    }
}
