//! A diffuse floor under flat lights, alone and two at once.
//!
//! L = ρ E/π with E by Lambert's sum over the edges of each polygon that faces the floor.

use super::stage::{BLACK, GREY, PIXELS, down, floor, scene, sphere};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Scene, Shape, Triple};
use crate::truth::polygon_lights::{Polygon, polygons, rectangle};
use crate::truth::{Picture, irradiance};
use etalon_math::float64::{cos, sin};
use std::f64::consts::{FRAC_PI_6, PI};

pub(super) const RECTANGLE: Question = Question {
    name: "rectangle-light",
    title: "A floor under a rectangle that is parallel to it",
    formula: "ρ/π · L/2 Σ γᵢ n·(rᵢ × rᵢ₊₁)/|rᵢ × rᵢ₊₁|",
    source: "Lambert, Photometria, 1760",
    freedom: Freedom::Any,
    samples: 256,
    ask: || under_rectangle(0.0),
};

pub(super) const TILTED: Question = Question {
    name: "rectangle-light-tilted",
    title: "A floor under a rectangle that is tilted by 30 degrees",
    ask: || under_rectangle(FRAC_PI_6),
    ..RECTANGLE
};

pub(super) const TRIANGLE: Question = Question {
    name: "triangle-light",
    title: "A floor under a slanted triangle",
    ask: || under_mesh(TRIANGLE_CORNERS, &[[0, 1, 2]]),
    ..RECTANGLE
};

pub(super) const OCTAHEDRON: Question = Question {
    name: "octahedron-light",
    title: "A floor under a glowing octahedron of triangles",
    ask: || under_mesh(&octahedron(), &OCTAHEDRON_FACES),
    ..RECTANGLE
};

pub(super) const TWO: Question = Question {
    name: "two-lights",
    title: "A floor under two spheres, one of which gives a thousandth of the other's light",
    formula: "ρ Σ L (r/d)² h/d",
    source: "Howell, Catalog of Radiation Heat Transfer Configuration Factors, configuration B-38",
    ask: two,
    ..RECTANGLE
};

const TRIANGLE_CORNERS: &[Triple] = &[[-0.4, -0.3, 0.6], [0.1, 0.5, 0.9], [0.5, -0.2, 0.7]];

const OCTAHEDRON_FACES: [[u32; 3]; 8] = [
    [0, 2, 4],
    [2, 1, 4],
    [1, 3, 4],
    [3, 0, 4],
    [2, 0, 5],
    [1, 2, 5],
    [3, 1, 5],
    [0, 3, 5],
];

/// One metre above the floor, with half diagonals of 0.4, 0.3 and 0.5 m.
fn octahedron() -> [Triple; 6] {
    [
        [0.4, 0.0, 1.0],
        [-0.4, 0.0, 1.0],
        [0.0, 0.3, 1.0],
        [0.0, -0.3, 1.0],
        [0.0, 0.0, 1.5],
        [0.0, 0.0, 0.5],
    ]
}

fn under_rectangle(tilt: f64) -> (Scene, Picture) {
    let (a, b, h) = (0.5, 0.3, 0.7);
    let light = Shape::Quad {
        center_m: [0.0, 0.0, h],
        half_u_m: [a * cos(tilt), 0.0, -a * sin(tilt)],
        half_v_m: [0.0, -b, 0.0],
    };
    let at = [0.2, 0.1];
    let scene = scene(down([at[0], at[1], 0.0], 0.4))
        .with(floor(0.0), GREY)
        .glowing(light, BLACK, 1.0);
    let truth = Picture::of(PIXELS, |u, v| {
        0.5 / PI * rectangle(h, [a, b], tilt, [at[0] + 0.2 * u, at[1] + 0.2 * v])
    });
    (scene, truth)
}

fn under_mesh(corners: &[Triple], triangles: &[[u32; 3]]) -> (Scene, Picture) {
    let light = Shape::Mesh {
        positions_m: corners.to_vec(),
        triangles: triangles.to_vec(),
    };
    let corner = |i: u32| corners[i as usize];
    let faces: Vec<Polygon> = triangles
        .iter()
        .map(|triangle| triangle.map(corner).to_vec())
        .collect();
    let at = [0.3, -0.1];
    let scene = scene(down([at[0], at[1], 0.0], 0.4))
        .with(floor(0.0), GREY)
        .glowing(light, BLACK, 2.0);
    let truth = Picture::of(PIXELS, |u, v| {
        0.5 * 2.0 / PI * polygons(&faces, [at[0] + 0.2 * u, at[1] + 0.2 * v])
    });
    (scene, truth)
}

/// The weaker one is aside and higher, and no smaller to the eye.
fn two() -> (Scene, Picture) {
    let (strong, weak) = (400.0, 0.4);
    let scene = scene(down([0.3, 0.0, 0.0], 0.2))
        .with(floor(0.0), GREY)
        .glowing(sphere([0.0, 0.0, 1.0], 0.05), BLACK, strong)
        .glowing(sphere([0.5, 0.0, 1.5], 0.075), BLACK, weak);
    let truth = Picture::of(PIXELS, |u, v| {
        let (x, y) = (0.3 + 0.1 * u, 0.1 * v);
        let first = strong * irradiance::sphere(1.0, 0.05, [x, y]);
        let second = weak * irradiance::sphere(1.5, 0.075, [x - 0.5, y]);
        0.5 / PI * (first + second)
    });
    (scene, truth)
}
