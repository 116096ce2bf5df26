//! What a number means: the radiance of a wall, the intensity of a point, the irradiance of the sun, each 1.

use super::stage::{BLACK, GREY, PIXELS, along_y, down, floor, scene, wall};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Light, Scene};
use crate::truth::{Picture, delta_lights};
use std::f64::consts::PI;

pub(super) const WALL: Question = Question {
    name: "wall",
    title: "A glowing wall is as bright as it is",
    formula: "L",
    source: "the definition of radiance",
    freedom: Freedom::Any,
    samples: 16,
    ask: wall_of_light,
};

pub(super) const POINT: Question = Question {
    name: "point-light-unit",
    title: "A floor one metre below a point light of intensity 1",
    formula: "ρ/π I h/d³",
    source: "Lambert, Photometria, 1760",
    ask: under_point,
    ..WALL
};

pub(super) const SUN: Question = Question {
    name: "sun-unit",
    title: "A floor under an upright sun of irradiance 1",
    formula: "ρ E/π",
    source: "Lambert, Photometria, 1760",
    ask: under_sun,
    ..WALL
};

fn wall_of_light() -> (Scene, Picture) {
    let scene = scene(along_y(0.2)).glowing(wall(4.0), BLACK, 1.0);
    (scene, Picture::even(PIXELS, 1.0))
}

fn under_point() -> (Scene, Picture) {
    let scene = scene(down([0.0; 3], 0.2))
        .with(floor(0.0), GREY)
        .lit(Light::Point {
            position_m: [0.0, 0.0, 1.0],
            intensity: 1.0,
        });
    let truth = Picture::of(PIXELS, |u, v| {
        0.5 / PI * delta_lights::inverse_square([0.0, 0.0, 1.0], [0.1 * u, 0.1 * v])
    });
    (scene, truth)
}

fn under_sun() -> (Scene, Picture) {
    let scene = scene(down([0.0; 3], 0.2))
        .with(floor(0.0), GREY)
        .lit(Light::Sun {
            direction: [0.0, 0.0, -1.0],
            irradiance: 1.0,
        });
    (scene, Picture::even(PIXELS, 0.5 / PI))
}
