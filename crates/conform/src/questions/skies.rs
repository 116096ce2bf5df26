//! A diffuse floor under a sky: one with a narrow bright block, and an even one beside a wall.

use super::form_factors::by_pixel;
use super::stage::{BLACK, GREY, PIXELS, down, floor, scene};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Camera, Interpolation, Projection, Scene, Shape, Sky};
use crate::truth::form_factors::perpendicular;
use crate::truth::{Picture, sky};
use etalon_math::float64::{cos, sin};
use std::f64::consts::{PI, TAU};

pub(super) const BLOCK: Question = Question {
    name: "sky-block",
    title: "A tilted floor under a dark sky with one bright block of cells, not interpolated",
    formula: "ρ/π L ∫∫ n·ω sin θ dθ dφ",
    source: "Lambert, Photometria, 1760",
    freedom: Freedom::Any,
    samples: 256,
    ask: || block(Interpolation::None),
};

pub(super) const BLOCK_LINEAR: Question = Question {
    name: "sky-block-linear",
    title: "The same, bilinear between the middles of cells",
    formula: "ρ/π Σ L ∫∫ hat(θ) hat(φ) n·ω sin θ dθ dφ",
    ask: || block(Interpolation::Linear),
    ..BLOCK
};

pub(super) const BLOCK_TO_POLES: Question = Question {
    name: "sky-block-to-poles",
    title: "The same, bilinear, the first and the last row at the poles",
    ask: || block(Interpolation::RowsToPoles),
    ..BLOCK_LINEAR
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

fn block(interpolation: Interpolation) -> (Scene, Picture) {
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
        interpolation,
        zenith: [0.0, 0.0, 1.0],
        meridian: [1.0, 0.0, 0.0],
        rows: ROWS,
        columns: COLUMNS,
        radiance: (0..ROWS * COLUMNS).map(cell).collect(),
    });
    let normal = [sine, 0.0, cosine];
    let (polar, around) = (PI / f64::from(ROWS), TAU / f64::from(COLUMNS));
    // Row i of an interpolated map stands at i + `first` steps from the zenith.
    let hats = |first: f64, step: f64| {
        let of_row = |i: u32| {
            let theta = step * (f64::from(i) + first);
            let phi = |j: u32| around * (f64::from(j) + 0.5);
            let [from, end] = BRIGHT_COLUMNS;
            (from..end).map(move |j| sky::hat(normal, [theta, phi(j)], [step, around]))
        };
        let [from, end] = BRIGHT_ROWS;
        (from..end).flat_map(of_row).sum::<f64>()
    };
    let irradiance = match interpolation {
        Interpolation::None => sky::part(
            normal,
            BRIGHT_ROWS.map(|i| polar * f64::from(i)),
            BRIGHT_COLUMNS.map(|j| around * f64::from(j)),
        ),
        Interpolation::Linear => hats(0.5, polar),
        Interpolation::RowsToPoles => hats(0.0, PI / f64::from(ROWS - 1)),
    };
    (
        scene,
        Picture::even(PIXELS, 0.5 * radiance / PI * irradiance),
    )
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
