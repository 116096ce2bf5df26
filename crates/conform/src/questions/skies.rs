//! A diffuse floor under a sky: one with a narrow bright block, and an even one beside a wall.

use super::form_factors::by_pixel;
use super::stage::{BLACK, GREY, PIXELS, down, floor, scene};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Camera, Projection, Scene, Shape, Sky};
use crate::truth::form_factors::perpendicular;
use crate::truth::{Picture, sky};
use etalon_math::float64::{cos, sin};
use std::f64::consts::{PI, TAU};

pub(super) const BLOCK: Question = Question {
    name: "sky-block",
    title: "A tilted floor under a dark sky with one bright block of cells",
    formula: "ρ/π L ∫∫ n·ω sin θ dθ dφ",
    source: "Lambert, Photometria, 1760",
    freedom: Freedom::Any,
    samples: 256,
    ask: block,
};

pub(super) const BESIDE_WALL: Question = Question {
    name: "sky-beside-wall",
    title: "A floor under an even sky, part of which a black wall hides",
    formula: "ρ L (1 − F), F the form factor from the pixel to the wall",
    source: "Ehlert and Smith, View factors for perpendicular and parallel rectangular plates, 1993",
    ask: beside_wall,
    ..BLOCK
};

/// Rows and columns of cells, and the first and the last but one of the bright ones.
const ROWS: u32 = 32;
const COLUMNS: u32 = 64;
const BRIGHT_ROWS: [u32; 2] = [6, 8];
const BRIGHT_COLUMNS: [u32; 2] = [10, 12];

fn block() -> (Scene, Picture) {
    let radiance = 100.0;
    let angle = 40f64.to_radians();
    let (sine, cosine) = (sin(angle), cos(angle));
    let camera = Camera {
        origin_m: [0.2 * sine, 0.0, 0.2 * cosine],
        target_m: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        projection: Projection::Orthographic { width_m: 0.2 },
    };
    let tilted = Shape::Quad {
        center_m: [0.0; 3],
        half_u_m: [cosine, 0.0, -sine],
        half_v_m: [0.0, 1.0, 0.0],
    };
    let within = |[first, end]: [u32; 2], i: u32| (first..end).contains(&i);
    let cell = |i: u32| {
        let bright = within(BRIGHT_ROWS, i / COLUMNS) && within(BRIGHT_COLUMNS, i % COLUMNS);
        if bright { radiance } else { 0.0 }
    };
    let mut scene = scene(camera).with(tilted, GREY);
    scene.sky = Some(Sky::Map {
        zenith: [0.0, 0.0, 1.0],
        meridian: [1.0, 0.0, 0.0],
        rows: ROWS,
        columns: COLUMNS,
        radiance: (0..ROWS * COLUMNS).map(cell).collect(),
    });
    let theta = BRIGHT_ROWS.map(|i| PI * f64::from(i) / f64::from(ROWS));
    let phi = BRIGHT_COLUMNS.map(|j| TAU * f64::from(j) / f64::from(COLUMNS));
    let truth = 0.5 * radiance / PI * sky::part([sine, 0.0, cosine], theta, phi);
    (scene, Picture::even(PIXELS, truth))
}

/// The wall stands along the left edge of the picture, 2 m wide and high.
fn beside_wall() -> (Scene, Picture) {
    let wall = Shape::Quad {
        center_m: [-1.0, 0.0, 1.0],
        half_u_m: [0.0, 1.0, 0.0],
        half_v_m: [0.0, 0.0, 1.0],
    };
    let scene = scene(down([0.0; 3], 2.0))
        .with(floor(0.0), GREY)
        .with(wall, BLACK)
        .under(1.0);
    let truth = by_pixel(|[left, right], y| {
        0.5 * (1.0 - perpendicular([left + 1.0, right + 1.0], y, [0.0, 2.0], [-1.0, 1.0]))
    });
    (scene, truth)
}
