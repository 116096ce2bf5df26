//! What textures of pbrt are at points, against pbrt's formulas.

use super::evaluated::Evaluated;
use super::*;
use etalon_math::float64::{acos, atan2, sin};
use etalon_math::noise::noise;
use etalon_transport::SpectrumKind;
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::f64::consts::PI;

/// Where textures stand in these tests.
const PLACE: &str = "Translate 0.3 -0.2 0.1 Rotate 40 1 2 3 Scale 2 2 0.5";

/// From the world to the texture's space.
fn from_world() -> DMat4 {
    let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
    let place = DMat4::from_translation(DVec3::new(0.3, -0.2, 0.1))
        * DMat4::from_axis_angle(axis, 40.0_f64.to_radians())
        * DMat4::from_scale(DVec3::new(2.0, 2.0, 0.5));
    place.inverse()
}

/// A document whose diffuse material has the texture `t`. There may be notes.
#[track_caller]
fn document(textures: &str) -> Document {
    let text = format!(
        "{textures} Material \"diffuse\" \"texture reflectance\" \"t\" \
         Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]"
    );
    let outcome = world(&text);
    let lines = outcome.lines();
    outcome.document.unwrap_or_else(|| panic!("{lines}"))
}

fn reflectance(textures: &str) -> Evaluated {
    let document = document(textures);
    Evaluated::of(&document, "reflectance", SpectrumKind::Reflectance)
}

/// Places in the world, with their places in the texture's space.
fn places() -> impl Iterator<Item = (Vec3, DVec3)> {
    (0..200).map(|i| {
        let part = |k: f64| (f64::from(i) * k).fract() * 3.0 - 1.5;
        let world = DVec3::new(part(0.618), part(0.755), part(0.569)).as_vec3();
        (world, from_world().transform_point3(world.as_dvec3()))
    })
}

/// (s, t) of pbrt's mappings.
fn coordinates(mapping: &str, p: DVec3) -> [f64; 2] {
    let phi = atan2(p.y, p.x);
    match mapping {
        "spherical" => [
            acos(p.z / p.length()) / PI,
            if phi < 0.0 { phi + 2.0 * PI } else { phi } / (2.0 * PI),
        ],
        "cylindrical" => [(PI + phi) / (2.0 * PI), p.z],
        _ => [
            0.25 + DVec3::new(0.5, 0.2, 0.0).dot(p),
            -0.5 + DVec3::new(0.0, 0.3, 1.0).dot(p),
        ],
    }
}

/// Mutants rejected: s and t exchanged, φ of a cylinder from 0, the planar vectors as columns, a mapping that also moves the
/// coordinates of what is within the squares.
#[test]
fn squares_are_projected_and_what_is_in_them_is_not() {
    for (mapping, more) in [
        ("spherical", ""),
        ("cylindrical", ""),
        (
            "planar",
            "\"vector3 v1\" [ 0.5 0.2 0 ] \"vector3 v2\" [ 0 0.3 1 ] \"float udelta\" 0.25 \"float vdelta\" -0.5",
        ),
    ] {
        let number = |tex1: &str, tex2: &str, name: &str| {
            format!(
                "Texture \"{name}\" \"float\" \"checkerboard\" \"string mapping\" \"{mapping}\" {more} {tex1} {tex2}"
            )
        };
        // The coordinates themselves, of which those beyond the unit square may be below 0 and count as 0 then.
        let texture = format!(
            "{PLACE} Texture \"s\" \"float\" \"bilerp\" \"string mapping\" \"{mapping}\" {more} \"float v10\" 0.5 \"float v11\" 0.5 \"float v01\" 0
             Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"s\""
        );
        let s = reflectance(&texture);
        let squares = reflectance(&format!(
            "Texture \"uv\" \"float\" \"bilerp\" \"float v01\" 0 \"float v10\" 1 {PLACE} {}
             Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"n\"",
            number("\"float tex1\" 0.25", "\"texture tex2\" \"uv\"", "n")
        ));
        for (world, p) in places() {
            let [a, b] = coordinates(mapping, p);
            let near_an_edge = |x: f64| (x - x.round()).abs() < 1e-4;
            let uv = Vec2::new(0.7, 0.4);
            let expected = (0.5 * a).clamp(0.0, 1.0);
            let found = f64::from(s.number(world, uv));
            assert!(
                (found - expected).abs() < 1e-5,
                "{mapping} {p} {found} {expected}"
            );
            if near_an_edge(a) || near_an_edge(b) {
                continue;
            }
            let is_even = (a.floor() + b.floor()).rem_euclid(2.0) == 0.0;
            let expected = if is_even { 0.25 } else { 0.7 };
            let found = squares.number(world, uv);
            assert!((found - expected).abs() < 1e-5, "{mapping} {p} {found}");
        }
    }
}

