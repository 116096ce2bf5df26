//! Clear glass: panes before a glowing wall, and a ball that absorbs nothing under an even sky.
//!
//! A pane passes (1 − R)/(1 + R), all reflections within it summed; two of them (1 − R)/(1 + 3R).

use super::stage::{BLACK, PIXELS, along_y, facing, scene, sphere};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Material, Scene, Shape};
use crate::truth::Picture;
use crate::truth::interfaces::{reflectance, transmittance};
use etalon_math::float64::{cos, sin};

pub(super) const UPRIGHT: Question = Question {
    name: "pane-0",
    title: "A wall through a pane of glass at right angles",
    formula: "(1 − R)/(1 + R) L, R = ½ (R_s + R_p)",
    source: "Stokes, On the intensity of the light reflected from or transmitted through a pile of plates, 1862",
    freedom: Freedom::Any,
    samples: 64,
    ask: || panes(0.0, &[0.0]),
};

pub(super) const SLANTED: Question = Question {
    name: "pane-45",
    title: "A wall through a pane of glass at 45 degrees",
    ask: || panes(45.0, &[0.0]),
    ..UPRIGHT
};

pub(super) const GRAZING: Question = Question {
    name: "pane-70",
    title: "A wall through a pane of glass at 70 degrees",
    samples: 256,
    ask: || panes(70.0, &[0.0]),
    ..UPRIGHT
};

pub(super) const PILE: Question = Question {
    name: "pile-of-panes",
    title: "A wall through two panes of glass at 30 degrees",
    formula: "(1 − R)/(1 + 3R) L, R = ½ (R_s + R_p)",
    samples: 128,
    ask: || panes(30.0, &[-0.1, 0.1]),
    ..UPRIGHT
};

pub(super) const BALL: Question = Question {
    name: "glass-ball",
    title: "A ball of glass under an even sky cannot be seen",
    formula: "L",
    source: "Kirchhoff's law, 1860",
    ask: ball,
    ..UPRIGHT
};

const GLASS: Material = Material::Glass { n: 1.5 };

/// Panes of 3 m × 3 m × 5 cm with the normal (0, −cos, sin) of an angle, shifted along it by each of the distances. What they
/// reflect passes the wall by, which is only 2 m wide.
fn panes(degrees: f64, distances: &[f64]) -> (Scene, Picture) {
    let angle = degrees.to_radians();
    let (sine, cosine) = (sin(angle), cos(angle));
    let behind = facing([0.0, 4.0, 0.0], [0.0, -1.0, 0.0], 1.0);
    let mut scene = scene(along_y(0.2)).glowing(behind, BLACK, 1.0);
    for distance in distances {
        let pane = Shape::Box {
            center_m: [0.0, -distance * cosine, distance * sine],
            half_axes_m: [
                [1.5, 0.0, 0.0],
                [0.0, 1.5 * sine, 1.5 * cosine],
                [0.0, -0.025 * cosine, 0.025 * sine],
            ],
        };
        scene = scene.with(pane, GLASS);
    }
    let interfaces = 2 * distances.len() as u32;
    let truth = transmittance(reflectance(cosine, 1.5), interfaces);
    (scene, Picture::even(PIXELS, truth))
}

fn ball() -> (Scene, Picture) {
    let scene = scene(along_y(1.8))
        .with(sphere([0.0; 3], 1.0), GLASS)
        .under(1.0);
    (scene, Picture::even(PIXELS, 1.0))
}