#[test]
fn cubes_stand_where_the_texture_does() {
    let cubes = reflectance(&format!(
        "{PLACE} Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3 \"rgb tex1\" [ 0.75 0.75 0.75 ] \"rgb tex2\" [ 0.25 0.25 0.25 ]"
    ));
    for (world, p) in places() {
        let is_even = p.floor().element_sum().rem_euclid(2.0) == 0.0;
        let expected = if is_even { 0.75 } else { 0.25 };
        let found = cubes.number(world, Vec2::ZERO);
        assert!((found - expected).abs() < 1e-4, "{p} {found}");
    }
}

/// The dots at (2u + 0.25, v) are those of the pattern itself at that place, and pbrt's `outside` is what they show.
#[test]
fn dots_follow_their_coordinates() {
    let inside = "\"float inside\" 0.25 \"float outside\" 0.75";
    let texture = |more: &str| {
        reflectance(&format!(
            "Texture \"d\" \"float\" \"dots\" {inside} {more} Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"d\""
        ))
    };
    let plain = texture("");
    let scaled = texture("\"float uscale\" 2 \"float udelta\" 0.25");
    let on_a_plane = texture("\"string mapping\" \"planar\" \"vector3 v1\" [ 0 0 1 ]");
    let mut within = 0;
    for i in 0..2000 {
        let uv = Vec2::new((i % 50) as f32 * 0.173, (i / 50) as f32 * 0.191);
        let expected = plain.number(Vec3::ZERO, Vec2::new(2.0 * uv.x + 0.25, uv.y));
        assert_eq!(scaled.number(Vec3::ZERO, uv), expected);
        let place = Vec3::new(7.0, uv.y, 2.0 * uv.x + 0.25);
        assert_eq!(on_a_plane.number(place, Vec2::ZERO), expected);
        within += usize::from(expected > 0.5);
    }
    // Two fifths of the squares, of which 0.385 are within: 310 of 2000; the rest is between the dots.
    assert!((200..420).contains(&within), "{within}");
}

/// By de Casteljau's construction, for which the ramp has twelve lines to a curve.
#[test]
fn marble_has_the_colours_of_pbrt() {
    let marble = reflectance(&format!(
        "{PLACE} Texture \"t\" \"spectrum\" \"marble\" \"float scale\" 3 \"float variation\" 0.4 \"integer octaves\" 3 \"float roughness\" 0.6"
    ));
    let points = [
        [0.58, 0.58, 0.6],
        [0.58, 0.58, 0.6],
        [0.58, 0.58, 0.6],
        [0.5, 0.5, 0.5],
        [0.6, 0.59, 0.58],
        [0.58, 0.58, 0.6],
        [0.58, 0.58, 0.6],
        [0.2, 0.2, 0.33],
        [0.58, 0.58, 0.6],
    ]
    .map(DVec3::from_array);
    for (world, p) in places() {
        let q = 3.0 * p;
        let fbm = noise(q) + 0.6 * noise(1.99 * q) + 0.36 * noise(1.99 * 1.99 * q);
        let t = 6.0 * (0.5 + 0.5 * sin(q.y + 0.4 * fbm));
        if (t - t.round()).abs() < 1e-3 {
            continue;
        }
        let mut curve = points[t as usize..][..4].to_vec();
        while curve.len() > 1 {
            curve = curve
                .windows(2)
                .map(|ends| ends[0].lerp(ends[1], t.fract()))
                .collect();
        }
        let expected = 1.5 * curve[0];
        let found = marble.colour(world, Vec2::ZERO).as_dvec3();
        assert!(
            (found - expected).abs().max_element() < 0.01,
            "{p} {found} {expected}"
        );
    }
}

/// As many octaves as a formula takes are read.
#[test]
fn the_most_octaves_are_read() {
    for kind in ["fbm", "wrinkled"] {
        reflectance(&format!(
            "Texture \"n\" \"float\" \"{kind}\" \"integer octaves\" 64 Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"n\""
        ));
    }
    reflectance("Texture \"t\" \"spectrum\" \"marble\" \"integer octaves\" 64");
}
